// The direction of a translation in W: one of the machine's axes by name, or any other by two
// angles. Parameters come in the order direction, azimuth_deg, elevation_deg. With `oblique` out of
// the way the three axes are a basis: a translation of any direction is the sum of one along each,
// which is how a diagnosis finds length and direction together.
#pragma once

#include "engine/effects/terms.hpp"

namespace abbe {

inline constexpr std::string_view kDirectionChoices[] = {"x", "y", "z", "oblique"};

inline constexpr EffectParameter kDirectionParameter{
    .name = "direction",
    .unit = "code",
    .help = "along which axis of the machine: 0 x, 1 y, 2 z; 3 oblique: as azimuth and elevation say",
    .high = 3,
    .choices = kDirectionChoices,
    .sought = Sought::direction};

inline constexpr EffectParameter kAzimuthParameter{
    .name = "azimuth_deg",
    .unit = "deg",
    .help = "of an oblique direction: from the machine's x towards its y",
    .low = -360,
    .high = 360,
    .only_with = {"direction", "oblique"}};

inline constexpr EffectParameter kElevationParameter{.name = "elevation_deg",
                                                     .unit = "deg",
                                                     .help = "of an oblique direction: 90 is up, along z",
                                                     .low = -90,
                                                     .high = 90,
                                                     .only_with = {"direction", "oblique"}};

/// Whether a parameter is such a direction, and not a choice of axes only.
constexpr bool is_direction(const EffectParameter& p) { return p.sought == Sought::direction; }

/// The unit vector that the three parameters at `theta` name.
inline Vec3 chosen_direction(const double* theta) {
  const int choice = code(theta[0]);
  return choice < 3 ? axis_vector(choice) : direction_from_angles(theta[1], theta[2]);
}

}  // namespace abbe
