// Sums of likelihoods that are told by their logarithms: log(e^a + e^b + ...).
#pragma once

#include <cstddef>
#include <span>

#include "engine/diagnose/model/decompositions.hpp"
#include "engine/lanes/elementary.hpp"
#include "engine/lanes/for_lanes.hpp"

namespace abbe::diagnose {

double log_sum_exp(std::span<const double>);
double log_sum_exp(const Vector&);

/// Of the columns of `rows` by `lanes` numbers, whose rows follow each other.
void log_sums_exp(int rows, int lanes, const double* logs, double* sums);

/// e to the power of a logarithm that is 0 or below.
[[gnu::always_inline]] inline double exp_of_share(double log) {
  constexpr double kNothing = -700;  // beside the 1 of the largest
  return exp_bounded(log < kNothing ? kNothing : log);
}

/// The same for a loop over lanes. `top`: room for as many as `sums`.
[[gnu::always_inline]] inline void log_sums_exp(int rows, int lanes, const double* logs, double* top, double* sums) {
  ABBE_NO_ALIAS
  for (int i = 0; i < lanes; ++i) top[i] = logs[i], sums[i] = 0;
  for (int row = 1; row < rows; ++row) {
    const double* const log = logs + std::ptrdiff_t{row} * lanes;
    ABBE_NO_ALIAS
    for (int i = 0; i < lanes; ++i) top[i] = log[i] > top[i] ? log[i] : top[i];
  }
  for (int row = 0; row < rows; ++row) {
    const double* const log = logs + std::ptrdiff_t{row} * lanes;
    ABBE_NO_ALIAS
    for (int i = 0; i < lanes; ++i) sums[i] += exp_of_share(log[i] - top[i]);
  }
  ABBE_NO_ALIAS
  for (int i = 0; i < lanes; ++i) sums[i] = top[i] + log_positive(sums[i]);
}

}  // namespace abbe::diagnose
