#include "engine/diagnose/values/value_search.hpp"

#include <cmath>

#include "engine/diagnose/model/log_sums.hpp"

namespace abbe::diagnose {

namespace {

/// Factors on the typical size of an effect: its size is known within these orders only.
constexpr double kSizes[] = {0.3, 1, 3, 10};

}  // namespace

ValueSearch::ValueSearch(Vector mean, const Matrix& covariance, Explanations explanations, const Matrix& free)
    : explanations_(std::move(explanations)),
      log_weight_(log_weights(explanations_.variants)),
      mean_(std::move(mean)),
      covariance_(covariance),
      root_(covariance) {
  if (free.cols() > 0) free_ = independent(root_.whitened(free));
  for (const Variant& b : explanations_.variants) told_.push_back(told_of(whitened(b.signature)));
}

ValueSearch::Told ValueSearch::told_of(Matrix white) {
  Told out{std::move(white), {}, {}, {}};
  out.g = out.white.transpose() * out.white;
  for (const double s : kSizes) {
    out.by.emplace_back(s * s * out.g, 1);
    out.half_log_of_size.push_back(out.by.back().half_log_determinant());
  }
  return out;
}

void ValueSearch::linearise(int variant, NearSizes near) {
  const auto b = static_cast<std::size_t>(variant);
  const Cholesky root(near.covariance);
  explanations_.variants[b].signature = near.slopes;
  told_[b] = told_of(root.whitened(near.slopes));
  near_.insert_or_assign(variant, Near{std::move(near), root});
}

std::pair<Vector, double> ValueSearch::from_offset(int variant, const Vector& deviation, const Vector& white) const {
  const auto near = near_.find(variant);
  if (near == near_.end()) return {white, 0};
  const Cholesky& root = near->second.root;
  const Vector w = root.whitened(Vector(deviation - mean_ - near->second.of.offset));
  return {w,
          0.5 * (white.squaredNorm() - w.squaredNorm()) + root_.half_log_determinant() - root.half_log_determinant()};
}

Vector ValueSearch::predicted(int variant, const Vector& sizes) const {
  const Vector linear = explanations_.variants[variant].signature * sizes;
  const auto near = near_.find(variant);
  return near == near_.end() ? linear : Vector(linear + near->second.of.offset);
}

Matrix ValueSearch::whitened(const Matrix& columns) const {
  const Matrix white = root_.whitened(columns);
  return free_.cols() > 0 ? Matrix(white - free_ * (free_.transpose() * white)) : white;
}

Vector ValueSearch::white(const Vector& deviation) const { return whitened(deviation - mean_); }

Matrix ValueSearch::between(int a, int b) const {
  return a == b ? told_[a].g : Matrix(told_[a].white.transpose() * told_[b].white);
}

Information ValueSearch::information(int variant, const Vector& deviation) const {
  const Told& told = told_[variant];
  return {told.g, told.white.transpose() * from_offset(variant, deviation, white(deviation)).first};
}

Evidence ValueSearch::evidence(const Vector& deviation) const {
  const Vector white_deviation = white(deviation);
  Evidence out;
  for (std::size_t b = 0; b < told_.size(); ++b) {
    const auto [w, log_offset] = from_offset(static_cast<int>(b), deviation, white_deviation);
    const Vector u = told_[b].white.transpose() * w;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < std::size(kSizes); ++i) {
      const double s = kSizes[i];
      const Vector v = told_[b].by[i].whitened(u);
      sizes.push_back(0.5 * s * s * v.squaredNorm() - told_[b].half_log_of_size[i] -
                      std::log(double(std::size(kSizes))));
    }
    out.variant_log_bayes.push_back(log_sum_exp(sizes) + log_offset);
  }
  average_variants(explanations_.list, log_weight_, out);
  return out;
}

ValueSearch ValueSearch::rest(int explanation, const std::vector<char>& dropped,
                              std::vector<Eigen::Index>& kept) const {
  kept.clear();
  for (std::size_t k = 0; k < dropped.size(); ++k)
    if (!dropped[k]) kept.push_back(static_cast<Eigen::Index>(k));
  ValueSearch out(mean_(kept), covariance_(kept, kept), rows_of(only(explanations_, {explanation}), kept));
  const std::vector<int>& variants = explanations_.list[explanation].variants;
  for (std::size_t b = 0; b < variants.size(); ++b)
    if (const auto near = near_.find(variants[b]); near != near_.end()) {
      const NearSizes& all = near->second.of;
      out.linearise(static_cast<int>(b), {all.slopes(kept, Eigen::all), all.offset(kept), all.covariance(kept, kept)});
    }
  return out;
}

std::vector<double> statistics_of(const ValueSearch& search, const Matrix& machines) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < machines.rows(); ++i)
    out.push_back(search.evidence(machines.row(i).transpose()).statistic);
  return out;
}

}  // namespace abbe::diagnose
