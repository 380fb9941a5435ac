// The effects of temperature (docs/physics/thermal.md), one per .cpp file, and the laws that they
// share.
//
// Signs with `measured = true + d`: a part that is warmer than assumed is larger, so its surface
// reads too far out; a scale that is warmer has longer divisions, so the machine reads too little;
// a ram or stylus that grows reaches the surface too early.
#pragma once

#include "engine/effects/terms.hpp"
#include "engine/math/units.hpp"

namespace abbe {

extern const Effect kPartExpansion;
extern const Effect kScaleExpansion;
extern const Effect kTableBending;
extern const Effect kBridgeBending;
extern const Effect kThermalDrift;
extern const Effect kThermalCycle;
extern const Effect kRamGrowth;
extern const Effect kStylusGrowth;
extern const Effect kPartSoak;

/// Time constant of a body that exchanges heat with the air, s: density times heat capacity times
/// thickness per cooled face over the heat transfer coefficient (lumped capacity, Biot number <<
/// 1).
constexpr double time_constant_s(double density_kg_m3, double capacity_J_kgK, double thickness_m,
                                 double transfer_W_m2K) {
  return density_kg_m3 * capacity_J_kgK * thickness_m / transfer_W_m2K;
}

/// Still air at a machine's wall, W/(m^2 K): natural convection.
inline constexpr double kStillAir = 5;
/// A 10 mm aluminium wall cooled on one face: 1.4 h. A 200 mm granite table cooled on both: 12 h.
inline constexpr double kAluminiumWall_s = time_constant_s(2700, 900, 0.010, kStillAir);
inline constexpr double kGraniteTable_s = time_constant_s(2700, 800, 0.100, kStillAir);

/// Share of its final value that a first-order lag has reached after `time_s`. tau = 0: all of it,
/// at once.
inline double settled_share(double time_s, double tau_s) { return tau_s > 0 ? -std::expm1(-time_s / tau_s) : 1; }

/// d of a part that is longer by `strain` in every direction, as seen from its own origin. Only its
/// component along the normal reaches a reading; that is a scalar of the part's frame, so the pose
/// of the part in W is not needed.
constexpr Vec3 isotropic_growth(const TouchScene& scene, double strain) {
  return along_normal(scene, strain * dot(scene.normal_on_part, scene.on_part));
}

/// The expansion coefficient of a body, that of its usual material unless the user says otherwise.
constexpr EffectParameter cte_parameter(double usual, std::string_view help) {
  return {.name = "cte_ppm_per_K",
          .unit = "ppm/K",
          .help = help,
          .typical = usual,
          .low = -1,
          .high = 30,
          .standard = usual};
}

/// Where a part is held that grows. Its origin stands still only where it is held there.
inline constexpr std::string_view kHeldChoices[] = {"origin", "elsewhere"};
inline constexpr EffectParameter kHeldParameter{
    .name = "held",
    .unit = "code",
    .help = "where the part is held; elsewhere than at its origin, the origin shifts as the part grows",
    .high = 1,
    .choices = kHeldChoices};

constexpr EffectParameter shift_parameter(std::string_view name, std::string_view unit, std::string_view help) {
  return {.name = name,
          .unit = unit,
          .help = help,
          .typical = 1,
          .low = -50,
          .high = 50,
          .linear = true,
          .only_with = {"held", "elsewhere"}};
}

/// d of a part whose origin has shifted along the part's axes; `held`: a code of kHeldChoices.
inline Vec3 origin_shift(const TouchScene& scene, double held, const Vec3& shift_um) {
  return code(held) == 0 ? Vec3{} : along_normal(scene, kUm * dot(scene.normal_on_part, shift_um));
}

}  // namespace abbe
