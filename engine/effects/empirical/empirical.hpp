// What a diagnosis saves for a mismatch that no effect of the catalogue explains: the pattern itself, fitted
// to the recording. These are not physics; outside the range of the recording they are constant or zero, and
// they say so in their titles. They let `abbe run` reckon with what was seen until somebody finds out what it
// is.
#pragma once

#include "engine/effects/effect.hpp"

namespace abbe {

inline constexpr int kCurveKnots = 16;      ///< of empirical.curve
inline constexpr int kMapNodes = 6;         ///< of empirical.map, along each of its two coordinates
inline constexpr int kDirectionTerms = 25;  ///< of empirical.direction: all harmonics up to degree 4

extern const Effect kEmpiricalCurve, kEmpiricalDirection, kEmpiricalMap, kEmpiricalOffset;

/// What empirical.curve runs along, in the order of the codes of its parameter `along`.
enum class CurveCoordinate { time, x, y, z, part_temperature, speed };
double curve_coordinate(const TouchScene&, CurveCoordinate);

/// The planes of empirical.map, in the order of the codes of its parameter `plane`.
enum class MapPlane { xy, xz, yz };

}  // namespace abbe
