#include "engine/stats/summary.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/ids.hpp"
#include "engine/lanes/random.hpp"
#include "engine/math/normal.hpp"

namespace abbe {

namespace {

/// The sample in ascending order; ranks are 1-based as in JCGM 101, fractional ranks are
/// interpolated.
class Sorted {
 public:
  explicit Sorted(std::span<const double> sample) : y_(sample.begin(), sample.end()) {
    std::sort(y_.begin(), y_.end());
  }

  int n() const { return static_cast<int>(y_.size()); }
  double operator()(int rank) const { return y_[rank - 1]; }
  double at(double rank) const {
    const int below = std::min(static_cast<int>(rank), n() - 1);
    return std::lerp((*this)(below), (*this)(below + 1), rank - below);
  }
  const std::vector<double>& values() const { return y_; }

 private:
  std::vector<double> y_;
};

/// Central moments about the mean. Deviations from the median are summed, so that equal values give
/// exactly that value.
struct Moments {
  double mean = 0, second = 0, fourth = 0;
};

Moments moments(const Sorted& y) {
  const double n = y.n(), middle = y((y.n() + 1) / 2);
  double shift = 0;
  for (const double v : y.values()) shift += v - middle;
  Moments m{middle + shift / n, 0, 0};
  for (const double v : y.values()) {
    const double square = (v - m.mean) * (v - m.mean);
    m.second += square / n;
    m.fourth += square * square / n;
  }
  return m;
}

/// Ranks r and r + q of the probabilistically symmetric interval (JCGM 101, 7.7.1).
struct Ranks {
  int first = 1, width = 1;
};

Ranks symmetric_ranks(int n, double coverage) {
  const int q = std::min(static_cast<int>(coverage * n + 0.5), n - 1);
  return {(n - q + 1) / 2, q};
}

/// JCGM 101, 7.7.2: the smallest y(r + q) - y(r) over r = 1 ... n - q.
int shortest_first(const Sorted& y, Ranks symmetric) {
  const int q = symmetric.width;
  const auto width = [&](int r) { return y(r + q) - y(r); };
  int best = symmetric.first;
  for (int r = 1; r <= y.n() - q; ++r) {
    const bool tie = width(r) == width(best);
    const bool nearer = std::abs(r - symmetric.first) < std::abs(best - symmetric.first);
    if (width(r) < width(best) || (tie && nearer)) best = r;
  }
  return best;
}

/// The standard error of the quantile that `rank` estimates, of values with standard deviation u. Where it is one of the
/// outermost values, how far the next would lie is not seen: it is then no less than that of a normal law.
double quantile_error(const Sorted& y, int rank, double u) {
  const double n = y.n(), p = (rank - 0.5) / n;
  const double rank_error = std::sqrt(n * p * (1 - p));
  const double below = rank - kNormal95 * rank_error, above = rank + kNormal95 * rank_error;
  const double low = std::max(1.0, below), high = std::min(n, above);
  const double seen = rank_error * (y.at(high) - y.at(low)) / (high - low);
  if (below >= 1 && above <= n) return seen;
  const double step = p * (1 - p) / 100;
  const double slope = (normal_quantile(p + step) - normal_quantile(p - step)) / (2 * step);
  return std::max(seen, u * slope * rank_error / n);
}

}  // namespace

Summary summarize(std::span<const double> sample, double coverage) {
  ABBE_CHECK(sample.size() >= 2 && coverage > 0 && coverage < 1);
  const Sorted y(sample);
  const double n = y.n();
  const Moments m = moments(y);
  const double variance = m.second * n / (n - 1);
  const Ranks ranks = symmetric_ranks(y.n(), coverage);
  const int low = ranks.first, high = low + ranks.width;
  const int shortest = shortest_first(y, ranks);

  Summary s;
  s.n = y.n();
  s.mean = m.mean;
  s.u = std::sqrt(variance);
  s.symmetric = {y(low), y(high)};
  s.shortest = {y(shortest), y(shortest + ranks.width)};
  s.mean_error = s.u / std::sqrt(n);
  // A few values say next to nothing of their fourth moment: it counts as that of a normal law, by as much as ten of them.
  constexpr double kNormal = 3, kAsMuchAs = 10;
  const double fourth = (n * m.fourth + kAsMuchAs * kNormal * variance * variance) / (n + kAsMuchAs);
  const double variance_of_variance = std::max(0.0, fourth - variance * variance * (n - 3) / (n - 1)) / n;
  s.u_error = s.u > 0 ? std::sqrt(variance_of_variance) / (2 * s.u) : 0;
  s.low_error = quantile_error(y, low, s.u);
  s.high_error = quantile_error(y, high, s.u);
  return s;
}

double conformance_probability(const JudgedSample& sample, std::optional<double> lower, std::optional<double> upper) {
  ABBE_CHECK(sample.size() > 0 && sample.by_upper.size() == sample.size());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < sample.size(); ++i)
    if ((!lower || sample.by_lower[i] >= *lower) && (!upper || sample.by_upper[i] <= *upper)) ++inside;
  return static_cast<double>(inside) / static_cast<double>(sample.size());
}

double numerical_tolerance(double u, int digits) {
  if (!(u > 0)) return 0;
  int l = static_cast<int>(std::floor(std::log10(u))) - digits + 1;
  if (std::round(u / std::pow(10.0, l)) >= std::pow(10.0, digits)) ++l;  // 0.0996 to two digits is 10 * 10^-2
  return 0.5 * std::pow(10.0, l);
}

void AdaptiveTrials::add(const Summary& block) {
  const double figures[4] = {block.mean, block.u, block.symmetric.low, block.symmetric.high};
  ++n_;
  for (int i = 0; i < 4; ++i) {
    const double before = figures[i] - mean_[i];
    mean_[i] += before / n_;
    squares_[i] += before * (figures[i] - mean_[i]);
  }
  mean_variance_ += (block.u * block.u - mean_variance_) / n_;
}

bool AdaptiveTrials::stable() const {
  if (n_ < 2) return false;
  const double u_of_all = std::sqrt(mean_variance_ + squares_[0] / n_);
  const double tolerance = numerical_tolerance(u_of_all, digits_);
  return std::all_of(squares_, squares_ + 4, [&](double squares) {
    return 2 * std::sqrt(squares / (static_cast<double>(n_) * (n_ - 1))) <= tolerance;
  });
}

}  // namespace abbe
