#include "engine/diagnose/model/ensemble_basis.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "engine/diagnose/model/products.hpp"
#include "engine/diagnose/model/rotated.hpp"

namespace abbe::diagnose {

namespace {

/// The columns that keep their scale, by the row from which on they act: in whatever order a model has them, the same
/// recordings are simulated.
Matrix kept_columns(const LinearModel& m) {
  constexpr double kActs = 0.5;  // of where it does most
  const auto first_row = [&](Eigen::Index k) {
    const Vector size = m.random.col(k).cwiseAbs();
    return std::find_if(size.begin(), size.end(), [least = kActs * size.maxCoeff()](double s) { return s >= least; }) -
        size.begin();
  };
  std::vector<Eigen::Index> order = columns_of_group(m, false);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return first_row(a) < first_row(b); });
  return m.random(Eigen::all, order);
}

}  // namespace

EnsembleBasis::EnsembleBasis(const LinearModel& m, const Hyperparameters& h)
    : project_(m, h), kept_columns_(project_(kept_columns(m))) {
  std::tie(kept_.axes, kept_.variance) = principal_axes(kept_columns_);
  std::tie(basis_, lambda_) = principal_axes(project(m.random(Eigen::all, columns_of_group(m, true))));
  rest_dof_ = static_cast<int>(m.y.size() - project_.free().cols() - lambda_.size());
  log_density_ = abbe::diagnose::log_density(m, h) - 0.5 * kept_.variance.array().log1p().sum();
}

Matrix EnsembleBasis::Kept::whitened(Matrix projected) const {
  if (variance.size() == 0) return projected;
  const Vector less = 1 - (1 + variance.array()).rsqrt();
  return projected - product(axes, less.asDiagonal() * transposed_product(axes, projected));
}

Matrix EnsembleBasis::Kept::unwhitened(Matrix white) const {
  if (variance.size() == 0) return white;
  const Vector more = (1 + variance.array()).sqrt() - 1;
  const Matrix added = more.asDiagonal() * (axes.transpose() * white);
  white.noalias() += axes * added;
  return white;
}

Matrix EnsembleBasis::coordinates(const Matrix& projected) const { return transposed_product(basis_, projected); }

Matrix EnsembleBasis::remainder(const Matrix& projected, const Matrix& coordinates) const {
  return projected - product(basis_, coordinates);
}

Vector EnsembleBasis::recording(const Vector& coordinates, const Vector& kept, const Vector& noise) const {
  Vector projected = noise - project_.free() * (project_.free().transpose() * noise);
  projected += kept_.unwhitened(basis_ * coordinates);
  projected += kept_columns_ * kept;
  return project_.unwhitened(projected);
}

}  // namespace abbe::diagnose
