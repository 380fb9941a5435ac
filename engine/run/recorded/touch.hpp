// Recorded touches as the effects and the machine model see them: the scene of every row of a recording,
// filled from what was logged where a simulated touch is filled by the motion model. From here on simulation
// and diagnosis share all physics.
//
// A row is one scalar observation: residual = n . (recorded - target). Targets may lie anywhere; when they
// reach outside the travel of the machine the whole recording is put into the middle of its volume, and a
// message says so, because where a part stood decides its errors.
//
// Every setup has its own placement of the part; part_frame.hpp says what the part's own coordinates are, which
// effects of the part need.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/effects/effect.hpp"
#include "engine/machine/machine.hpp"
#include "engine/recording/recording.hpp"

namespace abbe {

/// From touch to touch, where no time was logged.
inline constexpr double kUsualInterval_s = 5;

struct RecordedTouch {
  TouchScene scene;                 ///< its readings are those at the target: free of the touch's own errors and noise
  double residual_mm = 0;           ///< n . (recorded - target): positive when the surface seems too far out
  Vec3 per_rad_a_mm, per_rad_b_mm;  ///< of the tip per radian of the head's angles, W
  Vec3 beyond_target_mm;            ///< from there to where the axes stopped, W; zero where no reading was logged
  int row = 0;                      ///< index into the recording
  int file = 0;                     ///< RecordingRow::file
};

/// The scene as an effect sees it: with the readings where the axes stopped, if it needs raw readings.
TouchScene scene_for(const Effect&, const RecordedTouch&);

struct RecordedTouches {
  std::vector<RecordedTouch> touches;  ///< in the order of time where it was logged, else of the rows
  std::vector<std::string> features;   ///< labels by TouchScene::feature
  std::vector<std::string> styli;      ///< by StylusScene::ordinal - 1: the name of the first sensor with that stylus
  int tips = 0;                        ///< qualified tips: styli in each of their orientations
  std::shared_ptr<const std::set<std::string>> names;  ///< of the sensors; scenes point to them, those of copies too
  unsigned known = 0;                                  ///< Covariates that every row gives
  unsigned varying = 0;                                ///< of these, those that are not the same throughout
  std::vector<Diagnostic> messages;
};

/// From the first touch to the last, s; 1 at the least, so that it divides.
double lasts_s(const RecordedTouches&);

/// The number of the point of a surface that each touch aims at, wherever the part stood and whatever run it was: points
/// of a feature that are nearer than two micrometres on the part are one, as targets are rounded.
std::vector<int> surface_points(const RecordedTouches&);

/// Throws UserError (E0543), with the first touch that has no target or no normal.
void require_targets(const Recording&, const std::string& file);

/// The touches of a recording on a machine. Throws UserError: a row without target or normal, a sensor that
/// the machine does not know.
RecordedTouches recorded_touches(const Recording&, const Machine&, const std::string& file);

}  // namespace abbe
