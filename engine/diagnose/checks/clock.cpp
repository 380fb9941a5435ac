#include "engine/diagnose/checks/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace abbe::diagnose {

void continue_past_midnight(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kDay_s = 86400;
  std::vector<double*> times;
  for (RecordingRow& row : recording.rows)
    if (row.time_s) times.push_back(&*row.time_s);
  const auto earlier = [](const double* a, const double* b) { return *a < *b; };
  const auto fall = std::adjacent_find(times.begin(), times.end(),
                                       [](const double* a, const double* b) { return *b < *a - kDay_s / 2; });
  if (fall == times.end()) return;
  const auto morning = fall + 1;
  const double last = **std::max_element(times.begin(), times.end(), earlier),
               evening = **std::min_element(times.begin(), morning, earlier),
               end = **std::max_element(morning, times.end(), earlier);
  if (last > kDay_s || end > evening - kDay_s / 2) return;
  std::for_each(morning, times.end(), [](double* t) { *t += kDay_s; });
  messages.push_back(diagnostic(
      Code::N0727, fmt::format("{}: its clock falls from {:.0f} s to {:.0f} s", file, **fall, **morning),
      "times after midnight count on; if the part was measured on another day, write true times into time_s"));
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
