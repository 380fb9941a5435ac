#include "engine/tolerances/material.hpp"

#include <algorithm>

#include "engine/base/ids.hpp"

namespace abbe {

double departure_mm(const ToleranceKind& size, double value, const ToleranceLimits& limits, bool inner,
                    Condition condition) {
  ABBE_CHECK(size.size_factor > 0 && limits.lower && limits.upper);
  // A hole has most material around it when it is small, a shaft when it is large.
  const bool from_lower = inner == (condition == Condition::maximum_material);
  const double departure = from_lower ? value - *limits.lower : *limits.upper - value;
  return size.size_factor * std::clamp(departure, 0.0, std::max(0.0, *limits.upper - *limits.lower));
}

}  // namespace abbe
