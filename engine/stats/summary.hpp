// What JCGM 101:2008 ("propagation of distributions using a Monte Carlo method") asks to report of
// a sample, and the conformance probability of JCGM 106:2012.
//
// Everything is a function of the *set* of values: the sample is sorted first, so that the order in
// which machines finish cannot change the last bit. Coverage intervals go by ranks of the sorted
// sample and assume no distribution.
//
// The figures carry their own Monte Carlo errors (standard errors, from this sample alone):
//   mean    u / sqrt(n)
//   u       sqrt((m4 - u^4 (n-3)/(n-1)) / n) / (2u), m4 the fourth central moment: exact variance
//           of u^2, then first order
//   limits  the number of values below a p-quantile is binomial, so its rank is uncertain by
//           sqrt(n p (1-p)); times the local distance between neighbouring values (over the ranks
//           of a 95 % band)
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace abbe {

struct Interval {
  double low = 0, high = 0;
};

struct Summary {
  int n = 0;
  double mean = 0, u = 0;  ///< average and standard deviation (n - 1), JCGM 101 7.6
  Interval symmetric;      ///< probabilistically symmetric 95 % coverage interval, 7.7.1
  Interval shortest;       ///< shortest 95 % coverage interval, 7.7.2
  /// Standard errors of the figures above; `low` and `high` of the symmetric interval.
  double mean_error = 0, u_error = 0, low_error = 0, high_error = 0;
};

/// `sample` needs at least 2 values; the order does not matter. `coverage` in (0, 1). When the
/// sample is too small for the coverage (10 values or fewer at 95 %) the intervals run from the
/// smallest to the largest value. Of several shortest intervals the one nearest to the symmetric
/// interval is taken.
Summary summarize(std::span<const double> sample, double coverage = 0.95);

/// A sample as each of two limits judges it: twice the same, but where a limit errs as well. What it errs has then been
/// taken away from the value, and both are judged together.
struct JudgedSample {
  std::span<const double> by_lower, by_upper;  ///< as many, in the same order

  JudgedSample(const std::vector<double>& sample) : by_lower(sample), by_upper(sample) {}  // NOLINT: any sample is one
  JudgedSample(const std::vector<double>& lower, const std::vector<double>& upper) : by_lower(lower), by_upper(upper) {}
  std::size_t size() const { return by_lower.size(); }
};

/// Share of the sample inside the limits, limits included (JCGM 106, no normality assumed). A
/// missing limit does not bound. `sample` must not be empty.
double conformance_probability(const JudgedSample& sample, std::optional<double> lower, std::optional<double> upper);

/// JCGM 101 7.9.2: u written as c * 10^l with an integer c of `digits` digits has the tolerance
/// 10^l / 2. 0 when u is 0.
double numerical_tolerance(double u, int digits);

/// JCGM 101 7.9.4: collects blocks of trials, all of the same size, and says when every figure is
/// stable.
class AdaptiveTrials {
 public:
  explicit AdaptiveTrials(int digits) : digits_(digits) {}
  /// Adds the summary of one block of trials.
  void add(const Summary& block);
  /// Twice the standard error of the averages of mean, u, low and high does not exceed the
  /// numerical tolerance of the u of all blocks together. False with fewer than two blocks.
  bool stable() const;
  int blocks() const { return n_; }

 private:
  int digits_, n_ = 0;
  double mean_[4] = {};       ///< averages over the blocks of mean, u, low, high
  double squares_[4] = {};    ///< sums of squared deviations from them (updated as by Welford)
  double mean_variance_ = 0;  ///< average of u^2
};

}  // namespace abbe
