// The state that a diagnosis leaves in a machine file (`known_state`), so that the next one starts from a
// known machine instead of from the specification: mean and covariance of the coefficients of the error
// functions, the covariance as a factor of low rank.
#pragma once

#include <optional>
#include <string>

#include "engine/diagnose/baseline/baseline.hpp"

namespace abbe::diagnose {

/// The known state of a machine; nothing when its file has none. Throws UserError: not made for this
/// machine's number of harmonics, a missing key, a row of another length.
std::optional<KnownGeometry> read_known_state(const Machine&);

/// JSON text for the key `known_state`.
std::string write_known_state(const KnownGeometry&, const Hyperparameters&);

}  // namespace abbe::diagnose
