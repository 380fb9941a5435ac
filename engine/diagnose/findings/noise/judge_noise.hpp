// What scatters otherwise than the machine and its specification say.
#pragma once

#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/diagnose/findings/noise/touch_groups.hpp"

namespace abbe::diagnose {

/// By what each could be chance, least first.
std::vector<NoiseFinding> judge_noise(const Case&, const SearchResult&);

/// The touches of which chance explains least that they scatter more than the others, as long as nothing has been found: a
/// noise of their own may be all that a pattern, or a name, seems to explain. Gross outliers count where they struck these.
std::optional<NoisyGroup> noisy_touches(const Case&);
/// Whether that they do explains more than any explanation; not, where their noise is estimated by itself already.
bool explains_more(const NoisyGroup&, const Case&, const Evidence& first);
/// Gives them a noise of their own, and looks for gross outliers again.
void part(const TouchGroup&, Case&);

}  // namespace abbe::diagnose
