#include "engine/diagnose/values/value_search.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

namespace {

/// Factors on the typical size of an effect: its size is known within these orders only.
constexpr double kSizes[] = {0.3, 1, 3, 10};

}  // namespace

ValueSearch::ValueSearch(Vector mean, const Matrix& covariance, Explanations explanations, const Matrix& free)
    : explanations_(std::move(explanations)), mean_(std::move(mean)), root_(Eigen::LLT<Matrix>(covariance).matrixL()) {
  if (free.cols() > 0) free_ = independent(root_.triangularView<Eigen::Lower>().solve(free));
  for (const Block& b : explanations_.blocks) white_.push_back(whitened(b.signature));
}

Matrix ValueSearch::whitened(const Matrix& columns) const {
  const Matrix white = root_.triangularView<Eigen::Lower>().solve(columns);
  return free_.cols() > 0 ? Matrix(white - free_ * (free_.transpose() * white)) : white;
}

Vector ValueSearch::white(const Vector& deviation) const { return whitened(deviation - mean_); }

Information ValueSearch::information(int block, const Vector& deviation) const {
  const Matrix& h = white_[static_cast<std::size_t>(block)];
  return {h.transpose() * h, h.transpose() * white(deviation)};
}

Evidence ValueSearch::evidence(const Vector& deviation) const {
  const Vector w = white(deviation);
  Evidence out;
  for (const Matrix& h : white_) {
    const Matrix g = h.transpose() * h;
    const Vector u = h.transpose() * w;
    std::vector<double> sizes;
    for (const double s : kSizes) {
      const Eigen::LLT<Matrix> llt(Matrix::Identity(g.rows(), g.cols()) + s * s * g);
      const Vector v = llt.matrixL().solve(u);
      sizes.push_back(0.5 * s * s * v.squaredNorm() - llt.matrixLLT().diagonal().array().log().sum() -
                      std::log(double(std::size(kSizes))));
    }
    out.block_log_bayes.push_back(log_sum_exp(sizes));
  }
  std::vector<double> all;
  for (const Explanation& e : explanations_.list) {
    std::vector<double> variants;
    for (const int b : e.blocks)
      variants.push_back(out.block_log_bayes[static_cast<std::size_t>(b)] +
                         std::log(explanations_.blocks[static_cast<std::size_t>(b)].weight));
    out.log_bayes.push_back(log_sum_exp(variants));
    all.push_back(std::log(e.prior) + out.log_bayes.back());
  }
  out.statistic = log_sum_exp(all);
  return out;
}

ValueSearch search_without(const Vector& mean, const Matrix& covariance, const Explanations& all,
                           const std::vector<char>& dropped, std::vector<Eigen::Index>& kept) {
  kept.clear();
  for (std::size_t k = 0; k < dropped.size(); ++k)
    if (!dropped[k]) kept.push_back(static_cast<Eigen::Index>(k));
  return ValueSearch(mean(kept), covariance(kept, kept), rows_of(all, kept));
}

}  // namespace abbe::diagnose
