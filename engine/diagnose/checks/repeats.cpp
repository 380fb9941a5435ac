#include "engine/diagnose/checks/repeats.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace abbe::diagnose {

namespace {

bool same_touch(const RecordingRow* a, const RecordingRow* b) {
  return a->feature == b->feature && a->touch == b->touch && a->sensor == b->sensor;
}

/// Not the same row once more: it was made at another time or, where no time is known, gave another position.
bool made_anew(const RecordingRow* a, const RecordingRow* b) {
  return a->time_s != b->time_s || (!a->time_s && !(a->position_mm == b->position_mm));
}

/// After how many rows the first touch comes again, if all of them do so once at least, in their order; else all of the rows.
std::size_t rows_of_one_time(const std::vector<RecordingRow*>& rows) {
  constexpr std::size_t kFew = 5;
  const auto again = std::find_if(rows.begin() + 1, rows.end(),
                                  [&](const RecordingRow* row) { return same_touch(row, rows.front()); });
  const auto count = static_cast<std::size_t>(again - rows.begin());
  if (count < kFew || rows.size() < 2 * count || !std::equal(again, rows.end(), rows.begin(), same_touch))
    return rows.size();
  std::size_t anew = 0;  // two decimals repeat by themselves now and then
  for (std::size_t k = count; k < rows.size(); ++k) anew += made_anew(rows[k], rows[k % count]) ? 1 : 0;
  return 2 * anew >= rows.size() - count ? count : rows.size();
}

}  // namespace

void number_repeats(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  if (recording.rows.empty()) return;
  std::map<std::pair<int, int>, std::vector<RecordingRow*>> runs;  // by setup and run
  for (RecordingRow& row : recording.rows) runs[{row.setup, row.run}].push_back(&row);
  std::map<std::pair<int, std::size_t>, int> numbers;  // by run, and how many times it was made before
  for (const auto& [of, rows] : runs)
    for (std::size_t k = 0, count = rows_of_one_time(rows); k < rows.size(); k += count)
      numbers[{of.second, k / count}] = of.second;
  int last = numbers.begin()->second - 1, repeated = 0;
  std::vector<int> count_as;  // the repeats of the first run that has any
  for (auto& [run, number] : numbers) {
    last = number = std::max(last + 1, run.first);
    if (run.second == 1 && count_as.empty()) repeated = run.first;
    if (run.second > 0 && run.first == repeated) count_as.push_back(number);
  }
  if (count_as.empty()) return;
  for (const auto& [of, rows] : runs) {
    const std::size_t count = rows_of_one_time(rows);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k]->run = numbers[{of.second, k / count}];
  }
  messages.push_back(diagnostic(
      Code::N0708,
      fmt::format("{}: run {} holds the same touches {}, in the same order; {}", file, repeated,
                  count_as.size() == 1 ? "twice" : fmt::format("{} times", count_as.size() + 1),
                  count_as.size() == 1 ? fmt::format("the second time counts as run {}", count_as.front())
                                       : fmt::format("the later ones count as runs {}", fmt::join(count_as, ", "))),
      "give each repeat a 'run' of its own"));
}

}  // namespace abbe::diagnose
