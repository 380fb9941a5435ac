#include "engine/diagnose/values/value_estimate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "engine/diagnose/values/value_signature.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kMachines = 200, kSteps = 4;
constexpr double kWide = 30;       // typical sizes: a prior that does not pull
constexpr double kSettled = 0.05;  // standard uncertainties
constexpr double kMove = 0.1;      // typical sizes, for the derivatives; they are taken on the same machines

Machine with_effect(const Machine& machine, const Effect& effect, const Block& block, const Vector& sizes) {
  std::vector<double> theta = block.theta;
  for (std::size_t k = 0; k < block.columns.size(); ++k) {
    const auto p = static_cast<std::size_t>(block.columns[k].parameter);
    theta[p] = std::clamp(sizes(static_cast<Eigen::Index>(k)) * block.columns[k].unit, effect.parameters[p].low,
                          effect.parameters[p].high);
  }
  Machine planted = machine;
  planted.effects.push_back(setting_of(effect, theta));
  return planted;
}

}  // namespace

std::optional<Sizes> sizes_beside_errors(const ValueBench& b, const Effect& effect, const Block& block,
                                         const Vector& start) {
  const VirtualMachines machines = screened_machines(b.machine, b.options.seed, kMachines, b.options.threads);
  const auto values_at = [&](const Vector& sizes) {
    return simulated_values(b.values, b.programs, with_effect(b.machine, effect, block, sizes), machines, b.options);
  };
  const Eigen::LLT<Matrix> weight(b.covariance);
  Sizes out{start, {}};
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Index columns = start.size();
    Matrix together = values_at(out.mean);  // next to each other: what is simulated here, and beside each derivative
    const Eigen::Index n = together.cols();
    for (Eigen::Index k = 0; k < columns; ++k) {
      together.conservativeResize(Eigen::NoChange, (k + 2) * n);
      together.rightCols(n) = values_at(out.mean + kMove * Vector::Unit(columns, k));
    }
    together = complete_rows(together);
    if (together.rows() < kMachines / 4) return std::nullopt;
    const Vector means = together.colwise().mean();
    Matrix slopes(n, columns);
    for (Eigen::Index k = 0; k < columns; ++k) slopes.col(k) = (means.segment((k + 1) * n, n) - means.head(n)) / kMove;
    const Matrix weighted = weight.solve(slopes);
    const Matrix information = slopes.transpose() * weighted + Matrix::Identity(columns, columns) / (kWide * kWide);
    const Matrix gain = Eigen::LLT<Matrix>(information).solve(weighted.transpose());
    const Matrix strayed = (together.leftCols(n).rowwise() - means.head(n).transpose()) * gain.transpose();
    const Matrix calibration = gain * b.calibration;
    out.covariance = strayed.transpose() * strayed / double(strayed.rows() - 1) + calibration * calibration.transpose();
    const Vector change = gain * (b.deviation - means.head(n));
    out.mean += change;
    if ((change.array().abs() < kSettled * out.covariance.diagonal().array().sqrt()).all()) break;
  }
  return out;
}

}  // namespace abbe::diagnose
