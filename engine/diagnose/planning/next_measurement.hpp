// Which measurement would decide between explanations that a recording cannot tell apart.
//
// A change of the menu makes a second recording out of the first one: its rows, repeated another way (other
// speed, other stylus, part turned, ...). Both together go through the same steps as any recording: scenes,
// baseline with the same unknowns, signatures. So what is proposed can be recorded, and it is judged with
// what will be unknown then (sizes nobody calibrated, placements, qualifications of new styli).
//
// Each rival in turn counts as the truth, of the size that the first recording gives it. With W the columns
// of another rival, whitened by the baseline, the truth's shift s leaves delta = min |s - W b|^2 that the
// other cannot imitate, over its variants. What the second recording adds, D = delta(both) - delta(first),
// makes the log odds of the truth normal with mean D / 2 and variance D. The expected probability of the
// truth follows, averaged over the rivals as truth: what a recording cannot tell apart counts as equally
// likely (Atkinson & Fedorov, Biometrika 62, 1975). Where no single change decides, the best ones are
// tried two at a time. Ranked by gain per minute, a round of an hour included.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// One change to how touches are made.
struct Change {
  std::string text;         ///< "repeat with probing speed 3 mm/s"
  std::string instruction;  ///< for the operator, or empty when the program does it all
  double minutes = 0;       ///< beyond the measuring itself
  /// What becomes of a row; a stylus that is new joins the sensors of the machine.
  std::function<void(RecordingRow&, Machine&)> apply = [](RecordingRow&, Machine&) {};
  std::optional<Rigid> move{};  ///< of the part, in the coordinates of the recording
  bool new_setup = false;       ///< the part is placed anew, or does not stay put to micrometres
  bool reversed = false;        ///< the sequence runs from its end to its beginning
  bool changes_touches = true;  ///< not only their order and time
};

/// Whether a tip lies along the last link of the head; no arm of a star does.
inline bool is_straight(const Vec3& tip_in_r_mm) {
  return std::hypot(tip_in_r_mm.x, tip_in_r_mm.y) < 1e-6 * norm(tip_in_r_mm);
}

/// The changes that a recording like this one can hold.
std::vector<Change> changes_for(const Case&);

/// A recording and its repetition under a change, as a diagnosis of both would see them.
struct Longer {
  Recording recording;
  Machine machine;           ///< with the styli that the change needs
  RecordedTouches touches;   ///< those of the recording first
  std::size_t first = 0;     ///< how many of them are of the recording
  std::vector<int> same_as;  ///< by touch: the touch of the recording that it is, or repeats
};

/// What is judged of a long recording: an even selection of its touches.
inline constexpr std::size_t kJudgedTouches = 240;
/// With `most` touches at most. Nothing when the machine is too small for it.
std::optional<Longer> repeated(const Case&, const Change&, std::size_t most = kJudgedTouches);
/// The baseline of both together, with the groups of noise that the recording has.
Baseline baseline_of(const Case&, const Longer&);

/// How long the machine takes for the new touches, min.
double minutes_of(const Longer&);
/// How the recording of the new touches is told from those before: "Give its recording run 2 and setup 2: ...".
std::string recording_sentence(const Longer&);
/// The new touches as a DMIS program.
std::string dmis_program(const Case&, const Longer&, const Change&);

/// The changes that would tell most per minute, the best of them as a program. `found`: what the recording holds;
/// none of a plan.
std::vector<NextMeasurement> next_measurements(const Case&, const SearchResult* found, const std::vector<Detectable>&);

}  // namespace abbe::diagnose
