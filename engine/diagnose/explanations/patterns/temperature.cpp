#include "engine/diagnose/explanations/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// Along one scale, in proportion to its temperature.
std::vector<Matrix> along_a_scale(const TouchFactors& f) {
  std::vector<Matrix> out;
  for (int k = 0; k < 3; ++k)
    if (differ(f.scale_above_20[k]))
      out.push_back(Vector(f.scale_above_20[k].array() * component(f.normal, k).array()).asDiagonal() *
                    smooth(f.reading[k], 0.1, 16));
  return out;
}

}  // namespace

void over_temperature(const TouchFactors& f, Family& family) {
  if (differ(f.part_above_20)) {
    const Vector warmer = f.part_above_20.array() - f.part_above_20.mean();
    const Matrix of_feature = warmer.asDiagonal() * indicator(f.feature),
                 of_sensor = warmer.asDiagonal() * indicator(f.sensor);
    family.add("growth", along(f.part_above_20.asDiagonal() * linear(f.place), f.normal));
    family.add("over position", along(warmer.asDiagonal() * smooth(f.place, 0.6, 8), f.normal));
    family.add("over direction", warmer.asDiagonal() * smooth(as_points(f.normal), 0.9, 8));
    family.add("of each feature", side_by_side(of_feature, along(of_feature, f.normal_on_part)));
    if (several(f.sensor)) family.add("of each sensor", side_by_side(along(of_sensor, f.normal), of_sensor));
  }
  if (const std::vector<Matrix> scales = along_a_scale(f); !scales.empty()) family.add("along a scale", scales);
}

}  // namespace abbe::diagnose::patterns
