#include "engine/diagnose/model/restricted_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/diagnose/model/projection.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kNoisePrior = 0.5;  // of the logarithm
constexpr double kCorrelations[] = {0.15, 0.3, 0.45, 0.6, 0.75};
constexpr double kCorrelationGain = 3;  // nats that a correlation must gain to be believed

/// Moments of whitened rows by noise group, from which the likelihood at any noise and scale follows without
/// a pass over the rows.
class Likelihood {
 public:
  Likelihood(const LinearModel& m, double phi) : model_(m), phi_(phi) {
    const Vector unit = m.noise_um.cwiseInverse();
    const Matrix x = independent(m.free);
    free_ = x.cols();
    q_ = free_ + m.random.cols();
    const Matrix rows = whitened(side_by_side(x, m.random), unit, phi, m.follows),
                 y = whitened(m.y, unit, phi, m.follows);
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
    const Cholesky root(m);
    const Vector v = root.whitened(b);
    const double log_m = 2 * root.half_log_determinant();
    const auto neighbours = static_cast<double>(std::count(model_.follows.begin(), model_.follows.end(), 1));
    const double log_phi = neighbours * std::log(1 - phi_ * phi_);
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

}  // namespace

Hyperparameters estimate_uncorrelated(const LinearModel& m) {
  Hyperparameters h;
  h.noise = Vector::Ones(m.noise_groups);
  maximise(Likelihood(m, 0), h, 0.5);
  return h;
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

}  // namespace abbe::diagnose
