#include "engine/diagnose/baseline/sudden_change.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/model/prediction.hpp"

namespace abbe::diagnose {

namespace {

using Three = Eigen::Matrix3d;
using MotionColumns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

constexpr int kNear = 15;        ///< touches from the moment at most
constexpr int kLeastBeside = 6;  ///< touches on each side of the moment at least: fewer follow anything
constexpr int kLeastTogether = 2;
/// Least share of a touch's precision that a displacement must leave: otherwise the touch tells nothing but the displacement.
constexpr double kLeftToIt = 0.3;
constexpr double kBroad_um = 1e3;  ///< standard deviation of each coordinate of the displacement

}  // namespace

std::vector<char> put_there_by_a_sudden_change(const Case& c) {
  const std::size_t n = c.masked.size();
  std::vector<char> best(n, 0);
  const auto struck = std::count(c.masked.begin(), c.masked.end(), 1);
  if (struck < kLeastTogether || n < 2 * kLeastBeside) return best;
  const LinearModel whole = compact(c.baseline.model);
  const Matrix k = precision(whole, c.hyper);
  const Vector ky = k * whole.y;
  const std::vector<std::size_t> order = by_time(c.touches);

  // From the end: with every step one touch more is displaced. S: its columns; K S, S' K S and S' K y grow with them.
  MotionColumns ks = MotionColumns::Zero(static_cast<Eigen::Index>(n), 3);
  Eigen::Vector3d sky = Eigen::Vector3d::Zero();
  std::vector<std::size_t> displaced;
  std::ptrdiff_t most = 0;
  for (std::size_t at = n; at-- > kLeastBeside;) {
    const auto i = static_cast<Eigen::Index>(order[at]);
    const Vec3& normal = c.touches.touches[order[at]].scene.normal;
    for (int axis = 0; axis < 3; ++axis) {
      ks.col(axis) += normal[axis] * k.col(i);
      sky(axis) += normal[axis] * ky(i);
    }
    displaced.push_back(order[at]);
    const auto from = order.begin() + static_cast<std::ptrdiff_t>(at > kNear ? at - kNear : 0),
               to = order.begin() + static_cast<std::ptrdiff_t>(std::min(n, at + kNear));
    const auto is_masked = [&](std::size_t touch) { return c.masked[touch] != 0; };
    if (displaced.size() < kLeastBeside || std::count_if(from, to, is_masked) < kLeastTogether) continue;
    Three sks = Three::Identity() / (kBroad_um * kBroad_um);
    for (const std::size_t touch : displaced)
      for (int axis = 0; axis < 3; ++axis)
        sks.row(axis) += c.touches.touches[touch].scene.normal[axis] * ks.row(static_cast<Eigen::Index>(touch));
    const Three inverse = Cholesky(sks).inverse();
    const Eigen::Vector3d displacement = inverse * sky;
    std::vector<char> there(n, 0);
    for (auto touch = from; touch != to; ++touch) {
      if (!is_masked(*touch)) continue;
      const auto row = static_cast<Eigen::Index>(*touch);
      const double left = k(row, row) - (ks.row(row) * inverse * ks.row(row).transpose()).value();
      there[*touch] = left > kLeftToIt * k(row, row) &&
          std::abs(ky(row) - ks.row(row).dot(displacement)) < kOutlier * std::sqrt(left);
    }
    if (const auto count = std::count(there.begin(), there.end(), 1); count >= kLeastTogether && count > most)
      best = std::move(there), most = count;
  }
  return best;
}

}  // namespace abbe::diagnose
