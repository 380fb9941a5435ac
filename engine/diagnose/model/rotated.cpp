#include "engine/diagnose/model/rotated.hpp"

#include <tuple>

#include "engine/diagnose/model/products.hpp"

namespace abbe::diagnose {

std::pair<Matrix, Vector> principal_axes(const Matrix& z) {
  // From the eigenvectors of the smaller of Z'Z and Z Z'.
  constexpr double kNegligible = 1e-6;
  if (z.cols() == 0) return {z, Vector()};
  const bool wide = z.cols() > z.rows();
  const auto [values, all_vectors] = spectrum(wide ? product(z, z.transpose()) : transposed_product(z, z));
  Eigen::Index first = 0;
  while (first < values.size() && values(first) <= kNegligible) ++first;
  const Eigen::Index rank = values.size() - first;
  const Vector lambda = values.tail(rank);
  const Matrix vectors = all_vectors.rightCols(rank);
  Matrix axes = wide ? vectors : Matrix(z * vectors * lambda.cwiseSqrt().cwiseInverse().asDiagonal());
  for (Eigen::Index k = 0; k < rank; ++k) {
    Eigen::Index largest = 0;
    axes.col(k).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, k) < 0) axes.col(k) *= -1;
  }
  return {axes, lambda};
}

Rotated::Rotated(const LinearModel& m, const Hyperparameters& h) : project_(m, h), y_(project_(m.y)) {
  std::tie(basis_, lambda_) = principal_axes(project_(random_at_scale(m, h)));
}

Vector Rotated::z() const { return basis_.transpose() * y_; }

Matrix Rotated::remainder(const Matrix& coordinates) const { return y_ - basis_ * coordinates; }

double Rotated::squares() const {
  const Vector coordinates = z();
  return (coordinates.array().square() / (1 + lambda_.array())).sum() + remainder(coordinates).squaredNorm();
}

Vector Rotated::noise_part() const {
  const Vector taken = lambda_.array() / (1 + lambda_.array());
  return remainder(Vector(taken.array() * z().array()));
}

Matrix Rotated::taken_of_touches() const {
  const Vector share = (lambda_.array() / (1 + lambda_.array())).sqrt();
  return project_.of_touches(side_by_side(project_.free(), basis_ * share.asDiagonal()));
}

Vector Rotated::precision_diagonal() const {
  return project_.noise_precision().first - taken_of_touches().rowwise().squaredNorm();
}

Matrix Rotated::precision() const {
  const Matrix taken = taken_of_touches();
  const auto [own, with_next] = project_.noise_precision();
  Matrix out = -taken * taken.transpose();
  out.diagonal() += own;
  out.diagonal(1) += with_next;
  out.diagonal(-1) += with_next;
  return out;
}

}  // namespace abbe::diagnose
