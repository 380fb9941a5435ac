#include "engine/recording/clock.hpp"

#include <algorithm>

namespace abbe {

std::optional<TimeSpan> time_span(std::span<const RecordingRow> rows) {
  std::optional<TimeSpan> span;
  for (const RecordingRow& row : rows) {
    if (!row.time_s) continue;
    if (!span) span = {*row.time_s, *row.time_s};
    span = {std::min(span->first_s, *row.time_s), std::max(span->last_s, *row.time_s)};
  }
  return span;
}

std::optional<double> continue_clock(std::span<const RecordingRow> ahead, std::span<RecordingRow> next) {
  constexpr double kPause_s = 60;
  const auto past = time_span(ahead), own = time_span(next);
  const auto during_next = [&](const RecordingRow& row) {
    return row.time_s && *row.time_s >= own->first_s && *row.time_s <= own->last_s;
  };
  if (!past || !own || std::none_of(ahead.begin(), ahead.end(), during_next)) return std::nullopt;
  const double later_s = past->last_s + kPause_s - own->first_s;
  for (RecordingRow& row : next)
    if (row.time_s) *row.time_s += later_s;
  return later_s;
}

}  // namespace abbe
