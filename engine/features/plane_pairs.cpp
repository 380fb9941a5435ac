// PARPLN and SYMPLN: two opposite faces with one common normal, fitted together: the normal is that of
// least spread of both groups of touches about their own means, the width the distance of the means.
// Which face a touch belongs to is said by the side of the nominal median plane on which it lies.
#include <algorithm>
#include <cmath>

#include "engine/features/feature.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/shape_traits.hpp"
#include "engine/features/solve.hpp"
#include "engine/features/spread.hpp"

namespace abbe {
namespace {

Outcome<Element> median(const Vec3& point, const Vec3& normal, double width) {
  if (!(width > 0)) return Outcome<Element>::failed("the width must be positive");
  return {{.point = point, .direction = normal, .size = width / 2}};
}

Outcome<Element> nominal_planes(const Arguments& arguments) {
  if (arguments.has("width")) {
    const Outcome<Vec3> along = direction(arguments);
    return along ? median(location(arguments), along.value, arguments.number("width"))
                 : Outcome<Element>::failed(along.failure);
  }
  const Vec3 p1{arguments.number("x1"), arguments.number("y1"), arguments.number("z1")};
  const Vec3 p2{arguments.number("x2"), arguments.number("y2"), arguments.number("z2")};
  const Vec3 n1{arguments.number("i1"), arguments.number("j1"), arguments.number("k1")};
  const Vec3 n2{arguments.number("i2"), arguments.number("j2"), arguments.number("k2")};
  if (!(norm(n1) > 0 && norm(n2) > 0)) return Outcome<Element>::failed("a normal has no length");
  if (norm(cross(unit(n1), unit(n2))) > kOneDegreeSine)
    return Outcome<Element>::failed("the two planes are not parallel");
  return median(0.5 * (p1 + p2), unit(n1), std::fabs(dot(p2 - p1, unit(n1))));
}

/// The touches of one lane by face, relative to the start.
struct Faces {
  std::vector<Vec3> points[2];
  Vec3 mean[2];
};

Faces split(const PointColumns& columns, int lane, const Element& start) {
  Faces f;
  for (int t = 0; t < columns.points; ++t) {
    const Vec3 p = columns.at(t, lane) - start.point;
    f.points[dot(p, start.direction) > 0].push_back(p);
  }
  for (int side = 0; side < 2; ++side)
    for (const Vec3& p : f.points[side]) f.mean[side] += p / static_cast<double>(f.points[side].size());
  return f;
}

const char* fit_lane(const PointColumns& columns, int lane, const Element& start, Element& result) {
  for (int t = 0; t < columns.points; ++t)
    if (!std::isfinite(norm(columns.at(t, lane)))) return reason_of("not_finite");
  const Faces f = split(columns, lane, start);
  if (f.points[0].empty() || f.points[1].empty()) return "all touches lie on one side of the nominal median plane";
  double products[3][3] = {};
  for (int side = 0; side < 2; ++side)
    for (const Vec3& p : f.points[side])
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) products[i][j] += (p - f.mean[side])[i] * (p - f.mean[side])[j];
  const Spread<double> spread = spread_of(products, columns.points);
  if (spread.along[1] <= 1e-9 * spread.along[0]) return "the touches of the two faces lie along one direction";
  Vec3 n{spread.direction[2][0], spread.direction[2][1], spread.direction[2][2]};
  if (dot(n, start.direction) < 0) n = -n;
  const double far = dot(f.mean[1], n), near = dot(f.mean[0], n);
  Element e = start;
  const Vec3 middle = 0.5 * (f.mean[0] + f.mean[1]);
  e.point = start.point + middle + (0.5 * (far + near) - dot(middle, n)) * n;
  e.direction = n;
  e.size = 0.5 * (far - near);
  e.low = INFINITY, e.high = -INFINITY, e.end = 0;
  for (int side = 0; side < 2; ++side)
    for (const Vec3& p : f.points[side]) {
      const double outward = side ? dot(p, n) - far : near - dot(p, n);
      e.low = std::min(e.low, outward), e.high = std::max(e.high, outward);
      e.end = std::max(e.end, norm(perpendicular_part(start.point + p - e.point, n)));
    }
  e.begin = -e.end;
  result = e;
  return nullptr;
}

void fit_planes(const PointColumns& columns, const Element* start, Element* result, const char** failure) {
  for (int l = 0; l < columns.lanes; ++l) failure[l] = fit_lane(columns, l, start[l], result[l]);
}

/// By turns on the two faces, on each as on a plane.
Outcome<PatternTouch> touch_faces(const Element& e, bool, int k, int n) {
  const double sign = k % 2 ? -1 : 1;
  const PatternGrid grid(k / 2, (n + 1 - k % 2) / 2);
  // Crosswise, so that two touches on each face settle the normal.
  const Across across(e.direction);
  const Vec3 there = k % 2 ? grid.b * across.a + grid.a * across.b : grid.a * across.a + grid.b * across.b;
  return {{e.point + there + sign * e.size * e.direction, sign * e.direction}};
}

constexpr Pattern kFacesByTurns{.help = "by turns on the two faces, on each as on a plane", .touch = touch_faces};

Outcome<Vec3> nearer_face_normal(const Element& e, const Vec3& point) {
  return {dot(point - e.point, e.direction) < 0 ? -e.direction : e.direction};
}

FeatArguments written_parallel_planes(const Element& e) { return {"MIDPL", "CART", e.point, e.direction, 2 * e.size}; }
FeatArguments written_symmetry_plane(const Element& e) { return {"CART", e.point, e.direction, 2 * e.size}; }

}  // namespace

extern const FeatureKind parallel_planes_kind{
    .shape = Shape::parallel_planes,
    .acts_as = Shape::plane,
    .flat = true,
    .word = "PARPLN",
    .signature =
        "side:INNER|OUTER,( CART,x1:length,y1:length,z1:length,i1:number,j1:number,k1:number,x2:length,y2:length,z2:length,"
        "i2:number,j2:number,k2:number ; [ MIDPL ]," ABBE_LOCATION "," ABBE_DIRECTION ",width:length )",
    .help = "two parallel planes: a point of the median plane, its normal, the width; or a point and normal of each",
    .example = "F(PP1)=FEAT/PARPLN,INNER,MIDPL,CART,40,30,-5,0,1,0,10",
    .source = "ISO 22093:2011, FEAT/PARPLN; least squares with a common normal",
    .nominal = nominal_planes,
    .written = written_parallel_planes,
    .normal = nearer_face_normal,
    .pattern = kFacesByTurns,
    .minimum_points = 4,
    .fit_lanes = fit_planes,
};

extern const FeatureKind symmetry_plane_kind{
    .shape = Shape::symmetry_plane,
    .acts_as = Shape::plane,
    .flat = true,
    .word = "SYMPLN",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",width:length",
    .help = "the plane midway between two opposite faces: a point of it, its normal, the distance of the faces",
    .example = "F(SP1)=FEAT/SYMPLN,OUTER,CART,0,0,0,1,0,0,80",
    .source = "ISO 22093:2011, FEAT/SYMPLN; as PARPLN",
    .nominal = nominal_planes,
    .written = written_symmetry_plane,
    .normal = nearer_face_normal,
    .pattern = kFacesByTurns,
    .minimum_points = 4,
    .fit_lanes = fit_planes,
};

}  // namespace abbe
