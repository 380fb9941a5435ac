#include "engine/diagnose/patterns/families.hpp"

namespace abbe::diagnose::patterns {

namespace {

/// Along one scale, in proportion to its temperature.
std::vector<Matrix> along_a_scale(const TouchFactors& f) {
  std::vector<Matrix> out;
  for (int k = 0; k < 3; ++k)
    if (differ(f.scale_above_20[k]))
      out.push_back(Vector(f.scale_above_20[k].array() * component(f.normal, k).array()).asDiagonal() * smooth(f.reading[k], 0.1, 16));
  return out;
}

}  // namespace

void over_temperature(const TouchFactors& f, Family& family) {
  if (differ(f.part_above_20)) {
    family.add("growth", along(f.part_above_20.asDiagonal() * linear(f.place), f.normal));
  }
  if (const std::vector<Matrix> scales = along_a_scale(f); !scales.empty()) family.add_joint("along a scale", scales);
}

}  // namespace abbe::diagnose::patterns
