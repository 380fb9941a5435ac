#include "engine/base/ids.hpp"
#include "engine/features/feature.hpp"

namespace abbe {

extern const FeatureKind point_kind, line_kind, plane_kind, circle_kind, cylinder_kind, sphere_kind, cone_kind,
    torus_kind, arc_kind, edge_point_kind, surface_kind, slot_kind, rectangle_kind, ellipse_kind, parallel_planes_kind,
    symmetry_plane_kind;

std::span<const FeatureKind* const> feature_kinds() {
  static const FeatureKind* const kinds[] = {&point_kind,
                                             &line_kind,
                                             &plane_kind,
                                             &circle_kind,
                                             &cylinder_kind,
                                             &sphere_kind,
                                             &cone_kind,
                                             &torus_kind,
                                             &arc_kind,
                                             &ellipse_kind,
                                             &slot_kind,
                                             &rectangle_kind,
                                             &parallel_planes_kind,
                                             &symmetry_plane_kind,
                                             &edge_point_kind,
                                             &surface_kind};
  return kinds;
}

const FeatureKind& feature_kind(Shape shape) {
  for (const FeatureKind* kind : feature_kinds())
    if (kind->shape == shape) return *kind;
  throw InternalError("a Shape without a FeatureKind");
}

const FeatureKind* find_feature_kind(std::string_view word) {
  for (const FeatureKind* kind : feature_kinds())
    if (kind->word == word) return kind;
  return nullptr;
}

}  // namespace abbe
