// Columns of a recording that say less than they seem to: a clock with another beginning, gaps.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <variant>

#include "engine/diagnose/baseline/data_problems.hpp"
#include "engine/recording/columns.hpp"

namespace abbe::diagnose {

namespace {

/// Takes a column out where some rows have it and some do not.
template <class Value>
void leave_out(std::optional<Value> RecordingRow::*column, const std::string& name, Recording& recording,
               const std::string& file, std::vector<Diagnostic>& messages) {
  const auto& rows = recording.rows;
  const auto missing = std::find_if(rows.begin(), rows.end(), [&](const RecordingRow& r) { return !(r.*column); });
  const auto logged = std::count_if(rows.begin(), rows.end(), [&](const RecordingRow& r) { return bool(r.*column); });
  if (missing == rows.end() || logged == 0) return;
  messages.push_back(diagnostic(
      Code::W0722,
      fmt::format("{}: {} is empty in {} of {} rows, first for '{}' touch {}: it is not used", file, name,
                  rows.size() - static_cast<std::size_t>(logged), rows.size(), missing->feature, missing->touch),
      "fill it in, or leave those rows out"));
  for (RecordingRow& row : recording.rows) (row.*column).reset();
}

/// A column that every row has, has no gaps.
template <class Value>
void leave_out(Value RecordingRow::*, const std::string&, Recording&, const std::string&, std::vector<Diagnostic>&) {}

}  // namespace

void leave_out_partly_logged(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  for (const RecordingColumn& column : recording_columns())
    if (column.changes)
      std::visit([&](auto member) { leave_out(member, name(column), recording, file, messages); }, column.member);
}

void count_from_first_touch(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kLate_s = 3600;  // a program that is so long before its first touch has another clock
  std::optional<double> first;
  for (const RecordingRow& row : recording.rows)
    if (row.time_s) first = std::min(first.value_or(*row.time_s), *row.time_s);
  if (!first || *first < kLate_s) return;
  for (RecordingRow& row : recording.rows)
    if (row.time_s) *row.time_s -= *first;
  messages.push_back(diagnostic(
      Code::N0721, fmt::format("{}: its clock stands at {:.0f} s at the first touch", file, *first),
      "times are counted from that touch; what changes since a start, warm-up or drift, is taken to start there"));
}

}  // namespace abbe::diagnose
