// What a diagnosis saves for a mismatch that no effect of the catalogue explains: the pattern itself, fitted
// to the recording. These are not physics; outside the range of the recording they are constant or zero, and
// they say so in their titles. They let `abbe run` reckon with what was seen until somebody finds out what it
// is.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/effects/effect.hpp"

namespace abbe {

inline constexpr int kCurveKnots = 16;      ///< of empirical.curve
inline constexpr int kMapNodes = 6;         ///< of empirical.map, along each of its two coordinates
inline constexpr int kDirectionTerms = 25;  ///< of empirical.direction: all harmonics up to degree 4

extern const Effect kEmpiricalCurve, kEmpiricalDirection, kEmpiricalMap, kEmpiricalOffset;

/// What empirical.curve runs along, in the order of the codes of its parameter `along`.
enum class CurveCoordinate { time, x, y, z, part_temperature, speed };
double curve_coordinate(const TouchScene&, CurveCoordinate);

/// Whether a coordinate lies further from a range than half the way between two of its evenly spaced knots.
inline bool beyond_knots(double at, double from, double to, int knots) {
  const double half_way = std::abs(to - from) / (2 * (knots - 1));
  return at < std::min(from, to) - half_way || at > std::max(from, to) + half_way;
}

/// The planes of empirical.map, in the order of the codes of its parameter `plane`.
enum class MapPlane { xy, xz, yz };

}  // namespace abbe
