// The signature of an effect: what it does to readings, drawn from the effect's own function. No
// effect says anything of its figure; a new one has one as soon as it is in the registry.
//
// Shown is r = n . d in um, positive where the surface seems too far out, as `abbe record --with
// EFFECT` lets the effect act: its first parameter of typical size, a choice at its standard,
// everything else as usual. The abscissa is the first quantity of figures/scenes.hpp that belongs
// to a covariate which the effect needs and along which r changes; the face that is touched is the
// one on which it changes most. Two lines show two random machines, where the effect draws one; or
// a second face, or else two values of a second quantity, whichever comes first and matters. An
// effect that draws for every touch is shown by single touches.
#pragma once

#include "engine/effects/effect.hpp"
#include "engine/figures/chart.hpp"
#include "engine/machine/machine.hpp"

namespace abbe {

/// The chart of one effect; the same on every computer.
Chart signature(const Effect&, const Machine&);

}  // namespace abbe
