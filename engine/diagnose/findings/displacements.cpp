#include "engine/diagnose/findings/displacements.hpp"

namespace abbe::diagnose {

std::vector<Vector> displacements(const Case& c, const std::vector<const Matrix*>& signatures) {
  const Matrix all = with_free(c.model, signatures).free;
  const Vector weight = c.model.noise_um.cwiseInverse();
  const Vector size = least_squares(Matrix(weight.asDiagonal() * all), Vector(weight.cwiseProduct(c.model.y)));
  std::vector<Vector> out;
  Eigen::Index first = c.model.free.cols();
  for (const Matrix* signature : signatures) {
    out.push_back(beside_free(c.model, *signature * size.segment(first, signature->cols())));
    first += signature->cols();
  }
  return out;
}

bool nearly_cancelled(const std::vector<Vector>& displacements, std::size_t which) {
  constexpr double kTimes = 3;
  Vector together = Vector::Zero(displacements[which].size());
  for (const Vector& d : displacements) together += d;
  return displacements[which].norm() > kTimes * together.norm();
}

}  // namespace abbe::diagnose
