// Where the part stood in each setup of a recording, off its targets. The linear model has a free placement
// for every setup, but a linear one: 2 mm beside the targets, or turned by a degree, 1 - cos would pass for a
// scale error of 150 um/m, and raw distances would say that the part is not what its targets say. So the
// finite placement is taken out first.
//
// It minimises the sum of |n . (X p - t)|: absolute values, because a few gross errors must not turn the
// part; along the normals, because where a touch lies beside its target is what the machine was told, not
// what it found. Iteratively reweighted Gauss-Newton steps; motions that the normals do not see, such as the
// turn of a ball, are left alone.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// The recording with the positions of every setup that stood noticeably off its targets carried back to
/// them; a note tells how far (N0709). Throws UserError (E0701) when all touches of a setup lie further out,
/// or in, than `most_out_mm` beside that: a wrong tip.
Recording put_on_targets(const Recording&, double most_out_mm, const std::string& file,
                         std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
