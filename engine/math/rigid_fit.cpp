#include "engine/math/rigid_fit.hpp"

#include <Eigen/Eigenvalues>

#include "engine/math/scatter.hpp"

namespace abbe {

namespace {

/// Points on one line leave the turn about it open: then the second eigenvalue of their scatter vanishes.
bool on_a_line(const std::vector<Vec3>& points, const Vec3& middle) {
  const Eigen3<double> scatter = scatter_about(points, middle);
  return scatter.value[1] <= 1e-9 * scatter.value[0];
}

}  // namespace

std::optional<Rigid> rigid_fit(const std::vector<Vec3>& here, const std::vector<Vec3>& there) {
  if (here.size() < 3 || here.size() != there.size()) return std::nullopt;
  const Vec3 from = mean_of(here), to = mean_of(there);
  if (on_a_line(here, from)) return std::nullopt;
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < here.size(); ++i) {
    const Vec3 a = here[i] - from, b = there[i] - to;
    s += Eigen::Vector3d(a.x, a.y, a.z) * Eigen::RowVector3d(b.x, b.y, b.z);
  }
  Eigen::Matrix4d n;
  n << s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0), s(1, 2) - s(2, 1),
      s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2), s(2, 0) - s(0, 2), s(0, 1) + s(1, 0),
      s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1), s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1),
      s(2, 2) - s(0, 0) - s(1, 1);
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  const double angle = 2 * std::atan2(q.tail<3>().norm(), q(0));
  Mat3 R;
  if (q.tail<3>().norm() > 0) {
    const Eigen::Vector3d axis = q.tail<3>().normalized();
    R = rotation({axis.x(), axis.y(), axis.z()}, angle);
  }
  return Rigid{R, to - R * from};
}

}  // namespace abbe
