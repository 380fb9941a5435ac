// The smallest scatter that a plan would show: scatter of a size goes through the judgement of a recording (scatter.hpp)
// as its squared residuals are expected to be; it is seen where it would be with a power of 80 %. It is named where
// repeats would show that it is other each time: without them it may be a pattern too fine for the recording.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "engine/diagnose/findings/noise/scatter.hpp"

namespace abbe::diagnose {

/// What nothing shows, or tells, at any size.
inline constexpr double kAtNoSize = std::numeric_limits<double>::infinity();

/// Sizes as excess of variance over that of the probe.
struct ScatterForm {
  double detected = kAtNoSize, named = kAtNoSize;
};

/// Of an even number the better one; by the excess from which on it is `seen`.
double median_excess(std::vector<ScatterForm>, double ScatterForm::*seen);

/// The least number above 0 at which something that stays true becomes true; kAtNoSize: nowhere up to `most`.
double least(double most, const std::function<bool(double)>& holds);

class ScatterDesign {
 public:
  /// Refers to the case.
  explicit ScatterDesign(const Case&);

  const Case& planned() const { return c_; }
  double noise_um() const { return noise_um_; }

  /// Of variances 1 + excess * share; `told`: what must hold of the excess that is read from the residuals, with the
  /// power.
  ScatterForm along(const Vector& share, const std::function<bool(double)>& told, int of_its_kind = 1) const;

  /// Of all touches alike, over the specification of the probe.
  ScatterForm everywhere() const;

 private:
  Excess expected(const Vector& share, double excess) const;
  double repeats_tell_from(const Vector& share) const;

  const Case& c_;
  double noise_um_ = 1;
  Vector own_;  ///< by row: inverse variance of the residual, in units of the touch's noise
  Matrix coupling_;
};

/// An effect of the noise, of no size yet.
Detectable smallest_of(const Effect&, const char* parameter, const char* unit);

}  // namespace abbe::diagnose
