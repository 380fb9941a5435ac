// Where the part stood in each setup of a recording, off its targets. The linear model has a free placement
// for every setup, but a linear one: 2 mm beside the targets, or turned by a degree, 1 - cos would pass for a
// scale error of 150 um/m, and raw distances would say that the part is not what its targets say. So the
// finite placement is taken out first.
//
// It minimises the sum of |d|, where d is the distance of X p from the surface at its target: absolute values,
// because a few gross errors must not turn the part; from the surface, because where a touch lies beside its
// target is what the machine was told, not what it found. A plane is n . (X p - t) away; balls and cylinders bend
// (round_surface.hpp). Iteratively reweighted Gauss-Newton steps; of motions that the normals do not tell apart,
// such as the turn of a ball, the one that turns least is taken.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// The recording with the positions of every setup that stood noticeably off its targets carried back to
/// them, as far along their normals as they lie from the surface; a note tells how far (N0709). Throws UserError (E0701) when all touches of a setup lie further out,
/// or in, than `most_out_mm` beside that: a wrong tip.
Recording put_on_targets(const Recording&, double most_out_mm, const std::string& file,
                         std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
