// How a program finds a part that was moved: by a manual alignment on some of its own touches, which its
// targets then refer to.
//
// Three faces that lie across one another take three, two and one touches (ISO 5459, 3-2-1): the first gives
// Z, the line on the second X and Y = 0, the point on the third X = 0. Where everything that is touched is
// one ball, its centre is enough: how a ball is turned no touch can tell. Other parts need a jig or the
// operator's own alignment, and the program says where they must stand.
#pragma once

#include <optional>
#include <string>

#include "engine/diagnose/planning/second_recording.hpp"

namespace abbe::diagnose {

struct Alignment {
  std::string statements;  ///< DMIS: the touches and the coordinate system
  Rigid X_DR;              ///< from the coordinates of the recording into that system
};

/// For the new touches of a recording, of which all are in one placement.
std::optional<Alignment> alignment_of(const Longer&);

/// A touch in the coordinates of the recording: the point of the surface.
Vec3 surface_of(const Longer&, std::size_t touch);

}  // namespace abbe::diagnose
