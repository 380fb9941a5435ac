#include "engine/diagnose/model/ensemble.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/products.hpp"
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

/// Adds recordings, a column each or one for all, so many times.
void add_recordings(const auto& added, const Vector& times, auto&& to) {
  for (Eigen::Index r = 0; r < to.cols(); ++r) to.col(r) += times(r) * added.col(added.cols() == 1 ? 0 : r);
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

Ensemble::Ensemble(const LinearModel& model, const Hyperparameters& h, double log_prior, const Ensemble& other)
    : Ensemble(model, h, log_prior) {
  projected_ = other.projected_;
}

void Ensemble::prepare(const std::vector<Matrix>& uneven) {
  functions_ = uneven.size();
  prepare(pointers_to(uneven), {});
}

void Ensemble::add(std::span<const Variant> variants) {
  std::vector<const Matrix*> list;
  for (const Variant& b : variants) list.push_back(&b.signature);
  prepare(list, variants);
}

void Ensemble::keep(std::size_t count) {
  variants_.erase(variants_.begin() + static_cast<std::ptrdiff_t>(functions_ + count), variants_.end());
  const Eigen::Index columns = variants_.empty() ? 0 : variants_.back().first + variants_.back().count;
  coordinates_.conservativeResize(Eigen::NoChange, columns);
  projected_->conservativeResize(Eigen::NoChange, columns);
}

void Ensemble::project(std::span<const Matrix* const> signatures) {
  Eigen::Index first = projected_->cols(), columns = first;
  for (const Matrix* m : signatures) columns += m->cols();
  projected_->conservativeResize(basis_.rows(), columns);
  for (std::size_t begin = 0, end = 0; begin < signatures.size(); begin = end) {
    end += portion(signatures.subspan(begin));
    const Matrix together =
        basis_.project_patterns(side_by_side(basis_.rows(), signatures.subspan(begin, end - begin)));
    projected_->middleCols(first, together.cols()) = together;
    first += together.cols();
  }
}

void Ensemble::prepare(const std::vector<const Matrix*>& signatures, std::span<const Variant> variants) {
  Eigen::Index first = coordinates_.cols();
  if (projected_->cols() == first) project(signatures);  // or an ensemble that shares them has done so
  coordinates_.conservativeResize(basis_.rank(), projected_->cols());
  for (Eigen::Index begin = first, count = 0; begin < coordinates_.cols(); begin += count) {
    count = std::min(kPortion, coordinates_.cols() - begin);
    coordinates_.middleCols(begin, count) = basis_.coordinates(projected_->middleCols(begin, count));
  }
  for (std::size_t k = 0; k < signatures.size(); ++k) {
    variants_.push_back(prepared(first, signatures[k]->cols(), variants.empty() ? nullptr : &variants[k]));
    first += signatures[k]->cols();
  }
}

PreparedVariant Ensemble::prepared(Eigen::Index first, Eigen::Index count, const Variant* variant) const {
  const Eigen::Index scales = precision_.cols();
  const Matrix a = coordinates_.middleCols(first, count), h = projected_->middleCols(first, count);
  const Matrix outside = transposed_product(h, h) - transposed_product(a, a);
  const double information = (precision(1.0).transpose() * a.cwiseAbs2()).sum() + outside.trace();
  const bool own_sizes = variant && variant->sizes.empty(),
             tells_nothing = own_sizes && information * kWidest * kWidest < 1;
  Matrix weighted(a.rows(), count * scales);
  for (Eigen::Index j = 0; j < scales; ++j) weighted.middleCols(j * count, count) = precision_.col(j).asDiagonal() * a;
  const Matrix within = transposed_product(a, weighted);
  PreparedVariant b(first, count, !variant ? kLarger : own_sizes ? sizes_of(information) : variant->sizes, scales);
  for (Eigen::Index j = 0; j < scales; ++j)
    b.set(j, within.middleCols(j * count, count) + outside,
          tells_nothing ? 0
              : variant ? 1
                        : scales_[static_cast<std::size_t>(j)]);
  return b;
}

Ensemble::Seen Ensemble::seen(const Matrix& recordings) const {
  Seen out;
  const Matrix y = basis_.project(recordings);
  out.z = basis_.coordinates(y), out.rest = basis_.remainder(y, out.z);
  const Eigen::Index scales = precision_.cols(), count = out.z.cols();
  Matrix weighted(out.z.rows(), count * scales);
  for (Eigen::Index j = 0; j < scales; ++j)
    weighted.middleCols(j * count, count) = precision_.col(j).asDiagonal() * out.z;
  out.u = transposed_product(weighted, coordinates_);
  const Matrix beside = transposed_product(out.rest, *projected_);
  for (Eigen::Index j = 0; j < scales; ++j) out.u.middleRows(j * count, count) += beside;
  return out;
}

MarginalLikelihood Ensemble::likelihood(const Matrix& z, const Matrix& rest) const {
  const Matrix within = transposed_product(z.cwiseAbs2(), precision_);
  // Row by row: along a column, the order of a sum would depend on where it stands in memory.
  Vector beside = Vector::Constant(rest.cols(), 2 * kPriorSquares);
  for (Eigen::Index k = 0; k < rest.rows(); ++k) beside += rest.row(k).cwiseAbs2();
  return {within.colwise() + beside, log_scale_, shape_};
}

std::pair<Matrix, Matrix> Ensemble::added_up(const Sum& y) {
  std::pair<Matrix, Matrix> out{y.of.z, y.of.rest};
  if (y.added) add_recordings(y.added->z, y.times, out.first), add_recordings(y.added->rest, y.times, out.second);
  return out;
}

Ensemble::LogLikelihoods Ensemble::judge(const Sum& y, const std::vector<int>& variants) const {
  const Eigen::Index recordings = y.of.recordings(), scales = precision_.cols();
  const auto asked = functions_ + variants.size();
  const auto [z, rest] = added_up(y);
  MarginalLikelihood likelihood = this->likelihood(z, rest);
  LogLikelihoods out{likelihood.alone(), Matrix(recordings, static_cast<Eigen::Index>(asked))};
  Matrix sums;
  WithData u;
  for (std::size_t k = 0; k < asked; ++k) {
    const PreparedVariant& b = k < functions_ ? variants_[k] : of(variants[k - functions_]);
    if (y.added) {
      sums = y.of.u.middleCols(b.first, b.count);
      const Eigen::Index each = y.added->recordings();
      for (Eigen::Index j = 0; j < scales; ++j)
        add_recordings(y.added->u.block(j * each, b.first, each, b.count).transpose(), y.times,
                       sums.middleRows(j * recordings, recordings).transpose());
    }
    u.clear();
    for (Eigen::Index i = 0; i < b.count; ++i)
      u.push_back(y.added ? sums.col(i).data() : y.of.u.col(b.first + i).data());
    likelihood.with(b, u, out.with.col(static_cast<Eigen::Index>(k)).data());
  }
  return out;
}

ByScale Ensemble::alone(const Seen& y) const { return likelihood(y.z, y.rest).alone_by_scale(); }

ByScale Ensemble::with(const Seen& y, const PreparedVariant& b) const {
  WithData u;
  for (Eigen::Index i = 0; i < b.count; ++i) u.push_back(y.u.col(b.first + i).data());
  return likelihood(y.z, y.rest).with_by_scale(b, u);
}

Level Ensemble::level(const ByScale& at) const {
  const double total = log_sum_exp(at.log_likelihood);
  Level l{0, 0};
  double log_g = 0;
  for (std::size_t j = 0; j < scales_.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const double p = std::exp(at.log_likelihood(row) - total);
    log_g += p * std::log(scales_[j]);
    l.s2 += p * at.squares(row) / (2 * shape_);
  }
  l.g2 = l.s2 * std::exp(2 * log_g);
  return l;
}

Vector Ensemble::log_scales(const Sum& y) const {
  const auto [z, rest] = added_up(y);
  Vector out(z.cols());
  for (Eigen::Index r = 0; r < out.size(); ++r) {
    const Level l = level(likelihood(z.col(r), rest.col(r)).alone_by_scale());
    out(r) = 0.5 * std::log(l.g2 / l.s2);
  }
  return out;
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
  const PreparedVariant &i = of(a), &j = of(b);
  return coordinates_.middleCols(i.first, i.count).transpose() * beside_noise(level).asDiagonal() *
      coordinates_.middleCols(j.first, j.count) +
      projected_->middleCols(i.first, i.count).transpose() * projected_->middleCols(j.first, j.count) / level.s2;
}

Vector Ensemble::with_data(const Level& level, int variant, const Vector& recording) const {
  const PreparedVariant& b = of(variant);
  const Vector y = basis_.project(recording), z = basis_.coordinates(y), rest = basis_.remainder(y, z);
  return coordinates_.middleCols(b.first, b.count).transpose() * Vector(precision(level).array() * z.array()) +
      projected_->middleCols(b.first, b.count).transpose() * rest / level.s2;
}

Matrix Ensemble::against_all(const Level& level, const std::vector<Eigen::Index>& columns) const {
  const Matrix weighted = beside_noise(level).asDiagonal() * Matrix(coordinates_(Eigen::all, columns));
  return (transposed_product(weighted, coordinates_) +
          transposed_product(Matrix((*projected_)(Eigen::all, columns)), *projected_) / level.s2)
      .transpose();
}

}  // namespace abbe::diagnose
