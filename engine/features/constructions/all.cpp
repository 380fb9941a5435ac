#include "engine/features/construct.hpp"

namespace abbe {

extern const Construction best_fit_method, intersection_method, mid_point_method, mid_line_method, mid_plane_method,
    projected_point_method, projected_line_method, perpendicular_through_method, parallel_through_method,
    moved_point_method, offset_plane_method, centre_of_gravity_method, transferred_method, tangent_method,
    extreme_method, vector_method, cone_section_method;

std::span<const Construction* const> constructions() {
  static const Construction* const methods[] = {
      &best_fit_method,         &intersection_method,    &mid_point_method,      &mid_line_method,
      &mid_plane_method,        &projected_point_method, &projected_line_method, &perpendicular_through_method,
      &parallel_through_method, &moved_point_method,     &offset_plane_method,   &centre_of_gravity_method,
      &transferred_method,      &tangent_method,         &extreme_method,        &vector_method,
      &cone_section_method,
  };
  return methods;
}

const Construction* find_construction(std::string_view word) {
  for (const Construction* method : constructions())
    if (method->word == word) return method;
  return nullptr;
}

}  // namespace abbe
