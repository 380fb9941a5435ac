// The programs of a recording of values on virtual machines: the joint distribution of all recorded values,
// and what each effect does to them. Deviations from the reference, um (lengths) and urad (angles).
#pragma once

#include "engine/diagnose/model/explanation.hpp"
#include "engine/diagnose/values/value_diagnosis.hpp"
#include "engine/machine/screening.hpp"
#include "engine/run/run.hpp"

namespace abbe::diagnose {

/// One row of the recording, found in its program.
struct RecordedValue {
  int program = 0, repeat = 0;  ///< index into the programs; which repeat of all (RunOptions::repeat)
  plan::CharacteristicId characteristic;
  int occurrence = 1;
  bool angle = false;
  double reference = 0;     ///< mm or degrees
  double deviation = 0;     ///< value minus reference
  double calibration = 0;   ///< standard uncertainty of the reference
  int artefact = 0;         ///< values of one artefact share the error of its calibration
  double reported() const;  ///< mm or degrees per um or urad
};

/// The values that figures of a whole file are of: the lengths, um; of a file without any the angles, urad.
std::vector<Eigen::Index> of_figures(const std::vector<RecordedValue>&);

struct ValueEnsemble {
  std::vector<RecordedValue> values;
  VirtualMachines machines;   ///< those that reach every value
  Matrix simulated;           ///< machines x values: deviations
  Explanations explanations;  ///< of the catalogue: signatures of the values
};

ValueEnsemble value_ensemble(const ValueRecording&, const std::vector<ValueProgram>&, const Machine&,
                             const VirtualMachines&, const DiagnoseOptions&);

/// The same values of other machines: machines x values, NaN where one does not reach a value.
Matrix simulated_values(const std::vector<RecordedValue>&, const std::vector<ValueProgram>&, const Machine&,
                        const VirtualMachines&, const DiagnoseOptions&, const Contributors& = {});
/// Some of the machines, by position; the first ones.
VirtualMachines chosen(const VirtualMachines&, const std::vector<Eigen::Index>&);
VirtualMachines first_of(const VirtualMachines&, Eigen::Index count);
/// The machines (rows) that reach every value.
std::vector<Eigen::Index> complete_rows(const Matrix&);
Matrix complete(const Matrix&);
/// The same values, all of one repeat of each program: in expectation repeats are alike.
std::vector<RecordedValue> one_repeat(std::vector<RecordedValue>);
/// Simulated machines (rows) as they would be recorded: each with its own errors of calibration and of rounding, of which
/// every column of `recorded` is a standard deviation.
Matrix as_recorded(Matrix machines, const Matrix& recorded, std::uint64_t seed);

}  // namespace abbe::diagnose
