// Small words that many effects use: units of their parameters (math/units.hpp), directions given by
// two angles, codes, and the parameters that mean the same everywhere.
#pragma once

#include "engine/effects/effect.hpp"
#include "engine/math/units.hpp"

namespace abbe {

/// The code of a parameter that is a choice or an ordinal.
inline int code(double value) { return static_cast<int>(value + 0.5); }

/// The unit vector along axis 0, 1, 2.
constexpr Vec3 axis_vector(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

/// The unit vector at an azimuth (from the first axis towards the second) and an elevation above
/// their plane.
inline Vec3 direction_from_angles(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

/// Where the machine moved just before the touch; against the normal when a recording does not
/// tell.
inline Vec3 approach(const TouchScene& scene) { return scene.travel == Vec3{} ? -scene.normal : scene.travel; }

/// The scalar r along the outward normal, as a displacement.
constexpr Vec3 along_normal(const TouchScene& scene, double r_mm) { return r_mm * scene.normal; }

/// Is this the stylus that the parameter `sensor` names? 0 means every stylus.
inline bool concerns(const StylusScene& stylus, double sensor) {
  return code(sensor) == 0 || code(sensor) == stylus.ordinal;
}

constexpr EffectParameter axis_parameter(std::string_view help) {
  return {.name = "axis", .unit = "code", .help = help, .high = 2, .choices = kAxisChoices};
}

inline constexpr EffectParameter kSensorParameter{
    .name = "sensor",
    .unit = "code",
    .help = "which stylus system, counted 1, 2, ... in the order of first use; 0: every one",
    .high = 1000,
    .sought = Sought::stylus};

/// From when on something is there that changes at once.
inline constexpr EffectParameter kMomentParameter{.name = "t0_s",
                                                  .unit = "s",
                                                  .help = "when, since the start of the program",
                                                  .typical = 600,
                                                  .low = 0,
                                                  .high = 1e7,
                                                  .sought = Sought::moment};

/// Is this the placement of the part that the parameter `setup` names? 0 means every one.
inline bool placed_in(const TouchScene& scene, double setup) { return code(setup) == 0 || code(setup) == scene.setup; }

inline constexpr EffectParameter kSetupParameter{.name = "setup",
                                                 .unit = "code",
                                                 .help = "in which placement of the part; 0: in every one",
                                                 .high = 1e6,
                                                 .sought = Sought::setup};

}  // namespace abbe
