// A recording and what comes of it when its touches are made once more under a change.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/diagnose/planning/changes.hpp"

namespace abbe::diagnose {

/// A recording and its repetition under a change, as a diagnosis of both would see them.
struct Longer {
  Recording recording;
  Machine machine;           ///< with the styli that the change needs
  RecordedTouches touches;   ///< those of the recording first
  std::size_t first = 0;     ///< how many of them are of the recording
  std::vector<int> same_as;  ///< by touch: the touch of the recording that it is, or repeats
  std::size_t left_out = 0;  ///< touches that the stylus does not reach after the change
};

/// What is judged of a long recording: an even selection of its touches.
inline constexpr std::size_t kJudgedTouches = 240;
/// With `most` touches at most, and without those on surfaces that face away from the head then. Nothing when the machine is too
/// small for it, or most are such.
std::optional<Longer> repeated(const Case&, const Change&, std::size_t most = kJudgedTouches);
/// The baseline of both together, with the groups of noise that the recording has.
Baseline baseline_of(const Case&, const Longer&);

/// How long the new touches take, min: the machine, and the operator who places the part anew between two setups.
double minutes_of(const Longer&);

}  // namespace abbe::diagnose
