#include "engine/diagnose/model/ensemble.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/evidence.hpp"
#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

namespace {

/// Inverse gamma prior of the common factor on all variances: its inverse has mean 1, as spread as a factor
/// of 1.5 either way on the noise.
constexpr double kPriorShape = 2, kPriorSquares = 2;
/// Sizes above what is typical lose belief as a normal in the logarithm of this spread.
constexpr double kLogImplausible = 1.6;

/// Evenly in their logarithm: from the stated to the estimated scale, and a little beyond both. No machine
/// that passed its acceptance test has errors many times those of its specification: whatever asks for them
/// is a mismatch.
std::vector<double> scales_between(double estimated, double largest) {
  constexpr int kCount = 7;
  constexpr double kBeyond = 1.25;
  const double low = std::min(1.0, estimated) / kBeyond, high = std::min(largest, std::max(1.0, estimated) * kBeyond);
  std::vector<double> out;
  for (int k = 0; k < kCount; ++k) out.push_back(low * std::pow(high / low, double(k) / (kCount - 1)));
  return out;
}

/// a' b, by stretches of the columns of a: a product copies what it multiplies, and what is larger than 32 MB the C library
/// asks of the system each time, and gives back.
Matrix transposed_times(const Matrix& a, const Matrix& b) {
  constexpr Eigen::Index kTogether = 1024;
  Matrix out(a.cols(), b.cols());
  for (Eigen::Index first = 0; first < a.cols(); first += kTogether) {
    const Eigen::Index count = std::min(kTogether, a.cols() - first);
    out.middleRows(first, count).noalias() = a.middleCols(first, count).transpose() * b;
  }
  return out;
}

/// What one error function may have more than its share: as much again, or twice.
const std::vector<Size> kLarger = {{1, std::log(0.5)}, {2, std::log(0.5)}};

}  // namespace

std::vector<Size> sizes_of(double information) {
  std::vector<Size> out;
  for (const double ratio : kRatios) {
    const double factor = ratio / std::sqrt(std::max(information, 1e-12));
    out.push_back(
        {factor,
         -std::log(double(std::size(kRatios))) - 0.5 * std::pow(std::max(0.0, std::log(factor)) / kLogImplausible, 2)});
  }
  return out;
}

Ensemble::Ensemble(const LinearModel& model, const Hyperparameters& h, double log_prior)
    : basis_(model, h), scales_(scales_between(h.scale, model.largest_scale)) {
  shape_ = kPriorShape + 0.5 * double(basis_.rank() + basis_.rest_dof());
  precision_.resize(basis_.rank(), static_cast<Eigen::Index>(scales_.size()));
  log_scale_.resize(precision_.cols());
  std::vector<double> prior;
  for (const double g : scales_) prior.push_back(-0.5 * std::pow(std::log(g) / model.scale_spread, 2));
  for (std::size_t j = 0; j < prior.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    precision_.col(column) = precision(scales_[j]);
    log_scale_(column) = log_prior + basis_.log_density() + prior[j] - log_sum_exp(prior) +
        0.5 * precision_.col(column).array().log().sum();
  }
}

void Ensemble::prepare(const std::vector<Matrix>& uneven) {
  std::vector<const Matrix*> list;
  for (const Matrix& function : uneven) list.push_back(&function);
  functions_ = uneven.size();
  prepare(list, nullptr);
}

void Ensemble::add(const std::vector<Variant>& variants) {
  std::vector<const Matrix*> list;
  for (const Variant& b : variants) list.push_back(&b.signature);
  prepare(list, &variants);
}

void Ensemble::keep(std::size_t count) {
  variants_.erase(variants_.begin() + static_cast<std::ptrdiff_t>(functions_ + count), variants_.end());
  const Eigen::Index columns = variants_.empty() ? 0 : variants_.back().first + variants_.back().count;
  coordinates_.conservativeResize(Eigen::NoChange, columns);
  projected_.conservativeResize(Eigen::NoChange, columns);
}

void Ensemble::prepare(const std::vector<const Matrix*>& signatures, const std::vector<Variant>* variants) {
  // Many columns at once: the basis is read from memory once for all of them.
  constexpr Eigen::Index kTogether = 512;
  Eigen::Index first = coordinates_.cols(), columns = first;
  for (const Matrix* m : signatures) columns += m->cols();
  coordinates_.conservativeResize(basis_.rank(), columns);
  projected_.conservativeResize(basis_.rows(), columns);
  for (std::size_t begin = 0, end = 0; begin < signatures.size(); begin = end) {
    Eigen::Index count = 0;
    while (end < signatures.size() && count < kTogether) count += signatures[end++]->cols();
    const Matrix together =
        basis_.project_patterns(side_by_side(basis_.rows(), std::span(signatures).subspan(begin, end - begin)));
    coordinates_.middleCols(first, count) = basis_.coordinates(together);
    projected_.middleCols(first, count) = together;
    for (std::size_t k = begin; k < end; ++k) {
      variants_.push_back(prepared(first, signatures[k]->cols(), variants ? &(*variants)[k] : nullptr));
      first += signatures[k]->cols();
    }
  }
}

Ensemble::Prepared Ensemble::prepared(Eigen::Index first, Eigen::Index count, const Variant* variant) const {
  Prepared b;
  b.first = first;
  b.count = count;
  const auto a = coordinates_.middleCols(first, count), h = projected_.middleCols(first, count);
  const Matrix outside = h.transpose() * h - a.transpose() * a;
  const double information = (a.transpose() * precision(1.0).asDiagonal() * a).trace() + outside.trace();
  const bool own_sizes = variant && variant->sizes.empty(),
             tells_nothing = own_sizes && information * kWidest * kWidest < 1;
  b.sizes = !variant ? kLarger : own_sizes ? sizes_of(information) : variant->sizes;
  const auto sizes = static_cast<Eigen::Index>(b.sizes.size());
  b.axes.resize(count, count * precision_.cols());
  b.share.resize(sizes, count * precision_.cols());
  b.log_weight.resize(sizes, precision_.cols());
  for (Eigen::Index j = 0; j < precision_.cols(); ++j) {
    Matrix g = a.transpose() * precision_.col(j).asDiagonal() * a + outside;
    if (tells_nothing) g.setZero();
    const Spectrum of_g = spectrum(g);
    const Vector d = of_g.values.cwiseMax(0);
    b.axes.middleCols(j * count, count) = of_g.vectors.transpose();
    for (Eigen::Index s = 0; s < sizes; ++s) {
      const auto& [factor, log_prior] = b.sizes[s];
      const double size = variant ? factor : factor * scales_[j], s2 = size * size;
      b.share.block(s, j * count, 1, count) = ((tells_nothing ? 0 : s2) / (1 + s2 * d.array())).transpose();
      b.log_weight(s, j) = log_prior - 0.5 * (1 + s2 * d.array()).log().sum();
    }
  }
  return b;
}

std::vector<Ensemble::Seen> Ensemble::seen(const Matrix& recordings) const {
  const Matrix y = basis_.project(recordings), z = basis_.coordinates(y), rest = basis_.remainder(y, z);
  const Eigen::Index scales = precision_.cols();
  Matrix weighted(z.rows(), z.cols() * scales);
  for (Eigen::Index r = 0; r < z.cols(); ++r)
    weighted.middleCols(r * scales, scales) = z.col(r).asDiagonal() * precision_;
  const Matrix within = transposed_times(coordinates_, weighted), beside = transposed_times(projected_, rest);
  std::vector<Seen> out;
  for (Eigen::Index r = 0; r < z.cols(); ++r)
    out.push_back({z.col(r), rest.col(r), within.middleCols(r * scales, scales).colwise() + beside.col(r)});
  return out;
}

Ensemble::Verdicts Ensemble::judge(const Sum& y, const std::vector<int>& variants) const {
  const Eigen::Index scales = precision_.cols(), asked = static_cast<Eigen::Index>(functions_ + variants.size());
  Verdicts out{{}, Matrix(scales, asked), {}, Matrix(scales, asked), Matrix(scales, asked)};
  Vector z = y.of.z, rest = y.of.rest;
  if (y.added) z += y.times * y.added->z, rest += y.times * y.added->rest;
  out.squares = ((z.asDiagonal() * precision_).transpose() * z).array() + (rest.squaredNorm() + 2 * kPriorSquares);
  out.alone = log_scale_.array() - shape_ * out.squares.array().log();
  // Most of a diagnosis is spent here: loops without a sum that waits for itself, and no memory asked for.
  Eigen::ArrayXXd left, logs;
  std::vector<double> along;
  const auto judge = [&](const Prepared& b, Eigen::Index column) {
    const Eigen::Index sizes = b.log_weight.rows();
    left.resize(sizes, scales);
    for (Eigen::Index j = 0; j < scales; ++j) {
      const double *const axes = b.axes.data() + j * b.count * b.count,
                          *const share = b.share.data() + j * b.count * sizes;
      const double *const of = y.of.u.col(j).data() + b.first,
                          *const added = y.added ? y.added->u.col(j).data() + b.first : nullptr;
      along.assign(static_cast<std::size_t>(b.count), 0.0);
      for (Eigen::Index k = 0; k < b.count; ++k) {
        const double* const e = axes + k * b.count;
        const double u = added ? of[k] + y.times * added[k] : of[k];
        for (Eigen::Index i = 0; i < b.count; ++i) along[i] += e[i] * u;
      }
      double* const left_by_size = left.col(j).data();
      std::fill_n(left_by_size, sizes, out.squares(j));
      for (Eigen::Index i = 0; i < b.count; ++i) {
        const double square = along[i] * along[i];
        for (Eigen::Index s = 0; s < sizes; ++s) left_by_size[s] -= share[i * sizes + s] * square;
      }
    }
    logs = b.log_weight.array() - shape_ * left.log();
    for (Eigen::Index j = 0; j < scales; ++j) {
      Eigen::Index best = 0;
      out.with(j, column) = logs.col(j).maxCoeff(&best);
      out.squares_with(j, column) = left(best, j);
      out.size_with(j, column) = b.sizes[static_cast<std::size_t>(best)].factor;
      for (Eigen::Index s = 0; s < sizes; ++s) logs(s, j) -= out.with(j, column);
    }
    logs = logs.exp();
    out.with.col(column).array() += log_scale_.array() + logs.colwise().sum().transpose().log();
  };
  for (Eigen::Index k = 0; k < asked; ++k) {
    const auto at = static_cast<std::size_t>(k);
    judge(at < functions_ ? variants_[at] : of(variants[at - functions_]), k);
  }
  return out;
}

Level Ensemble::level(const Vector& log_belief, const Vector& squares) const {
  const double total = log_sum_exp(log_belief);
  Level l{0, 0};
  double log_g = 0;
  for (std::size_t j = 0; j < scales_.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const double p = std::exp(log_belief(row) - total);
    log_g += p * std::log(scales_[j]);
    l.s2 += p * squares(row) / (2 * shape_);
  }
  l.g2 = l.s2 * std::exp(2 * log_g);
  return l;
}

Vector Ensemble::simulated(const Level& level, const NoiseLaw& law, std::uint64_t seed, int replicate) const {
  constexpr std::uint32_t machines = stream_of("diagnose.bootstrap"), kept = stream_of("diagnose.kept"),
                          touches = stream_of("diagnose.noise");
  const Vector u = standard_normal(basis_.rank(), seed, machines, replicate);
  const Vector z = (level.g2 * basis_.lambda().array()).sqrt() * u.array();
  return basis_.recording(z, std::sqrt(level.s2) * standard_normal(basis_.kept_count(), seed, kept, replicate),
                          std::sqrt(level.s2) * law.simulated(basis_.rows(), seed, touches, replicate));
}

Vector Ensemble::precision(double g) const { return (g * g * basis_.lambda().array() + 1).inverse(); }

Vector Ensemble::precision(const Level& l) const { return (l.g2 * basis_.lambda().array() + l.s2).inverse(); }

Vector Ensemble::beside_noise(const Level& l) const { return precision(l).array() - 1 / l.s2; }

Matrix Ensemble::between(const Level& level, int a, int b) const {
  const Prepared &i = of(a), &j = of(b);
  return coordinates_.middleCols(i.first, i.count).transpose() * beside_noise(level).asDiagonal() *
      coordinates_.middleCols(j.first, j.count) +
      projected_.middleCols(i.first, i.count).transpose() * projected_.middleCols(j.first, j.count) / level.s2;
}

Vector Ensemble::with_data(const Level& level, int variant, const Vector& recording) const {
  const Prepared& b = of(variant);
  const Vector y = basis_.project(recording), z = basis_.coordinates(y), rest = basis_.remainder(y, z);
  return coordinates_.middleCols(b.first, b.count).transpose() * Vector(precision(level).array() * z.array()) +
      projected_.middleCols(b.first, b.count).transpose() * rest / level.s2;
}

Matrix Ensemble::against_all(const Level& level, const std::vector<Eigen::Index>& columns) const {
  const Matrix weighted = beside_noise(level).asDiagonal() * Matrix(coordinates_(Eigen::all, columns));
  return transposed_times(coordinates_, weighted) +
      transposed_times(projected_, Matrix(projected_(Eigen::all, columns))) / level.s2;
}

}  // namespace abbe::diagnose
