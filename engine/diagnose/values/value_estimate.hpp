// The sizes of an effect that was named from values, on machines that have errors of their own. A form or a distance
// in space is no sum of what the effect and the machine's errors make of it alone: so the programs run with both.
#pragma once

#include "engine/diagnose/values/value_ensemble.hpp"

namespace abbe::diagnose {

/// Mean and covariance of the sizes of the columns of a block, in units of the columns.
struct Sizes {
  Vector mean;
  Matrix covariance;
};

/// What recorded values are compared with.
struct ValueBench {
  const std::vector<RecordedValue>& values;
  const std::vector<ValueProgram>& programs;
  const Machine& machine;
  const DiagnoseOptions& options;
  const Vector& deviation;    ///< of the recording
  const Matrix& covariance;   ///< of the values of machines of the specification, with calibration
  const Matrix& calibration;  ///< a column for each artefact: a standard deviation
};

/// Gauss-Newton steps from `start`, weighted by the covariance, with the mean of simulated machines as the model and
/// their spread under the effect as the uncertainty. Nothing where hardly a machine with it reaches the values.
std::optional<Sizes> sizes_beside_errors(const ValueBench&, const Effect&, const Block&, const Vector& start);

}  // namespace abbe::diagnose
