// Units that parameters and models are given in beside mm and rad, in which everything is computed.
#pragma once

#include "engine/math/vec.hpp"

namespace abbe {

inline constexpr double kUm = 1e-3;                ///< mm per um
inline constexpr double kUmPerMm = 1e3;            ///< um per mm
inline constexpr double kMPerMm = 1e-3;            ///< m per mm
inline constexpr double kMmPerInch = 25.4;         ///< by definition since 1959
inline constexpr double kUrad = 1e-6;              ///< rad per urad
inline constexpr double kUradPerRad = 1e6;         ///< urad per rad
inline constexpr double kDegree = kPi / 180;       ///< rad per degree
inline constexpr double kArcsec = kDegree / 3600;  ///< rad per second of arc
inline constexpr double kPpm = 1e-6;               ///< mm per km; of temperatures, 1/K per um/(m K)

/// A right angle is 90 exactly, which it would not be over kDegree.
constexpr double in_degrees(double rad) { return rad * 180 / kPi; }

}  // namespace abbe
