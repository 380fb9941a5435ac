// The part's own coordinates in every setup of a recording: those of the first setup, with the centre of its targets as origin. Other
// setups are brought onto them by the touches (feature, index) that they share with it: the best rigid transform of the targets
// (Kabsch's problem, solved as Horn's quaternion, J. Opt. Soc. Am. A 4, 1987). A setup that shares fewer than three touches, or
// touches on one line, keeps the orientation of the machine's axes.
#pragma once

#include <map>

#include "engine/recording/recording.hpp"

namespace abbe {

class PartFrames {
 public:
  explicit PartFrames(const Recording&);
  /// A point or a direction of the machine's coordinates, as seen from the part of that setup.
  Vec3 on_part(int setup, const Vec3& point) const { return X_PW_.at(setup) * point; }
  Vec3 direction_on_part(int setup, const Vec3& direction) const { return X_PW_.at(setup).R * direction; }

 private:
  std::map<int, Rigid> X_PW_;
};

}  // namespace abbe
