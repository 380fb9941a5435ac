// A model of a mismatch that the catalogue does not explain: the pattern in the factor where it lies, as an
// empirical effect of a machine file (engine/effects/empirical). Its coefficients are the ridge estimate
// under a common prior size, chosen by its evidence; their uncertainties are those that the data leave in
// what the data can see. Patterns over setup, run or feature are no property of a machine, and patterns over
// two factors have no such effect: the likeliest other one stands for them.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct EmpiricalModel {
  /// of empirical effects; empty: no pattern that the recording speaks for has one
  std::vector<EffectSetting> settings;
  const Explanation* follows = nullptr;  ///< the pattern that they follow
};
EmpiricalModel empirical_model(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
