// Gross outliers are taken out before anything is judged.
#pragma once

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// Fits the recording without its gross outliers: fills `masked`, `off_um`, `rows`, `model`, `hyper`.
void mask_outliers(Case&);

}  // namespace abbe::diagnose
