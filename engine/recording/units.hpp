// Lengths that were written in another unit than mm: the commonest mistake in files that people or other
// programs wrote.
#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "engine/math/units.hpp"

namespace abbe {

struct ForeignUnit {
  std::string_view name;
  double mm = 1;
};

/// The unit in which `written` is the length `meant_mm`, to 2 %. Nothing where no unit, or millimetres, would do.
inline std::optional<ForeignUnit> foreign_unit(double written, double meant_mm) {
  constexpr double kAgree = 0.02;
  for (const ForeignUnit unit :
       {ForeignUnit{"metres", 1000}, ForeignUnit{"micrometres", 1e-3}, ForeignUnit{"inches", kMmPerInch}})
    if (meant_mm != 0 && std::abs(written * unit.mm / meant_mm - 1) < kAgree) return unit;
  return std::nullopt;
}

}  // namespace abbe
