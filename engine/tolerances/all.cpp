#include "engine/tolerances/tolerance.hpp"

namespace abbe {

extern const ToleranceKind diameter_tolerance, radius_tolerance, flatness_tolerance, straightness_tolerance,
    circularity_tolerance, cylindricity_tolerance, distance_between_tolerance, distance_from_tolerance,
    true_position_tolerance, coordinate_tolerance, perpendicularity_tolerance, parallelism_tolerance,
    angularity_tolerance, feature_angle_tolerance, angle_of_two_tolerance, angle_from_tolerance,
    concentricity_tolerance, symmetry_tolerance, circular_runout_tolerance, total_runout_tolerance,
    surface_profile_tolerance, line_profile_tolerance, point_profile_tolerance, width_tolerance;

std::span<const ToleranceKind* const> tolerance_kinds() {
  static const ToleranceKind* const kinds[] = {
      &diameter_tolerance,      &radius_tolerance,          &width_tolerance,         &flatness_tolerance,
      &straightness_tolerance,  &circularity_tolerance,     &cylindricity_tolerance,  &distance_between_tolerance,
      &distance_from_tolerance, &true_position_tolerance,   &coordinate_tolerance,    &perpendicularity_tolerance,
      &parallelism_tolerance,   &angularity_tolerance,      &feature_angle_tolerance, &angle_of_two_tolerance,
      &angle_from_tolerance,    &concentricity_tolerance,   &symmetry_tolerance,      &circular_runout_tolerance,
      &total_runout_tolerance,  &surface_profile_tolerance, &line_profile_tolerance,  &point_profile_tolerance,
  };
  return kinds;
}

const ToleranceKind* find_tolerance_kind(std::string_view word) {
  for (const ToleranceKind* kind : tolerance_kinds())
    if (kind->word == word) return kind;
  return nullptr;
}

}  // namespace abbe
