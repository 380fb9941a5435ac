#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// The approach speed beyond its mean, 1 at the farthest from it.
Vector faster(const TouchFactors& f) {
  Vector v = Eigen::Map<const Vector>(f.speed_mm_s.data(), static_cast<Eigen::Index>(f.speed_mm_s.size()));
  v.array() -= v.mean();
  return v / v.cwiseAbs().maxCoeff();
}

/// At each speed and acceleration: over the angle between approach and shank alone, up to its second power,
/// or over the direction of travel on the probe; each stylus by itself.
std::vector<Matrix> of_each_sensor(const TouchFactors& f) {
  const Vector c = component(f.travel_on_probe, 2);
  Matrix about_the_shank(c.size(), 3);
  about_the_shank << Vector::Ones(c.size()), c, c.array().square();
  const Matrix over_travel = side_by_side(constant(f.travel.size()), smooth(as_points(f.travel_on_probe), 0.9, 8));
  std::vector<Matrix> out;
  for (const Matrix& over : {about_the_shank, over_travel}) {
    const Matrix swing = products(indicator(f.dynamics), over);
    out.push_back(several(f.sensor) ? by_group(swing, f.sensor) : swing);
  }
  return out;
}

}  // namespace

void over_speed(const TouchFactors& f, Family& family) {
  if (several(f.speed)) {
    family.add("offset", indicator(f.speed));
    family.add("over direction", products(smooth(as_points(f.travel), 0.6, 24), faster(f)));
  }
  if (several(f.dynamics)) {
    family.add("of each sensor", of_each_sensor(f));
    family.add("over position", along(products(linear(f.place), indicator(f.dynamics)), f.normal));
  }
}

}  // namespace abbe::diagnose::patterns
