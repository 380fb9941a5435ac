// The points of one fit about their mean, and the questions asked before it: are they finite, enough, and
// spread in as many directions as the element needs?
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/features/fit.hpp"
#include "engine/features/spread.hpp"

namespace abbe {

/// Extended precision where the hardware has it: the last steps of a fit are taken in it, so that the answer
/// is the minimum for the given doubles and not for their rounded differences.
using Extended = long double;

template <class Real>
using Points = std::vector<std::array<Real, 3>>;

struct Cloud {
  Extended mean[3] = {};   ///< mm
  Points<Extended> exact;  ///< differences from the mean, mm
  Points<double> rounded;  ///< the same, rounded
  Spread<Extended> spread{};
  double largest_coordinate = 0;  ///< mm
  double extent() const { return static_cast<double>(spread.along[0]); }
  Vec3 centre() const { return {double(mean[0]), double(mean[1]), double(mean[2])}; }
  double negligible() const { return negligible_spread(largest_coordinate, extent()); }
};

/// Extremes and sum of squares of residuals, and extent along the direction.
struct CloudRanges {
  Extended low = INFINITY, high = -INFINITY, begin = INFINITY, end = -INFINITY, squares = 0;
  void add(Extended d, Extended h) {
    low = std::min(low, d), high = std::max(high, d);
    begin = std::min(begin, h), end = std::max(end, h);
    squares += d * d;
  }
  void report(FitSolution& solution, std::size_t n) const {
    solution.element.low = double(low), solution.element.high = double(high);
    solution.rms = double(std::sqrt(squares / static_cast<Extended>(n)));
    solution.form = double(high - low);
  }
};

/// Finite points only.
Cloud centred(const std::vector<Vec3>& points);

/// Spreads and principal directions of points about their mean, accurate relative to themselves: a second
/// pass runs in the frame of the first, where the products lose nothing to cancellation.
Spread<Extended> spread_of_points(const Points<Extended>& centred);

/// Why there is no element, before any fitting: what the points alone show, and what their spreads show.
std::optional<FitError> refusal(const FitProblem&);
std::optional<FitError> refusal(const FitProblem&, const Cloud&);

/// A FitError with the text that belongs to the code.
FitError fit_error(const char* code);

}  // namespace abbe
