#include "engine/diagnose/findings/same_phase.hpp"

#include "engine/effects/effect.hpp"

namespace abbe::diagnose {

bool same_phase_in_same_direction(const Case& c, const Finding& f) {
  constexpr double kSameNormal = 0.02, kSamePlace_mm = 1, kSame = 0.8;
  constexpr int kLeastPairs = 20;  // of fewer, chance may make all alike
  const Effect* effect = c.explanations.list[static_cast<std::size_t>(f.explanation)].effect;
  if (!effect || !needs_raw_reading(*effect)) return false;
  const Matrix& does = c.explanations.blocks[static_cast<std::size_t>(f.block)].signature;
  const auto scene_of = [&](Eigen::Index row) -> const TouchScene& {
    return c.touches.touches[static_cast<std::size_t>(c.rows[static_cast<std::size_t>(row)])].scene;
  };
  double alike = 0, all = 0;
  int pairs = 0;
  for (Eigen::Index i = 0; i < does.rows(); ++i) {
    const TouchScene& a = scene_of(i);
    for (Eigen::Index k = 0; k < i; ++k) {
      const TouchScene& b = scene_of(k);
      if (norm(a.normal - b.normal) > kSameNormal || norm(a.point - b.point) < kSamePlace_mm) continue;
      alike += does.row(i).dot(does.row(k));
      all += (does.row(i).squaredNorm() + does.row(k).squaredNorm()) / 2;
      ++pairs;
    }
  }
  return pairs >= kLeastPairs && alike > kSame * all;
}

}  // namespace abbe::diagnose
