#include "engine/diagnose/baseline/calibrated_part.hpp"

#include <set>
#include <utility>

namespace abbe::diagnose {

namespace {

constexpr int kPlacement = 6;  // unknowns of one setup; they stand before those of the surfaces

/// Whether a column of the unknowns is the place of a surface (or of one point of it) that is calibrated:
/// ones in its rows.
bool of_calibrated_surface(const Vector& column, const RecordedPart& part, const RecordedTouches& t) {
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    if (column(i) == 0) continue;
    if (column(i) != 1 || !part.calibrated[t.touches[i].scene.feature]) return false;
  }
  return true;
}

}  // namespace

void remove_expected(const RecordedPart& part, RecordedTouches& t) {
  for (std::size_t i = 0; i < t.touches.size(); ++i) t.touches[i].residual_mm -= part.expected_mm[i];
}

void calibrate(const RecordedPart& part, const RecordedTouches& t, Baseline& baseline) {
  LinearModel& m = baseline.model;
  std::set<int> setups;
  for (const RecordedTouch& touch : t.touches) setups.insert(touch.scene.setup);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < m.free.cols(); ++k)
    if (k < kPlacement * static_cast<Eigen::Index>(setups.size()) || !of_calibrated_surface(m.free.col(k), part, t))
      kept.push_back(k);
  m.free = Matrix(m.free(Eigen::all, kept));
  for (const std::vector<double>& doubt : part.doubt_mm)
    m = with_random(std::move(m),
                    kUmPerMm * Eigen::Map<const Vector>(doubt.data(), static_cast<Eigen::Index>(doubt.size())));
}

}  // namespace abbe::diagnose
