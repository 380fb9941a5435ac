#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

void over_head(const TouchFactors& f, Family& family) {
  if (!several(f.orientation)) return;
  family.add("orientation", along(indicator(f.orientation), f.normal));
  family.add("orientation in time", along(by_group(trend(f), f.orientation), f.normal));
  family.add("settling", along(by_group(settling(f.settled), f.orientation), f.normal));
  family.add("over direction", by_group(smooth(as_points(f.normal), 0.9, 8), f.orientation));
  family.add("over position", along(by_group(linear(f.place), f.orientation), f.normal));
  family.add("turning in time", along(rugged(f.time, 0.2, 24), f.turned));
  family.add("turning over position", along(smooth(f.place, 0.6, 14), f.turned));
}

}  // namespace abbe::diagnose::patterns
