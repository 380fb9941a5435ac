// A model of a mismatch that the catalogue does not explain: the pattern in the factor where it lies, as an empirical effect of a machine
// file (engine/effects/empirical). Its coefficients are the ridge estimate under a common prior size, chosen by its evidence; their
// uncertainties are those that the data leave in what the data can see. Patterns over setup, run or feature are no property of a machine: none is made.
#pragma once

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// Settings of empirical effects; empty: the factor is not one of the machine.
std::vector<EffectSetting> empirical_model(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
