// Lengths that were written in another unit than mm, and angles in another than degrees: the commonest mistake in files that
// people or other programs wrote.
#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

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

/// Likewise of the angle `meant_deg`.
inline std::optional<std::string_view> foreign_angle(double written, double meant_deg) {
  constexpr double kAgree = 0.02;
  for (const auto& [name, deg] : {std::pair<std::string_view, double>{"radians", in_degrees(1)},
                                  {"minutes of arc", 1.0 / 60},
                                  {"seconds of arc", 1.0 / 3600}})
    if (meant_deg != 0 && std::abs(written * deg / meant_deg - 1) < kAgree) return name;
  return std::nullopt;
}

}  // namespace abbe
