// What scatters otherwise than the machine and its specification say.
#pragma once

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

struct NoiseFinding {
  const Effect* effect = nullptr;
  double p = 1;
  std::vector<DiagnosedParameter> parameters;
  std::string sentence;
  bool certain = true;  ///< that it is noise: what scatters may else be a pattern too fine for this recording
  std::optional<Factor> factor = {};  ///< in which it shows; none of what is everywhere
  std::vector<std::pair<std::string, std::string>> where = {};
};
std::vector<NoiseFinding> judge_noise(const Case&, const SearchResult&);

/// So many touches lie beyond the limit of gross outliers by normal noise and, at most but for two standard uncertainties,
/// by what the machine file has of them.
double expected_outliers(const Case&);

}  // namespace abbe::diagnose
