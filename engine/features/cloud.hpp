// The points of one fit about their mean, and the questions asked before it: are they finite, enough, and
// spread in as many directions as the element needs?
#pragma once

#include <array>
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
  double negligible() const { return negligible_spread(largest_coordinate, extent()); }
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
