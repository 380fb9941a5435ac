// Times of recordings that one machine made one after the other.
#pragma once

#include <optional>
#include <span>

#include "engine/recording/recording.hpp"

namespace abbe {

struct TimeSpan {
  double first_s = 0, last_s = 0;
};

/// First and last time of rows, if any.
std::optional<TimeSpan> time_span(std::span<const RecordingRow> rows);

/// A machine does one thing at a time: where rows ahead were touched during the next ones, the clock was set anew in
/// between. The next ones are counted on then, from a minute after the last one ahead; returns by how much, s.
std::optional<double> continue_clock(std::span<const RecordingRow> ahead, std::span<RecordingRow> next);

}  // namespace abbe
