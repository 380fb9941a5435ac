// What JCGM 101:2008 asks to report of a Monte Carlo sample, and JCGM 106:2012 conformance.
#pragma once

#include <optional>
#include <span>

namespace abbe {

struct Interval {
  double low = 0, high = 0;
};

struct Summary {
  int n = 0;
  double mean = 0, u = 0;          ///< average and standard deviation (n - 1), JCGM 101 7.6
  Interval symmetric;              ///< probabilistically symmetric 95 % coverage interval, 7.7.1
  Interval shortest;               ///< shortest 95 % coverage interval, 7.7.2
  /// Standard errors of the figures above, from this sample alone.
  double mean_error = 0, u_error = 0, low_error = 0, high_error = 0;
};

/// `sample` needs at least 2 values; the order does not matter. `coverage` in (0, 1).
Summary summarize(std::span<const double> sample, double coverage = 0.95);

/// Share of the sample inside the limits (JCGM 106, no normality assumed). A missing limit does not bound.
double conformance_probability(std::span<const double> sample, std::optional<double> lower, std::optional<double> upper);

/// JCGM 101 7.9.2: the numerical tolerance of u when `digits` significant digits are meaningful.
double numerical_tolerance(double u, int digits);

/// JCGM 101 7.9.4: collects blocks of trials and says when every figure is stable.
class AdaptiveTrials {
 public:
  explicit AdaptiveTrials(int digits) : digits_(digits) {}
  /// Adds the summary of one block of trials.
  void add(const Summary& block);
  /// Twice the standard error of the averages of mean, u, low and high does not exceed the numerical tolerance.
  bool stable() const;
  int blocks() const { return n_; }

 private:
  int digits_, n_ = 0;
  double sum_[4] = {}, sum_sq_[4] = {};
};

}  // namespace abbe
