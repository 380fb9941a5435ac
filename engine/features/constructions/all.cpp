#include "engine/features/construct.hpp"

namespace abbe {

extern const Construction best_fit, intersection, mid_point, mid_line, mid_plane, projected_point, projected_line,
    perpendicular_through, parallel_through, moved_point, offset_plane, centre_of_gravity, transferred;

std::span<const Construction* const> constructions() {
  static const Construction* const methods[] = {
      &best_fit,         &intersection,          &mid_point,        &mid_line,    &mid_plane,    &projected_point,
      &projected_line,   &perpendicular_through, &parallel_through, &moved_point, &offset_plane, &centre_of_gravity,
      &transferred,
  };
  return methods;
}

const Construction* find_construction(std::string_view word) {
  for (const Construction* method : constructions())
    if (method->word == word) return method;
  return nullptr;
}

}  // namespace abbe
