// What touches may differ in, and how it is told: where a mismatch lies (locate.hpp), and where a name is larger
// (one_size.hpp).
#pragma once

#include <fmt/format.h>

#include <string>

#include "engine/effects/effect.hpp"

namespace abbe::diagnose {

struct Coordinate {
  const char* name;  ///< of its column
  const char* unit;  ///< with a space before it; or none
  int digits;        ///< after the point
  double (*of)(const TouchScene&);
};

/// Where no clock was logged, touches count.
inline constexpr Coordinate kClock{"time_s", " s", 0, [](const TouchScene& s) { return s.time_s; }};
inline constexpr Coordinate kTouchNumber{"touch", "", 0, [](const TouchScene& s) { return s.touch + 1.0; }};

inline constexpr Coordinate kPosition[] = {{"x", " mm", 0, [](const TouchScene& s) { return s.point.x; }},
                                           {"y", " mm", 0, [](const TouchScene& s) { return s.point.y; }},
                                           {"z", " mm", 0, [](const TouchScene& s) { return s.point.z; }}};

/// A hundredth of a degree is some tenth of a micrometre on a metre of steel.
inline constexpr Coordinate kThermometers[] = {
    {"part_C", " C", 2, [](const TouchScene& s) { return s.temperature.part; }},
    {"x_C", " C", 2, [](const TouchScene& s) { return s.temperature.scale[0]; }},
    {"y_C", " C", 2, [](const TouchScene& s) { return s.temperature.scale[1]; }},
    {"z_C", " C", 2, [](const TouchScene& s) { return s.temperature.scale[2]; }},
    {"air_C", " C", 2, [](const TouchScene& s) { return s.temperature.air; }}};

/// "20 to 140 mm", or "20 mm" where both ends are that as they are told.
inline std::string in_words(const Coordinate& c, double low, double high) {
  const std::string from = fmt::format("{:.{}f}", low, c.digits), to = fmt::format("{:.{}f}", high, c.digits);
  return (from == to ? from : from + " to " + to) + c.unit;
}

}  // namespace abbe::diagnose
