// What the effects of the registry do to recorded values: each is planted at its typical size on an
// error-free machine, and the programs run.
#pragma once

#include "engine/diagnose/values/value_ensemble.hpp"
#include "engine/machine/screening.hpp"

namespace abbe::diagnose {

/// The catalogue: one explanation for each effect that does something to values, a variant for each combination of its
/// choices and each sign of its sizes, a column for each linear parameter. `machines`: where the error-free machine takes its numbering
/// from. OTHER is added by add_value_patterns.
Explanations value_explanations(const std::vector<RecordedValue>&, const std::vector<ValueProgram>&, const Machine&,
                                const VirtualMachines& machines, const DiagnoseOptions&);

}  // namespace abbe::diagnose
