// The part's own coordinates, in which what the part does is given: where it grows, bows, or is out of form.
//
// In a program, the coordinate system in which most touches are made, of equally many the first. One for all
// touches: the part does not move when the program changes its coordinate system. Where that is the machine's
// own, its origin says nothing of the part: then it is that system with the middle of all touches as origin.
//
// In a recording those of its program; without a program those of the file where it is in part coordinates.
// Else those of the machine in the first setup, with the centre of its targets as origin. Other setups are
// brought onto them by what they share with it, with the best rigid transform (rigid_fit): the touches of the
// same feature and index where these are the same points of the part, or those of them whose features have as
// many touches in both, else the centres of the features that are touched from enough sides to have one (balls, mostly). A setup that shares too little keeps the
// orientation of the machine's axes.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe {

/// Counts the touches in each coordinate system of a program. W: any frame, the same for all that it is given.
class FrameCount {
 public:
  /// A touch of that surface point under the coordinate system X_WD.
  void add(const Rigid& X_WD, const Vec3& surface_W);
  /// X_WP, where X_WM is the machine's coordinate system.
  Rigid of_part(const Rigid& X_WM) const;

 private:
  struct Used {
    Rigid X_WD;
    int touches = 0, order = 0;
  };
  /// by its numbers, rounded to 1 um and 1 urad: a system that is made again is the same
  std::map<std::array<long, 12>, Used> used_;
  Vec3 sum_;  ///< of the surface points
};

/// Where a touch was aimed, in the machine's coordinates.
struct AimedTouch {
  int setup = 1;
  std::string feature;
  int index = 1;  ///< of the touch in its feature
  Vec3 surface, normal;
};

class PartFrames {
 public:
  explicit PartFrames(const std::vector<AimedTouch>&);
  /// A point or a direction of the machine's coordinates, as seen from the part of that setup.
  Vec3 on_part(int setup, const Vec3& point) const { return X_PW_.at(setup) * point; }
  Vec3 direction_on_part(int setup, const Vec3& direction) const { return X_PW_.at(setup).R * direction; }

 private:
  std::map<int, Rigid> X_PW_;
};

}  // namespace abbe
