// What the effects of the registry do to recorded values: each is planted at its typical size on an
// error-free machine, and the programs run. Two patterns stand for what the catalogue does not have: single
// values that stray, and a machine with larger errors than specified.
#pragma once

#include "engine/diagnose/values/value_ensemble.hpp"
#include "engine/machine/screening.hpp"

namespace abbe::diagnose {

/// The catalogue: one explanation for each effect that does something to values, a variant for each combination of its
/// choices and each sign of its sizes, a column for each linear parameter. `machines`: where the error-free machine takes its numbering
/// from. OTHER is added by add_value_patterns.
Explanations value_explanations(const std::vector<RecordedValue>&, const std::vector<ValueProgram>&, const Machine&,
                                const VirtualMachines& machines, const DiagnoseOptions&);

/// The shape of the pattern that one characteristic strays by itself, in all its repeats alike.
inline constexpr const char* kOneCharacteristic = "one characteristic";

/// OTHER: `covariance` of the values as the machines of the specification have it; `labels`: what each value is called,
/// repeats alike. Sets the priors of all explanations.
void add_value_patterns(const std::vector<std::string>& labels, const Matrix& covariance, Explanations&);

}  // namespace abbe::diagnose
