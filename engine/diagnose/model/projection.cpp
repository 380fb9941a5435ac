#include "engine/diagnose/model/projection.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/products.hpp"

namespace abbe::diagnose {

namespace {

/// What X leaves of a pattern below which it is nothing: the last digits of targets and readings, which hold
/// the touch's own error and, enlarged into a pattern, would explain it.
constexpr double kNothingLeft = 1e-4;  // of its length

}  // namespace

Vector weights(const LinearModel& m, const Hyperparameters& h) {
  Vector w(m.y.size());
  for (Eigen::Index i = 0; i < w.size(); ++i) w(i) = 1 / (m.noise_um(i) * h.noise(m.noise_group[i]));
  return w;
}

Matrix whitened(const Matrix& columns, const Vector& weight, double phi, const std::vector<char>& follows) {
  Matrix out = weight.asDiagonal() * columns;
  if (phi == 0) return out;
  const double rescale = 1 / std::sqrt(1 - phi * phi);
  for (Eigen::Index i = out.rows() - 1; i > 0; --i)
    if (follows[i]) out.row(i) = (out.row(i) - phi * out.row(i - 1)) * rescale;
  return out;
}

double log_density(const LinearModel& m, const Hyperparameters& h) {
  const Vector weight = weights(m, h);
  const auto neighbours = static_cast<double>(std::count(m.follows.begin(), m.follows.end(), 1));
  const Matrix x = whitened(independent(m.free), weight, h.correlation, m.follows);
  return weight.array().log().sum() - 0.5 * neighbours * std::log(1 - h.correlation * h.correlation) -
      Cholesky(x.transpose() * x).half_log_determinant();
}

Projection::Projection(const LinearModel& m, const Hyperparameters& h)
    : follows_(m.follows),
      weight_(weights(m, h)),
      correlation_(h.correlation),
      q_(independent(whitened(m.free, weight_, correlation_, follows_))) {}

Matrix Projection::operator()(const Matrix& columns) const {
  Matrix w = whitened(columns, weight_, correlation_, follows_);
  w -= product(q_, transposed_product(q_, w));
  return w;
}

Matrix Projection::of_patterns(const Matrix& columns) const {
  Matrix w = whitened(columns, weight_, correlation_, follows_);
  const Vector length = w.colwise().norm();
  w -= product(q_, transposed_product(q_, w));
  for (Eigen::Index k = 0; k < w.cols(); ++k)
    if (w.col(k).norm() < kNothingLeft * length(k)) w.col(k).setZero();
  return w;
}

Matrix Projection::of_touches(const Matrix& whitened) const {
  if (correlation_ == 0) return whitened;
  const double rescale = 1 / std::sqrt(1 - correlation_ * correlation_);
  const auto follows = [&](Eigen::Index i) { return i < whitened.rows() && follows_[i]; };
  Matrix out = whitened;
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    if (follows(i)) out.row(i) *= rescale;
    if (follows(i + 1)) out.row(i) -= correlation_ * rescale * whitened.row(i + 1);
  }
  return out;
}

std::pair<Vector, Vector> Projection::noise_precision() const {
  const double share = correlation_ * correlation_, rest = 1 - share;
  const Eigen::Index n = weight_.size();
  Vector own = Vector::Ones(n), with_next = Vector::Zero(n - 1);
  for (Eigen::Index i = 1; i < n; ++i) {
    if (!follows_[i]) continue;
    own(i) += share / rest;
    own(i - 1) += share / rest;
    with_next(i - 1) = -correlation_ / rest;
  }
  return {own, with_next};
}

Vector Projection::unwhitened(const Vector& projected) const {
  const double rescale = std::sqrt(1 - correlation_ * correlation_);
  Vector out = projected;
  for (Eigen::Index i = 1; i < out.size(); ++i)
    if (follows_[i]) out(i) = rescale * out(i) + correlation_ * out(i - 1);
  return out.array() / weight_.array();
}

}  // namespace abbe::diagnose
