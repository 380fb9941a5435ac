// The clock of a recording: another beginning, a new day, hands that were put back or stand still.
#pragma once

#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/recording/recording.hpp"

namespace abbe::diagnose {

/// A recording whose clock of the day falls back at midnight, with times that go on (N0727): what comes later in the file
/// stands more than half a day before what comes first.
void continue_past_midnight(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording without the clocks of files that show the same time at all their touches (W0738).
void leave_out_clock_at_rest(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock falls back within a run, and otherwise rises from row to row, with times that go on (N0734): by an
/// hour, where summer time ends, or by the twelve hours of a clock that has no more, less the time of a touch.
void continue_where_put_back(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock was set anew for runs or setups that stand in it one after the other, with times that go on
/// from one to the next (N0708). Where their rows are mixed, or stand in another order than that of time, nothing is
/// changed.
void continue_from_run_to_run(Recording&, const std::string& file, std::vector<Diagnostic>& messages);
/// A recording whose clock began long before its first touch, or counts down to a later event, with times from the first
/// touch on (N0721).
void count_from_first_touch(Recording&, const std::string& file, std::vector<Diagnostic>& messages);

/// Warns of a clock that falls back once within a run and rises at all other touches (W0728): times as they count in the end.
void doubt_fall(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);

/// Says of runs that follow each other by the clock, but in another order than their numbers, that these count (N0708): a clock
/// of the day may begin earlier on a later day.
void doubt_run_numbers(const Recording&, const std::string& file, std::vector<Diagnostic>& messages);

}  // namespace abbe::diagnose
