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
  Matrix simulated;           ///< machines x values: deviations
  Explanations explanations;  ///< of the catalogue: signatures of the values
};

/// `machines` accepted machines; those that do not reach every value are left out.
ValueEnsemble value_ensemble(const ValueRecording&, const std::vector<ValueProgram>&, const Machine&,
                             const DiagnoseOptions&, int machines);

/// The same values of other machines: machines x values, NaN where one does not reach a value.
Matrix simulated_values(const std::vector<RecordedValue>&, const std::vector<ValueProgram>&, const Machine&,
                        const VirtualMachines&, const DiagnoseOptions&, const Contributors& = {});
/// The machines that reach every value.
Matrix complete_rows(const Matrix&);
/// Simulated machines (rows) as they would be recorded: each with its own errors of calibration and of rounding, of which
/// every column of `recorded` is a standard deviation.
Matrix as_recorded(Matrix machines, const Matrix& recorded, std::uint64_t seed);

}  // namespace abbe::diagnose
