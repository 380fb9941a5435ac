// The hyperparameters of a recording's model: scale of a group of Z, factor on the noise of a group of rows and
// correlation of neighbours, by restricted maximum likelihood with weak priors about 1, because a wrong prior of the
// baseline is the greatest source of false alarms. [Patterson & Thompson, Biometrika 58 (1971)]
#pragma once

#include "engine/diagnose/model/linear.hpp"

namespace abbe::diagnose {

/// Restricted maximum likelihood with log-normal priors about 1 (sd scale_spread for the scale, 0.5 for the noise).
Hyperparameters estimate(const LinearModel&);

/// The same without a correlation of neighbours.
Hyperparameters estimate_uncorrelated(const LinearModel&);

}  // namespace abbe::diagnose
