// Where the tip goes between the touches of a proposed measurement.
//
// A recording holds touches and no other positions, so a way that nobody has driven is kept away from
// everything that it shows:
// - from a touch the tip goes back along its normal, and towards a surface that faces it no further than halfway (the middle of a bore);
// - straight to the next touch only within a feature, and only past the side on which the machine has touched it;
// - else along the stylus, from the tip to the head, where nothing but the stylus can have been, out of the box of all touches, and up until
//   the head is a stylus length above that box. Only there styli are changed and the head is turned; down and in it goes the same way.
// What stands beside the touches (clamps, ribs, the stand of a ball) is not in a recording: a path is not
// checked for collision.
#pragma once

#include <vector>

#include "engine/diagnose/planning/second_recording.hpp"

namespace abbe::diagnose {

/// One thing that the machine does. Positions are of the centre of the tip, W, mm.
struct Step {
  enum class Kind { go, stylus, touch };
  Kind kind = Kind::go;
  std::size_t touch = 0;  ///< of the recording: which, or whose stylus
  Vec3 to;                ///< where a `go` leads
};

struct Path {
  std::vector<Step> steps;
  std::vector<double> free_mm;  ///< by new touch: how far the tip goes back along the normal
  double missing_mm = 0;        ///< what the travel of the machine lacks of a way out of the box, or up
};

/// The path of the new touches.
Path path_of(const Longer&);

}  // namespace abbe::diagnose
