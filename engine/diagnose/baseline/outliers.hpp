// Gross outliers are taken out before anything is judged.
#pragma once

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// The touches that take part: those that are not `masked`, without those of which no other says anything. Fills `rows`
/// and `model` from a model of all touches. Where nothing can be judged all that are not masked do.
void take_part(Case&, const LinearModel& all);
/// Fits the recording without its gross outliers: fills `masked`, `off_um`, `rows`, `model`, `hyper`.
void mask_outliers(Case&);

}  // namespace abbe::diagnose
