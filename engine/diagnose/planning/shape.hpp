// What a feature is, from where it was touched: a recording has labels and touches, and a program needs a
// kind and a nominal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe::diagnose {

/// Touched points of a surface and its normals there, one each.
struct Touched {
  std::vector<Vec3> points, normals;
};

/// A sphere; the radius is negative where it is touched from inside.
struct Ball {
  Vec3 centre;
  double radius_mm = 0;
};
/// The ball of all these points, if there is one that is touched from enough sides.
std::optional<Ball> ball_of(const Touched&);
/// Whether all normals are parallel.
bool is_face(const Touched&);
/// Three points that span the largest triangle that is easily found; fewer where the points lie on a line.
std::vector<std::size_t> widest_triangle(const std::vector<Vec3>& points);

/// The feature in DMIS: kind ("SPHERE"), and what FEAT says of it ("SPHERE,OUTER,CART,..."). A surface of no
/// other kind is a GSURF.
struct DmisFeature {
  std::string kind, definition;
};
DmisFeature dmis_feature(const Touched&);
/// Statements that define a feature and begin to measure it in so many points; that touch one point.
std::string begin_measuring(const std::string& label, const DmisFeature&, std::size_t points);
std::string measure_point(const Vec3& point, const Vec3& normal);

}  // namespace abbe::diagnose
