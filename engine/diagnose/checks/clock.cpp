#include "engine/diagnose/checks/clock.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/recording/clock.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kHour_s = 3600;

template <class Rows>
auto with_a_time(Rows& rows) {
  std::vector<decltype(rows.data())> out;
  for (auto& row : rows)
    if (row.time_s) out.push_back(&row);
  return out;
}

bool is_earlier(const RecordingRow* a, const RecordingRow* b) { return *a->time_s < *b->time_s; }

}  // namespace

void continue_past_midnight(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kDay_s = 24 * kHour_s;
  const std::vector<RecordingRow*> timed = with_a_time(recording.rows);
  const auto fall = std::adjacent_find(timed.begin(), timed.end(), [](const RecordingRow* a, const RecordingRow* b) {
    return *b->time_s < *a->time_s - kDay_s / 2;
  });
  if (fall == timed.end()) return;
  const auto morning = fall + 1;
  const double last = *(*std::max_element(timed.begin(), timed.end(), is_earlier))->time_s,
               evening = *(*std::min_element(timed.begin(), morning, is_earlier))->time_s,
               end = *(*std::max_element(morning, timed.end(), is_earlier))->time_s;
  if (last > kDay_s || end > evening - kDay_s / 2) return;
  messages.push_back(diagnostic(
      Code::N0727,
      fmt::format("{}: its clock falls from {:.0f} s to {:.0f} s", file_of(recording, **morning, file),
                  *(*fall)->time_s, *(*morning)->time_s),
      "times after midnight count on; if the part was measured on another day, write true times into time_s"));
  std::for_each(morning, timed.end(), [](RecordingRow* row) { *row->time_s += kDay_s; });
}

void leave_out_clock_at_rest(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr std::size_t kFew = 3;
  std::map<int, std::vector<RecordingRow*>> by_file;
  for (RecordingRow* row : with_a_time(recording.rows)) by_file[row->file].push_back(row);
  for (const auto& [number, rows] : by_file) {
    const RecordingRow& first = *rows.front();
    const auto moves = [&](const RecordingRow* row) { return *row->time_s != *first.time_s; };
    if (rows.size() < kFew || std::any_of(rows.begin(), rows.end(), moves)) continue;
    messages.push_back(diagnostic(Code::W0738,
                                  fmt::format("{}: its clock stands at {:g} s at all touches; it is not used",
                                              file_of(recording, first, file), *first.time_s),
                                  "write the time of each touch into time_s, or leave the column out"));
    for (RecordingRow* row : rows) row->time_s.reset();
  }
}

void continue_where_put_back(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  const struct {
    double by_s;
    const char* where;
  } hands[] = {{kHour_s, "where summer time ends"}, {12 * kHour_s, "on a clock of twelve hours"}};
  const std::vector<RecordingRow*> rows = with_a_time(recording.rows);
  std::vector<std::size_t> falls;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (is_earlier(rows[i], rows[i - 1])) falls.push_back(i);
  if (falls.size() != 1) return;
  const RecordingRow &before = *rows[falls.front() - 1], &after = *rows[falls.front()];
  if (before.run != after.run || before.setup != after.setup) return;
  double longest_s = 0;  // from a touch to the next; one that goes ahead and falls back at once is a single wrong time
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (i + 1 != falls.front()) longest_s = std::max(longest_s, *rows[i]->time_s - *rows[i - 1]->time_s);
  for (const auto& [by_s, where] : hands) {
    const double passed_s = *after.time_s + by_s - *before.time_s;
    if (passed_s < 0 || passed_s > longest_s) continue;
    messages.push_back(diagnostic(
        Code::N0734,
        fmt::format("{}: its clock falls from {:.0f} s to {:.0f} s within a run, as it does {}",
                    file_of(recording, after, file), *before.time_s, *after.time_s, where),
        "later times count on; if the rows do not stand in the order of the touches, write true times into time_s"));
    for (std::size_t i = falls.front(); i < rows.size(); ++i) *rows[i]->time_s += by_s;
    return;
  }
}

void continue_from_run_to_run(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  const auto unlike = [](const RecordingRow& a, const RecordingRow& b) { return a.run != b.run || a.setup != b.setup; };
  std::vector<RecordingRow>& rows = recording.rows;
  std::vector<std::size_t> begins;
  std::set<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || unlike(rows[i - 1], rows[i])) {
      if (!seen.emplace(rows[i].setup, rows[i].run).second) return;
      begins.push_back(i);
    } else if (rows[i].time_s && rows[i - 1].time_s && *rows[i].time_s < *rows[i - 1].time_s) {
      return;
    }
  }
  begins.push_back(rows.size());
  int anew = 0;
  for (std::size_t k = 1; k + 1 < begins.size(); ++k) {
    const std::span all(rows);
    if (continue_clock(all.first(begins[k]), all.subspan(begins[k], begins[k + 1] - begins[k]))) ++anew;
  }
  if (anew == 0) return;
  messages.push_back(diagnostic(
      Code::N0708,
      fmt::format("{}: its clock was set back at the beginning of {} of {} runs; their times count on", file, anew,
                  begins.size() - 1),
      "each is taken to begin a minute after the touches ahead of it: if there was a longer pause, write true times into time_s"));
}

void count_from_first_touch(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kLate_s = kHour_s;  // a program that is so long before its first touch has another clock
  const std::vector<RecordingRow*> rows = with_a_time(recording.rows);
  if (rows.empty()) return;
  const double first_s = *(*std::min_element(rows.begin(), rows.end(), is_earlier))->time_s;
  if (first_s >= 0 && first_s < kLate_s) return;
  for (RecordingRow* row : rows) *row->time_s -= first_s;
  messages.push_back(diagnostic(
      Code::N0721, fmt::format("{}: its clock stands at {:.0f} s at the first touch", file, first_s),
      "times are counted from that touch; what changes since a start, warm-up or drift, is taken to start there"));
}

void doubt_fall(const Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr std::size_t kFew = 10;
  const std::vector<const RecordingRow*> rows = with_a_time(recording.rows);
  const auto falls = [](const RecordingRow* a, const RecordingRow* b) {
    return a->run == b->run && a->setup == b->setup && is_earlier(b, a);
  };
  const auto fall = std::adjacent_find(rows.begin(), rows.end(), falls);
  if (rows.size() < kFew || fall == rows.end() || std::adjacent_find(fall + 1, rows.end(), falls) != rows.end()) return;
  const RecordingRow &before = **fall, &after = **(fall + 1);
  messages.push_back(diagnostic(
      Code::W0728,
      fmt::format("{}: its clock falls from {:g} s to {:g} s before '{}' touch {}, and nowhere else",
                  file_of(recording, after, file), *before.time_s, *after.time_s, after.feature, after.touch),
      "times count as they are: if a time is wrong, correct it; if rows do not stand in the order of the touches, all is well"));
}

void doubt_run_numbers(const Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  std::map<int, std::pair<double, double>> lasted_s;  // by run: the first and the last touch
  for (const RecordingRow& row : recording.rows) {
    if (!row.time_s) return;
    auto& [first_s, last_s] = lasted_s.try_emplace(row.run, *row.time_s, *row.time_s).first->second;
    first_s = std::min(first_s, *row.time_s), last_s = std::max(last_s, *row.time_s);
  }
  std::vector<int> by_clock;
  for (const auto& [run, lasted] : lasted_s) by_clock.push_back(run);
  std::sort(by_clock.begin(), by_clock.end(), [&](int a, int b) { return lasted_s[a] < lasted_s[b]; });
  const auto overlap = [&](int a, int b) { return lasted_s[a].second >= lasted_s[b].first; };
  if (std::is_sorted(by_clock.begin(), by_clock.end()) ||
      std::adjacent_find(by_clock.begin(), by_clock.end(), overlap) != by_clock.end())
    return;
  messages.push_back(diagnostic(
      Code::N0708,
      fmt::format(
          "{}: by the clock its runs were made in the order {}; what is new in a run, or gone, goes by their numbers",
          file, fmt::join(by_clock, ", ")),
      "number runs in the order in which they were made; if the clock is that of the day, write times that go on from day to day"));
}

}  // namespace abbe::diagnose
