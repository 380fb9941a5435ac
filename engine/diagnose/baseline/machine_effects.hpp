// Effects that the machine file already has are part of the model that a recording is compared with: their
// best estimates are taken from the residuals, their uncertain sizes and random numbers are further unknowns
// of the baseline. So a machine that an earlier diagnosis improved is judged as it is known now.
#pragma once

#include "engine/diagnose/baseline/baseline.hpp"
#include "engine/run/effect_set.hpp"

namespace abbe::diagnose {

/// Takes the best estimates from the residuals.
void remove_estimates(const EffectSet&, RecordedTouches&);
/// Adds what is uncertain of the effects: columns that keep their scale, and noise for what is drawn at every touch.
void add_uncertainties(const EffectSet&, const RecordedTouches&, Baseline&);
/// Adds the standard uncertainty of rounded positions to the noise, unless the machine file has it there already.
void add_rounding(const Machine&, double rounding_um, LinearModel&);

}  // namespace abbe::diagnose
