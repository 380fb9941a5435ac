// A model of a mismatch that the catalogue does not explain: the pattern in the factor where it lies, as an
// empirical effect of a machine file (engine/effects/empirical). The pattern is estimated as it was found: a smooth
// one stays smooth. Its coefficients are the ridge estimate under a common prior size, chosen by its evidence; the effect
// follows it by least squares, with the uncertainty that the data leave in what they see. Patterns over setup, run or feature are no property of a machine, and patterns over
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
