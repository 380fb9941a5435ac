#include "engine/diagnose/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// The approach speed beyond its mean, 1 at the farthest from it.
Vector faster(const TouchFactors& f) {
  Vector v(static_cast<Eigen::Index>(f.speed.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) v(i) = f.speed[static_cast<std::size_t>(i)];
  v.array() -= v.mean();
  return v / v.cwiseAbs().maxCoeff();
}

}  // namespace

void over_speed(const TouchFactors& f, Family& family) {
  if (several(f.speed)) {
    family.add("offset", indicator(f.speed));
    family.add_joint("over direction", products(smooth(as_points(f.travel), 0.6, 24), faster(f)));
  }
}

}  // namespace abbe::diagnose::patterns
