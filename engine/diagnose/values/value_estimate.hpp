// Effects on recorded values beside the errors that every machine has. A form or a distance in space is no sum of what
// the effect and the machine's errors make of it alone: so the programs run with both.
#pragma once

#include <map>

#include "engine/diagnose/values/value_ensemble.hpp"
#include "engine/diagnose/values/value_search.hpp"

namespace abbe::diagnose {

/// What rounding leaves of a value that no error reaches.
inline constexpr double kLeastOfValue_um = 1e-3;

/// Mean and covariance of the sizes of the columns of a variant, in units of the columns.
struct Sizes {
  Vector mean;
  Matrix covariance;
  bool adds = false;  ///< what the effect does to values is the same on every machine
};

/// Under a prior so wide that it does not pull.
Sizes sizes_of(const ValueSearch&, int variant, const Vector& deviation);

/// What recorded values are compared with. All of it must outlive this.
struct ValueReference {
  const std::vector<RecordedValue>& values;
  const std::vector<ValueProgram>& programs;
  const Machine& machine;
  const DiagnoseOptions& options;
  const VirtualMachines& machines;  ///< of the specification, and their deviations: machines x values
  const Matrix& simulated;
  const Vector& deviation;  ///< of the recording
  const Vector& mean;       ///< of values of machines of the specification, as they are recorded, and their covariance
  const Matrix& covariance;
  const Matrix& recorded;  ///< a column for each error of calibration and of rounding: a standard deviation
};

/// Makes the likeliest variants of the catalogue linear near the sizes that fit best (Gauss-Newton steps weighted by the
/// covariance, with the mean of simulated machines as the model), so that their evidence is that beside errors. Means are
/// taken as differences on the same machines, of which few tell them; a covariance takes many, and is asked for once, or not
/// at all where what the effect adds is the same on all machines.
/// Returns the sizes by variant, with the spread of the simulated machines under the effect as the uncertainty; a variant
/// that hardly any machine reaches all values with is left as it was.
std::map<int, Sizes> linearise_likeliest(ValueSearch&, const ValueReference&);

/// By how much the size of column `k` is moved, in units of the column, to see what it changes: to where it may be.
double move_within_range(const Effect&, const Variant&, const Vector& sizes, Eigen::Index k);

/// The machine with an effect of these sizes, in units of the columns of the variant, or the nearest possible ones.
Machine with_effect(const Machine&, const Effect&, const Variant&, const Vector& sizes);

}  // namespace abbe::diagnose
