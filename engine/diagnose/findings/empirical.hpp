// A model of a mismatch that the catalogue does not explain: the pattern in the factor where it lies, as an
// empirical effect of a machine file (engine/effects/empirical). The pattern is estimated as it was found: a smooth
// one stays smooth. Its coefficients are the ridge estimate under a common prior size, chosen by its evidence; the effect
// follows what it shows beside the placement of the part by least squares, with the uncertainty that the data leave in
// what they see. Patterns over setup, run or feature are no property of a machine. Of a pattern over two factors, or one that
// an effect of its factor follows badly, the effect is that of the factor which makes most of it, at least half.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct EmpiricalModel {
  std::vector<EffectSetting> settings;  ///< of empirical effects; empty: none follows the pattern
  std::optional<Factor> follows;        ///< of which the effects are functions, where that is not all of the pattern
};
EmpiricalModel empirical_model(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
