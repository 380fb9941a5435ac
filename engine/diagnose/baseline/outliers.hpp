// Gross outliers are taken out before anything is judged.
#pragma once

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// Standard deviations, predicted from all other touches, beyond which a touch is a gross outlier: one in 40
/// 000 normal ones.
inline constexpr double kOutlier = 4.2;

/// Fits the recording without its gross outliers: fills `masked`, `off_um`, `rows`, `model`, `hyper`.
void mask_outliers(Case&);

}  // namespace abbe::diagnose
