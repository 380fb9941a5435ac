// Recorded values beside those of simulated machines: what a diagnosis of values is made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/values/value_ensemble.hpp"
#include "engine/diagnose/values/value_search.hpp"

namespace abbe::diagnose {

/// What rounding leaves of a value that no error reaches.
inline constexpr double kLeastOfValue_um = 1e-3;

/// Simulated machines that values are compared with.
struct Judges {
  Vector mean;        ///< of the first half
  Matrix covariance;  ///< of these, with that of the calibrations and of rounding
  Matrix judged;      ///< the second half, with errors of calibration and of rounding
};

/// Recorded values, and what they are judged by.
struct ValueCase {
  const ValueRecording* recording = nullptr;
  const std::vector<ValueProgram>* programs = nullptr;
  const Machine* machine = nullptr;
  const DiagnoseOptions* options = nullptr;
  ValueEnsemble ensemble;
  Vector deviation;
  Matrix recorded;  ///< one column for each artefact: a standard deviation of its calibration; then one for each value:
                    ///< that of its rounding
  Judges judges;
  std::optional<ValueSearch> search;
};

/// Throws UserError: too many values (E0552).
void refuse_too_many(const ValueRecording&);

/// Beside these machines; nothing where hardly any of them reaches all values.
std::optional<ValueCase> value_case_of(const ValueRecording&, const std::vector<ValueProgram>&, const Machine&,
                                       const VirtualMachines&, const DiagnoseOptions&);

/// How many virtual machines judge so many values.
int machines_for(std::size_t values);
/// Whether these machines (rows) are enough to judge their values.
bool enough(const Matrix& simulated);
/// `simulated`: machines x values, more than twice as many machines as values.
Judges judges_of(const Matrix& simulated, const Matrix& recorded, std::uint64_t seed);

/// As the recording calls the program of a value, else the name of its file.
std::string program_of(const ValueCase&, std::size_t value);

/// What each value is called, repeats alike: "LX2 of part.dmi"; the evaluation too, where it is not the first.
std::vector<std::string> labels_of(const ValueCase&);

}  // namespace abbe::diagnose
