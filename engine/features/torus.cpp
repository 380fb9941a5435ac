#include "engine/features/feature.hpp"
#include "engine/features/lane_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/points_fit.hpp"

namespace abbe {

/// Of tori: also that of the best cylinder.
template <>
Extended limit_cost<TorusProfile>(const Cloud& cloud, const Points<double>& sampled) {
  const Extended flat = limit_cost<CylinderProfile>(cloud, sampled);
  const auto straight =
      minima<CylinderProfile>(cloud, descents<CylinderProfile>(cloud, cylinder_starts(sampled, cloud.spread), sampled));
  return straight.empty() ? flat : std::min(flat, straight.front().cost);
}

namespace {

Outcome<Element> nominal_torus(const Arguments& arguments) {
  const Outcome<Vec3> along = direction(arguments);
  if (!along) return Outcome<Element>::failed(along.failure);
  const Outcome<double> major = radius(arguments, "majdia"), minor = radius(arguments, "mindia");
  if (!major) return Outcome<Element>::failed(major.failure);
  if (!minor) return Outcome<Element>::failed(minor.failure);
  return {{.point = location(arguments), .direction = along.value, .size = major.value, .minor_size = minor.value}};
}

/// By turns on three circles of the half of the tube that the axis points out of: its ridge, its outside and
/// its inside. The inside is turned by half a step, so that seven touches, three of them on the ridge,
/// determine the torus.
Outcome<PatternTouch> touch_torus(const Element& e, bool, int k, int n) {
  const int circle = k % 3, on_this = (n - circle + 2) / 3;
  const Vec3 away = Across(e.direction).at(2 * kPi * (k / 3 + (circle == 2 ? 0.5 : 0)) / on_this);
  const Vec3 out = circle == 0 ? e.direction : circle == 1 ? away : -away;
  return {{e.point + e.size * away + e.minor_size * out, out}};
}

/// Away from the nearest point of the centre line of the tube.
Outcome<Vec3> torus_normal(const Element& e, const Vec3& point) {
  using Normal = Outcome<Vec3>;
  const Vec3 across = perpendicular_part(point - e.point, e.direction);
  if (norm(across) == 0) return Normal::failed("the point lies on the axis of the torus: give the vector in PTMEAS");
  const Vec3 out = point - (e.point + e.size * unit(across));
  if (norm(out) == 0) return Normal::failed("the point lies in the middle of the tube: give the vector in PTMEAS");
  return {unit(out)};
}

FeatArguments written_torus(const Element& e) { return {"CART", e.point, e.direction, 2 * e.size, 2 * e.minor_size}; }

}  // namespace

extern const FeatureKind torus_kind{
    .shape = Shape::torus,
    .word = "TORUS",
    .signature = "side:INNER|OUTER," ABBE_LOCATION "," ABBE_DIRECTION ",majdia:length,mindia:length",
    .help = "a torus: centre, axis, diameter of the centre line of the tube, diameter of the tube",
    .example = "F(T1)=FEAT/TORUS,OUTER,CART,0,0,0,0,0,1,80,20",
    .source = "ISO 22093:2011, FEAT/TORUS; distance from the centre line of the tube",
    .nominal = nominal_torus,
    .written = written_torus,
    .normal = torus_normal,
    .pattern =
        {.help =
             "by turns on the ridge of the tube (where its axis points), on its outside and its inside, evenly round, the inside "
             "turned by half a step",
         .touch = touch_torus},
    .minimum_points = 7,
    .fit_lanes = fit_lanes_of<TorusProfile>,
    .fit_points = fit_points_of<TorusProfile, torus_starts>,
    .fit_names = {.element = "torus",
                  .point = "center",
                  .direction = "axis",
                  .size = "major_radius",
                  .minor_size = "minor_radius"},
};

}  // namespace abbe
