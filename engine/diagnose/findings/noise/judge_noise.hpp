// What scatters otherwise than the machine and its specification say.
#pragma once

#include "engine/diagnose/findings/noise/noise_property.hpp"

namespace abbe::diagnose {

/// By what each could be chance, least first.
std::vector<NoiseFinding> judge_noise(const Case&, const SearchResult&);

}  // namespace abbe::diagnose
