#include "engine/recording/clock.hpp"

#include <algorithm>
#include <utility>

namespace abbe {

namespace {

/// First and last time of rows, if any.
std::optional<std::pair<double, double>> time_span(std::span<const RecordingRow> rows) {
  std::optional<std::pair<double, double>> span;
  for (const RecordingRow& row : rows) {
    if (!row.time_s) continue;
    if (!span) span = {*row.time_s, *row.time_s};
    span = {std::min(span->first, *row.time_s), std::max(span->second, *row.time_s)};
  }
  return span;
}

}  // namespace

std::optional<double> continue_clock(std::span<const RecordingRow> ahead, std::span<RecordingRow> next) {
  constexpr double kPause_s = 60;
  const auto past = time_span(ahead), own = time_span(next);
  const auto during_next = [&](const RecordingRow& row) {
    return row.time_s && *row.time_s >= own->first && *row.time_s <= own->second;
  };
  if (!past || !own || std::none_of(ahead.begin(), ahead.end(), during_next)) return std::nullopt;
  const double later_s = past->second + kPause_s - own->first;
  for (RecordingRow& row : next)
    if (row.time_s) *row.time_s += later_s;
  return later_s;
}

}  // namespace abbe
