// The state that a diagnosis leaves in a machine file (`known_state`), so that the next one starts from a
// known machine instead of from the specification: mean and covariance of the coefficients of the error
// functions, the covariance as a factor of low rank.
#pragma once

#include <string>

#include "engine/diagnose/baseline/baseline.hpp"

namespace abbe::diagnose {

KnownGeometry known_geometry(const KnownState&);

/// JSON text for the key `known_state`; the machine file is read in engine/machine/machine_file.cpp.
std::string write_known_state(const KnownGeometry&, const Hyperparameters&);

}  // namespace abbe::diagnose
