#include "engine/math/rigid_fit.hpp"

#include <Eigen/Eigenvalues>

namespace abbe {

namespace {

Vec3 centre(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Points on one line leave the turn about it open: then the second eigenvalue of their scatter vanishes.
bool on_a_line(const std::vector<Vec3>& points, const Vec3& middle) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    const Eigen::Vector3d d(p.x - middle.x, p.y - middle.y, p.z - middle.z);
    scatter += d * d.transpose();
  }
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  return values(1) <= 1e-9 * values(2);
}

}  // namespace

std::optional<Rigid> rigid_fit(const std::vector<Vec3>& here, const std::vector<Vec3>& there) {
  if (here.size() < 3 || here.size() != there.size()) return std::nullopt;
  const Vec3 from = centre(here), to = centre(there);
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
