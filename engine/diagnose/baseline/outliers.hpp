// Gross outliers are taken out before anything is judged.
#pragma once

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// The touches that take part, where those of `masked` do not: fills `alone`, `rows` and `model` from a model of all
/// touches. Where nothing can be judged all of them do.
void take_part(Case&, const LinearModel& all);
/// Fits the recording without its gross outliers: fills `masked`, `off_um`, `alone`, `rows`, `model`, `hyper`.
void mask_outliers(Case&);

}  // namespace abbe::diagnose
