// What begins, ends or differs between the runs and files of a recording: variants of an effect that act in some of them.
#pragma once

#include <vector>

#include "engine/diagnose/model/explanation.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// Where something may have changed between runs: in front of one of a stretch of runs.
struct LaterRun {
  int from_run = 0;  ///< the middle one, which stands for all
  Cell runs;         ///< places in the order of the later runs: from low, up to high without it
  Cell gap_s;        ///< from the last touch in front of it to its first

  double between_s() const { return (gap_s.low + gap_s.high) / 2; }
};
/// Every run but that of the lowest number.
std::vector<LaterRun> later_runs(const RecordedTouches&, const std::vector<int>& rows);
/// Those of some runs, one after the other, in at most so many stretches.
std::vector<LaterRun> in_stretches(const std::vector<LaterRun>& single, std::size_t most);

/// What settles, once in the whole time and, of several files, anew in each, or in one of them alone: a warm-up every
/// morning, or on the day on which the air conditioning stood still. There the time constants that are tried, shares of the
/// whole time, are shares of the longest file: a night may lie between two.
std::vector<Variant> with_beginnings(std::vector<Variant>, const Effect&, const RecordedTouches&,
                                     const std::vector<int>& rows);

/// The same from each run but the first on, or from one of each stretch of them: what is new in a run, after
/// a crash, a mend or a change of the weather; what is gone, a dirty tip that was cleaned; and what came and went. What
/// happens at a moment happens between the runs then, or within one and is gone in the next: a stylus that slipped and was
/// tightened. What goes on in time, or is drawn anew in every visit, is new by itself.
std::vector<Variant> with_changes(std::vector<Variant>, const Effect&, const std::vector<LaterRun>&);

}  // namespace abbe::diagnose
