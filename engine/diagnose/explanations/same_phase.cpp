#include "engine/diagnose/explanations/same_phase.hpp"

#include <algorithm>

namespace abbe::diagnose {

SameDirection::SameDirection(const RecordedTouches& t, const std::vector<int>& rows) {
  constexpr double kSameNormal = 0.02, kSamePlace_mm = 1;
  const auto scene_of = [&](Eigen::Index row) -> const TouchScene& {
    return t.touches[rows[static_cast<std::size_t>(row)]].scene;
  };
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(rows.size()); ++k) {
    const TouchScene& s = scene_of(k);
    const auto same = std::find_if(directions_.begin(), directions_.end(), [&](const auto& direction) {
      return norm(scene_of(direction.front()).normal - s.normal) < kSameNormal;
    });
    if (same == directions_.end())
      directions_.push_back({k});
    else if (std::none_of(same->begin(), same->end(),
                          [&](Eigen::Index other) { return norm(scene_of(other).point - s.point) < kSamePlace_mm; }))
      same->push_back(k);
  }
}

bool SameDirection::is_alike(const Matrix& signature) const {
  constexpr double kSame = 0.8;
  constexpr std::size_t kLeastPairs = 20;  // of fewer, chance may make all alike
  // Products of all pairs of rows, and half the sums of their squares.
  double alike = 0, all = 0;
  std::size_t pairs = 0;
  for (const std::vector<Eigen::Index>& direction : directions_) {
    const Matrix does = signature(direction, Eigen::all);
    const double squares = does.squaredNorm();
    alike += (does.colwise().sum().squaredNorm() - squares) / 2;
    all += double(direction.size() - 1) * squares / 2;
    pairs += direction.size() * (direction.size() - 1) / 2;
  }
  return pairs >= kLeastPairs && alike > kSame * all;
}

}  // namespace abbe::diagnose
