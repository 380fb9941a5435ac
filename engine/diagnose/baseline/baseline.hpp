// The baseline: what the simulated ensemble of virtual machines may do to a recording, as a linear-Gaussian model.
//
// The error functions of virtual machines are linear in their coefficients (engine/machine/geometry.hpp). So
// one run of perturbed machines, each with one coefficient of 1, through the same kernel that simulates
// touches gives the sensitivities, and the covariance of the coefficients comes from a sample of screened
// machines: no second physics. The head adds its indexing errors by visit, and every qualified stylus the
// uncertainty of its qualification. Each setup has a free placement (six unknowns). Surfaces whose true place
// nobody knows get an unknown each: by feature (its size) or by surface point (then only differences
// between runs are judged).
//
// *Fresh*: the covariance follows from the specification alone. *Known machine*: mean and covariance of the
// coefficients are those that an earlier diagnosis of the same machine left (known_state of the machine
// file).
#pragma once

#include <optional>
#include <string>

#include "engine/diagnose/diagnosis.hpp"
#include "engine/diagnose/model/linear.hpp"
#include "engine/machine/machine.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// What is known of the coefficients of the error functions beyond the specification; mm, rad.
struct KnownGeometry {
  Vector mean;
  Matrix factor;  ///< covariance = factor factor'
};

struct BaselineOptions {
  Surfaces surfaces = Surfaces::calibrated;
  const KnownGeometry* known = nullptr;
  std::uint64_t seed = 1;
  int threads = 1;
  const KnownGeometry* sampled = nullptr;  ///< what the specification gives, when it was sampled before
};

struct Baseline {
  LinearModel model;
  Matrix geometry_um;   ///< rows x coefficients: um per unit coefficient
  Matrix factor;        ///< covariance of the coefficients = factor factor', before its scale is estimated
  Vector mean;          ///< of the coefficients
  Matrix rough_factor;  ///< the harmonics nearest to each column of model.rough: coefficients x columns
  Surfaces surfaces = Surfaces::calibrated;
  std::optional<LengthError> beyond;     ///< a length that is worse than the specification allows
  std::vector<std::string> noise_names;  ///< of the groups of rows with a common noise
};

Baseline baseline_of(const RecordedTouches&, const Machine&, const BaselineOptions&);

/// Of the two ensembles of a baseline.
enum class Errors { harmonic, rough };
/// Mean and covariance of the coefficients given the recording: what a later diagnosis may start from. Of rougher errors
/// those of the harmonics that come nearest to them: harmonics that were fitted to them would bend between the touches.
KnownGeometry posterior(const Baseline&, const Hyperparameters&, Errors = Errors::harmonic);

}  // namespace abbe::diagnose
