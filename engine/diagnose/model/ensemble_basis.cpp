#include "engine/diagnose/model/ensemble_basis.hpp"

#include <cmath>
#include <tuple>

namespace abbe::diagnose {

EnsembleBasis::EnsembleBasis(const LinearModel& m, const Hyperparameters& h) : project_(m, h) {
  std::tie(kept_.axes, kept_.variance) = principal_axes(project_(m.random(Eigen::all, columns_of_group(m, false))));
  std::tie(basis_, lambda_) = principal_axes(project(m.random(Eigen::all, columns_of_group(m, true))));
  rest_dof_ = static_cast<int>(m.y.size() - project_.free().cols() - lambda_.size());
  log_density_ = abbe::diagnose::log_density(m, h) - 0.5 * kept_.variance.array().log1p().sum();
}

Matrix EnsembleBasis::Kept::whitened(Matrix projected) const {
  if (variance.size() == 0) return projected;
  const Vector less = 1 - (1 + variance.array()).rsqrt();
  const Matrix taken = less.asDiagonal() * (axes.transpose() * projected);
  projected.noalias() -= axes * taken;
  return projected;
}

Matrix EnsembleBasis::Kept::unwhitened(Matrix white) const {
  if (variance.size() == 0) return white;
  const Vector more = (1 + variance.array()).sqrt() - 1;
  const Matrix added = more.asDiagonal() * (axes.transpose() * white);
  white.noalias() += axes * added;
  return white;
}

Vector EnsembleBasis::recording(const Vector& coordinates, const Vector& kept, const Vector& noise) const {
  Vector projected = noise - project_.free() * (project_.free().transpose() * noise);
  projected += kept_.unwhitened(basis_ * coordinates);
  projected += kept_.axes * Vector(kept_.variance.array().sqrt() * kept.array());
  return project_.unwhitened(projected);
}

}  // namespace abbe::diagnose
