#include "engine/diagnose/model/linear.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "engine/base/ids.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kNoisePrior = 0.5;  // of the logarithm
constexpr double kDependent = 1e-6;  // of the length of a column, whatever its unit: less is the rounding of targets
/// What X leaves of a pattern below which it is nothing: the last digits of targets and readings, which hold
/// the touch's own error and, enlarged into a pattern, would explain it.
constexpr double kNothingLeft = 1e-4;  // of its length
constexpr double kCorrelations[] = {0.15, 0.3, 0.45, 0.6, 0.75};
constexpr double kCorrelationGain = 3;  // nats that a correlation must gain to be believed

/// Rows divided by their standard deviation, then differenced so that neighbours are independent again.
Matrix whitened(const Matrix& columns, const Vector& weight, double phi, const std::vector<char>& follows) {
  Matrix out = weight.asDiagonal() * columns;
  if (phi == 0) return out;
  const double rescale = 1 / std::sqrt(1 - phi * phi);
  for (Eigen::Index i = out.rows() - 1; i > 0; --i)
    if (follows[i]) out.row(i) = (out.row(i) - phi * out.row(i - 1)) * rescale;
  return out;
}

Vector weights(const LinearModel& m, const Hyperparameters& h) {
  Vector w(m.y.size());
  for (Eigen::Index i = 0; i < w.size(); ++i) w(i) = 1 / (m.noise_um(i) * h.noise(m.noise_group[i]));
  return w;
}

/// Moments of whitened rows by noise group, from which the likelihood at any noise and scale follows without
/// a pass over the rows.
class Likelihood {
 public:
  Likelihood(const LinearModel& m, double phi) : model_(m), phi_(phi) {
    const Vector unit = m.noise_um.cwiseInverse();
    const Matrix x = independent(m.free);
    free_ = x.cols();
    q_ = free_ + m.random.cols();
    Matrix w(m.y.size(), q_);
    w << x, m.random;
    const Matrix rows = whitened(w, unit, phi, m.follows), y = whitened(m.y, unit, phi, m.follows);
    for (int g = 0; g < m.noise_groups; ++g) {
      std::vector<Eigen::Index> in;
      for (Eigen::Index i = 0; i < rows.rows(); ++i)
        if (m.noise_group[i] == g) in.push_back(i);
      const Matrix part = rows(in, Eigen::all);
      const Vector part_y = y(in, 0);
      moments_.push_back({Matrix(part.transpose() * part), part.transpose() * part_y, part_y.squaredNorm(),
                          static_cast<double>(in.size())});
    }
  }

  /// Logarithm of the restricted likelihood times the priors; constants left out.
  double at(const Hyperparameters& h) const {
    if (h.noise.minCoeff() < model_.quietest) return -std::numeric_limits<double>::infinity();
    Matrix m = Matrix::Zero(q_, q_);
    Vector b = Vector::Zero(q_);
    double squares = 0, log_noise = 0, prior = 0;
    for (std::size_t g = 0; g < moments_.size(); ++g) {
      const double w = 1 / (h.noise(g) * h.noise(g));
      m += w * moments_[g].square;
      b += w * moments_[g].product;
      squares += w * moments_[g].y_square;
      log_noise += 2 * moments_[g].rows * std::log(h.noise(g));
      prior += std::pow(std::log(h.noise(g)) / kNoisePrior, 2);
    }
    prior += std::pow(std::log(h.scale) / model_.scale_spread, 2);
    double log_scale = 0;
    for (Eigen::Index k = 0; k < model_.random.cols(); ++k) {
      const double s2 = model_.random_group[k] == 0 ? h.scale * h.scale : 1;
      m(free_ + k, free_ + k) += 1 / s2;
      log_scale += std::log(s2);
    }
    const Eigen::LLT<Matrix> llt(m);
    const Vector v = llt.matrixL().solve(b);
    const double log_m = 2 * llt.matrixLLT().diagonal().array().log().sum();
    double rows = 0;
    for (std::size_t i = 0; i < model_.follows.size(); ++i) rows += model_.follows[i] ? 1 : 0;
    const double log_phi = rows * std::log(1 - phi_ * phi_);
    return -0.5 * (log_noise + log_phi + log_m + log_scale + squares - v.squaredNorm() + prior);
  }

 private:
  struct Moments {
    Matrix square;
    Vector product;
    double y_square = 0, rows = 0;
  };
  const LinearModel& model_;
  Eigen::Index free_ = 0, q_ = 0;
  double phi_;
  std::vector<Moments> moments_;
};

/// Coordinate search in the logarithms: few parameters, a smooth and nearly separable function.
double maximise(const Likelihood& likelihood, Hyperparameters& h, double first_step) {
  double best = likelihood.at(h);
  const int parameters = static_cast<int>(h.noise.size()) + 1;
  const auto parameter = [&](int p) -> double& { return p == 0 ? h.scale : h.noise(p - 1); };
  for (double step = first_step; step > 0.03; step /= 2.5) {
    for (bool moved = true; moved;) {
      moved = false;
      for (int p = 0; p < parameters; ++p) {
        for (const double factor : {std::exp(step), std::exp(-step)}) {
          const double before = parameter(p);
          parameter(p) = before * factor;
          const double value = likelihood.at(h);
          if (value > best + 1e-3) {
            best = value;
            moved = true;
            break;
          }
          parameter(p) = before;
        }
      }
    }
  }
  return best;
}

/// The model with other columns in group 0.
LinearModel with_ensemble(const LinearModel& m, const Matrix& ensemble) {
  const std::vector<Eigen::Index> others = columns_of_group(m, false);
  LinearModel out = m;
  out.random.resize(m.random.rows(), ensemble.cols() + static_cast<Eigen::Index>(others.size()));
  out.random << ensemble, m.random(Eigen::all, others);
  out.random_group.assign(static_cast<std::size_t>(ensemble.cols()), 0);
  for (const Eigen::Index k : others) out.random_group.push_back(m.random_group[k]);
  return out;
}

/// Z with group 0 at its scale.
Matrix scaled(const LinearModel& m, const Hyperparameters& h) {
  Matrix z = m.random;
  for (const Eigen::Index k : columns_of_group(m, true)) z.col(k) *= h.scale;
  return z;
}

}  // namespace

std::vector<Eigen::Index> columns_of_group(const LinearModel& m, bool scaled) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index k = 0; k < m.random.cols(); ++k)
    if ((m.random_group[k] == 0) == scaled) out.push_back(k);
  return out;
}

std::pair<Matrix, Vector> principal_axes(const Matrix& z) {
  // From the eigenvectors of the smaller of Z'Z and Z Z'.
  constexpr double kNegligible = 1e-6;
  if (z.cols() == 0) return {z, Vector()};
  const bool wide = z.cols() > z.rows();
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(wide ? Matrix(z * z.transpose()) : Matrix(z.transpose() * z));
  const Vector& values = solver.eigenvalues();
  Eigen::Index first = 0;
  while (first < values.size() && values(first) <= kNegligible) ++first;
  const Eigen::Index rank = values.size() - first;
  const Vector lambda = values.tail(rank);
  const Matrix vectors = solver.eigenvectors().rightCols(rank);
  Matrix axes = wide ? vectors : Matrix(z * vectors * lambda.cwiseSqrt().cwiseInverse().asDiagonal());
  for (Eigen::Index k = 0; k < rank; ++k) {
    Eigen::Index largest = 0;
    axes.col(k).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, k) < 0) axes.col(k) *= -1;
  }
  return {axes, lambda};
}

Matrix side_by_side(Eigen::Index rows, std::span<const Matrix* const> list) {
  Eigen::Index columns = 0;
  for (const Matrix* m : list) columns += m->cols();
  Matrix out(rows, columns);
  columns = 0;
  for (const Matrix* m : list) {
    out.middleCols(columns, m->cols()) = *m;
    columns += m->cols();
  }
  return out;
}

Matrix independent(const Matrix& columns) {
  // an unknown that these rows do not have is no column
  const Vector length = columns.colwise().norm().cwiseMax(1e-300);
  Eigen::ColPivHouseholderQR<Matrix> qr(columns * length.cwiseInverse().asDiagonal());
  qr.setThreshold(kDependent);
  return qr.householderQ() * Matrix::Identity(columns.rows(), qr.rank());
}

Hyperparameters estimate_uncorrelated(const LinearModel& m) {
  Hyperparameters h;
  h.noise = Vector::Ones(m.noise_groups);
  maximise(Likelihood(m, 0), h, 0.5);
  return h;
}

double log_density(const LinearModel& m, const Hyperparameters& h) {
  const Vector weight = weights(m, h);
  const auto neighbours = static_cast<double>(std::count(m.follows.begin(), m.follows.end(), 1));
  const Matrix x = whitened(independent(m.free), weight, h.correlation, m.follows);
  const Eigen::LLT<Matrix> of_free(x.transpose() * x);
  return weight.array().log().sum() - 0.5 * neighbours * std::log(1 - h.correlation * h.correlation) -
      of_free.matrixLLT().diagonal().array().log().sum();
}

Hyperparameters estimate(const LinearModel& m) {
  Hyperparameters h;
  h.noise = Vector::Ones(m.noise_groups);
  double best = maximise(Likelihood(m, 0), h, 0.5);
  const double independent = best;
  for (const double phi : kCorrelations) {
    Hyperparameters trial = h;
    trial.correlation = phi;
    const double value = maximise(Likelihood(m, phi), trial, 0.2);
    if (value < best && h.correlation > 0) break;
    if (value > std::max(best, independent + kCorrelationGain)) {
      best = value;
      h = trial;
    } else if (phi > 0.2 && h.correlation == 0) {
      break;
    }
  }
  return h;
}

std::vector<char> alone(const LinearModel& m) {
  constexpr double kNothing = 1e-6;  // of a row that X leaves
  const Matrix x = independent(m.noise_um.cwiseInverse().asDiagonal() * m.free);
  std::vector<char> out;
  for (Eigen::Index i = 0; i < x.rows(); ++i) out.push_back(1 - x.row(i).squaredNorm() < kNothing);
  return out;
}

Vector leave_one_out(const LinearModel& m, const Hyperparameters& h) {
  const Rotated rotated(m, h);
  // With the inverse covariance K of the touches, X projected out, (K y)_i / K_ii is row i minus its
  // prediction from all others, 1 / K_ii the variance.
  const Vector ky = rotated.of_touches(rotated.noise_part()), diagonal = rotated.precision_diagonal();
  Vector out(m.y.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = diagonal(i) > 1e-9 ? ky(i) / std::sqrt(diagonal(i)) : 0;
  return out;
}

Vector expected_noise(const LinearModel& m, const Hyperparameters& h) {
  const Rotated rotated(m, h);
  return rotated.recording_of(rotated.noise_part());
}

Vector beyond_prediction(LinearModel m, const Hyperparameters& h, const std::vector<char>& masked) {
  // With a noise of its own so large that it tells nothing, and has nothing to do with that of its neighbours.
  constexpr double kTellsNothing = 1e4;
  for (std::size_t i = 0; i < masked.size(); ++i) {
    if (masked[i]) m.noise_um(static_cast<Eigen::Index>(i)) *= kTellsNothing;
    if (masked[i] || (i > 0 && masked[i - 1])) m.follows[i] = 0;
  }
  Vector out = leave_one_out(m, h);
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    out(i) *= masked[row] ? m.noise_um(i) * h.noise(m.noise_group[row]) : 0;
  }
  return out;
}

Matrix precision(const LinearModel& m, const Hyperparameters& h) {
  const Vector weight = weights(m, h);
  return weight.asDiagonal() * Rotated(m, h).precision() * weight.asDiagonal();
}

Matrix squared_correlation(const LinearModel& m, const Hyperparameters& h) {
  const Matrix p = Rotated(m, h).precision();
  const Vector variance = p.diagonal().cwiseMax(1e-9);
  return (p.array().square().colwise() / variance.array()).rowwise() / variance.transpose().array();
}

LinearModel compact(const LinearModel& m) {
  constexpr double kNegligible = 1e-3;  // of the variance of one row, over all rows together
  const Vector weight = m.noise_um.cwiseInverse();
  const auto kept = [&](const Matrix& z) -> Matrix {
    if (z.cols() == 0) return z;
    const Matrix white = weight.asDiagonal() * z;
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(white.transpose() * white);
    Eigen::Index first = 0;
    while (first < z.cols() && solver.eigenvalues()(first) < kNegligible) ++first;
    return z * solver.eigenvectors().rightCols(z.cols() - first);
  };
  LinearModel out = with_ensemble(m, kept(m.random(Eigen::all, columns_of_group(m, true))));
  out.rough = kept(m.rough);
  return out;
}

LinearModel rougher(const LinearModel& m) { return with_ensemble(m, m.rough); }

LinearModel with_random(const LinearModel& m, const Matrix& columns) {
  LinearModel out = m;
  out.random.resize(m.random.rows(), m.random.cols() + columns.cols());
  out.random << m.random, columns;
  out.random_group.insert(out.random_group.end(), static_cast<std::size_t>(columns.cols()), 1);
  return out;
}

Vector beside_free(const LinearModel& m, const Vector& displacement) {
  const Vector weight = m.noise_um.cwiseInverse();
  const Matrix free = independent(weight.asDiagonal() * m.free);
  const Vector white = weight.cwiseProduct(displacement);
  return m.noise_um.cwiseProduct(white - free * (free.transpose() * white));
}

LinearModel without_rows(const LinearModel& m, const std::vector<char>& dropped) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < m.y.size(); ++i)
    if (!dropped[i]) kept.push_back(i);
  LinearModel out;
  out.y = m.y(kept);
  out.free = m.free(kept, Eigen::all);
  out.random = m.random(kept, Eigen::all);
  if (m.rough.cols() > 0) out.rough = m.rough(kept, Eigen::all);
  for (const Matrix& function : m.uneven) out.uneven.push_back(function(kept, Eigen::all));
  out.random_group = m.random_group;
  out.scale_spread = m.scale_spread;
  out.quietest = m.quietest;
  out.largest_scale = m.largest_scale;
  out.noise_um = m.noise_um(kept);
  out.noise_groups = m.noise_groups;
  Eigen::Index before = -2;
  for (const Eigen::Index i : kept) {
    out.noise_group.push_back(m.noise_group[i]);
    out.follows.push_back(m.follows[i] && before == i - 1);
    before = i;
  }
  return out;
}

Projection::Projection(const LinearModel& m, const Hyperparameters& h)
    : follows_(m.follows),
      weight_(weights(m, h)),
      correlation_(h.correlation),
      q_(independent(whitened(m.free, weight_, correlation_, follows_))) {}

Matrix Projection::operator()(const Matrix& columns) const {
  Matrix w = whitened(columns, weight_, correlation_, follows_);
  const Matrix taken = q_.transpose() * w;
  w.noalias() -= q_ * taken;
  return w;
}

Matrix Projection::of_patterns(const Matrix& columns) const {
  Matrix w = whitened(columns, weight_, correlation_, follows_);
  const Vector length = w.colwise().norm();
  const Matrix taken = q_.transpose() * w;
  w.noalias() -= q_ * taken;
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

Precision::Precision(const LinearModel& m, const Hyperparameters& h) : project_(m, h), y_(m.y) {
  const Matrix z = project_(scaled(m, h));
  Matrix square = Matrix::Identity(z.cols(), z.cols());
  square.selfadjointView<Eigen::Lower>().rankUpdate(z.transpose());
  const Eigen::LLT<Matrix> llt(square);
  reach_ = llt.matrixL().solve(z.transpose());
}

Precision::Seen Precision::seen(const Matrix& patterns) const { return with_taken(project_.of_patterns(patterns)); }

Precision::Seen Precision::y() const { return with_taken(project_(y_)); }

Precision::Seen Precision::with_taken(Matrix rows) const {
  Seen out{std::move(rows), {}};
  out.taken = reach_ * out.rows;
  return out;
}

Matrix inner(const Precision::Seen& a, const Precision::Seen& b) {
  return a.rows.transpose() * b.rows - a.taken.transpose() * b.taken;
}

Rotated::Rotated(const LinearModel& m, const Hyperparameters& h) : project_(m, h), y_(project(m.y)) {
  std::tie(basis_, lambda_) = principal_axes(project(scaled(m, h)));
  rest_dof_ = static_cast<int>(y_.size() - project_.free().cols() - rank());
}

Vector Rotated::noise_part() const {
  const Vector taken = lambda_.array() / (1 + lambda_.array());
  return remainder(y_, Vector(taken.array() * z().array()));
}

Matrix Rotated::taken_of_touches() const {
  Matrix taken(rows(), project_.free().cols() + rank());
  taken << project_.free(), basis_ * (lambda_.array() / (1 + lambda_.array())).sqrt().matrix().asDiagonal();
  return project_.of_touches(taken);
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

LinearModel with_free(const LinearModel& m, const std::vector<const Matrix*>& signatures) {
  LinearModel out = m;
  std::vector<const Matrix*> free = {&m.free};
  free.insert(free.end(), signatures.begin(), signatures.end());
  out.free = side_by_side(m.free.rows(), free);
  return out;
}

}  // namespace abbe::diagnose
