#include "programs/commands/joined_recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string_view>
#include <tuple>

#include "engine/base/letter_case.hpp"
#include "engine/recording/clock.hpp"
#include "engine/recording/copies.hpp"
#include "programs/commands/recorded_values.hpp"

namespace abbe {

namespace {

/// What was changed in several files alike is told once, of the first of them.
class ToldOnce {
 public:
  void add(const std::string& file, std::string change) {
    if (files_++ == 0) file_ = file, change_ = std::move(change);
  }

  /// `help`: the next step.
  void tell(const char* help, std::vector<Diagnostic>& messages) const {
    if (files_ == 0) return;
    const std::string others = files_ == 1 ? ""
        : files_ == 2                      ? "; so it is with 1 file more"
                                           : fmt::format("; so it is with {} files more", files_ - 1);
    messages.push_back(diagnostic(Code::N0708, fmt::format("{}: {}{}", file_, change_, others), help));
  }

 private:
  std::size_t files_ = 0;
  std::string file_, change_;
};

/// Two files may each have a clock of their own.
void continue_clock_of(const Recording& before, Recording& next, const std::string& file, ToldOnce& told) {
  if (const std::optional<double> later_s = continue_clock(before.rows, next.rows))
    told.add(
        file,
        fmt::format("its times overlap those of the recording ahead of it; they count as {:.0f} s later", *later_s));
}

/// The order in which files were measured, and what tells it.
struct Order {
  std::vector<std::size_t> files;
  std::string told_by = {};  ///< where it is not that which was given
};

Order given_order(std::size_t files) {
  Order out{std::vector<std::size_t>(files)};
  std::iota(out.files.begin(), out.files.end(), 0);
  return out;
}

/// By the lowest numbers of their runs, where each has runs of its own.
Order order_of_runs(const std::vector<Recording>& files) {
  std::vector<std::pair<int, int>> runs;
  for (const Recording& file : files) {
    if (file.rows.empty()) return given_order(files.size());  // all of it stands in other files too
    const auto [first, last] = std::minmax_element(
        file.rows.begin(), file.rows.end(), [](const RecordingRow& a, const RecordingRow& b) { return a.run < b.run; });
    runs.emplace_back(first->run, last->run);
  }
  Order out = given_order(files.size());
  std::sort(out.files.begin(), out.files.end(), [&](std::size_t a, std::size_t b) { return runs[a] < runs[b]; });
  for (std::size_t k = 1; k < out.files.size(); ++k)
    if (runs[out.files[k]].first <= runs[out.files[k - 1]].second) return given_order(files.size());
  out.told_by = "the numbers of their runs";
  return out;
}

/// Whoever names files by a pattern has the tenth day ahead of the second, and 'after' ahead of 'before'. Where no clock begins
/// anew, the clocks tell their order, else the runs; a clock that falls by more than half a day within one has passed midnight,
/// and the order is that which was given.
Order order_of(const std::vector<Recording>& files) {
  constexpr double kDay_s = 24 * 3600;
  std::vector<TimeSpan> spans;
  for (const Recording& file : files) {
    const std::optional<TimeSpan> span = time_span(file.rows);
    if (!span) return order_of_runs(files);
    spans.push_back(*span);
  }
  Order out = given_order(files.size());
  std::vector<std::size_t>& order = out.files;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return spans[a].first_s < spans[b].first_s; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (spans[order[k]].first_s <= spans[order[k - 1]].last_s) return order_of_runs(files);
  bool past_midnight = false;
  for (std::size_t k = 1; k < spans.size(); ++k)
    past_midnight = past_midnight || spans[k].first_s < spans[k - 1].last_s - kDay_s / 2;
  const bool within_a_day = spans[order.back()].last_s - spans[order.front()].first_s <= kDay_s;
  if (past_midnight && within_a_day) return given_order(files.size());
  out.told_by = "their clocks";
  return out;
}

/// A number that counts on from those of the files ahead of it.
int counted_on(int ahead, int number, std::string_view column, const std::string& file) {
  constexpr long long kMost = 2'000'000'000;  // a second measurement, too, counts on from here
  const long long sum = static_cast<long long>(ahead) + number;
  if (sum <= kMost) return static_cast<int>(sum);
  throw UserError(diagnostic(
      Code::E0707,
      fmt::format(
          "'{}': its numbers in the column '{}' count on from those of the files ahead of it, and are too large for that",
          file, column),
      "number from 1, all files in one sequence"));
}

/// Whoever forgets to number the repeats has the same run in every file. The same touch with another value is
/// a further run, else the machine would seem to have changed in the middle of one.
void continue_runs(const Recording& before, Recording& next, const std::string& file, ToldOnce& told) {
  const auto named = [](const RecordingRow& row) { return std::tie(row.feature, row.touch, row.setup, row.run); };
  std::map<std::tuple<std::string, int, int, int>, Vec3> touched;
  for (const RecordingRow& row : before.rows) touched.emplace(named(row), row.position_mm);
  const bool again = std::any_of(next.rows.begin(), next.rows.end(), [&](const RecordingRow& row) {
    const auto found = touched.find(named(row));
    return found != touched.end() && !(found->second == row.position_mm);
  });
  if (!again) return;
  const auto in_run_order = [](const RecordingRow& a, const RecordingRow& b) { return a.run < b.run; };
  const int last = std::max_element(before.rows.begin(), before.rows.end(), in_run_order)->run;
  const int first = std::min_element(next.rows.begin(), next.rows.end(), in_run_order)->run;
  for (RecordingRow& row : next.rows) row.run = counted_on(last + 1 - first, row.run, "run", file);
  told.add(file,
           fmt::format("it repeats touches of the recording ahead of it under the same run; its runs are counted on: "
                       "run {} counts as {}",
                       first, last + 1));
}

/// Between two files the styli may have been qualified anew, unless all say by the column `qualification` that they were
/// not.
void doubt_qualifications(std::vector<Recording>& files, const std::vector<SourceFile>& sources) {
  const auto unsaid = [](const RecordingRow& row) { return !row.qualification; };
  const auto says = [&](const Recording& r) { return std::none_of(r.rows.begin(), r.rows.end(), unsaid); };
  if (files.size() < 2 || std::all_of(files.begin(), files.end(), says)) return;
  int before = 0;
  for (std::size_t k = 0; k < files.size(); ++k) {
    int last = before;
    for (RecordingRow& row : files[k].rows) {
      row.qualification = counted_on(before, row.qualification.value_or(1), "qualification", sources[k].name());
      last = std::max(last, *row.qualification);
    }
    before = last;
  }
}

bool is_copy(const RecordingRow& a, const RecordingRow& b) {
  return a.feature == b.feature && a.touch == b.touch && a.setup == b.setup && a.run == b.run &&
      a.position_mm == b.position_mm && a.time_s == b.time_s;
}

bool same_rows(const Recording& before, const Recording& next) {
  return std::search(before.rows.begin(), before.rows.end(), next.rows.begin(), next.rows.end(), is_copy) !=
      before.rows.end();
}

/// What was exported with one file and again with the next was measured once. Before clocks are continued: at another time
/// it would be a repeat.
void leave_out_copies(const std::vector<Recording>& before, Recording& next, const std::string& file,
                      std::vector<Diagnostic>& messages) {
  const auto named = [](const RecordingRow& row) { return std::tie(row.feature, row.touch, row.setup, row.run); };
  std::multimap<std::tuple<std::string, int, int, int>, const RecordingRow*> touched;
  for (const Recording& one : before)
    for (const RecordingRow& row : one.rows) touched.emplace(named(row), &row);
  const std::size_t copies = std::erase_if(next.rows, [&](const RecordingRow& row) {
    const auto [first, last] = touched.equal_range(named(row));
    const bool planned = row.target_mm == row.position_mm;
    return !planned && std::any_of(first, last, [&](const auto& seen) { return is_copy(*seen.second, row); });
  });
  if (copies > 0)
    messages.push_back(
        diagnostic(Code::W0702,
                   fmt::format("{}: {} of its rows stand in the files ahead of it too; they count once", file, copies),
                   "give each touch once"));
}

/// Whether nearly all touches of the shorter recording stand in the longer one, under whatever setup and run.
bool same_positions(const Recording& before, const Recording& next) {
  std::vector<const RecordingRow*> rows;
  std::vector<int> file;
  for (const RecordingRow& row : before.rows) rows.push_back(&row), file.push_back(0);
  for (const RecordingRow& row : next.rows) rows.push_back(&row), file.push_back(1);
  return copied_group(rows, file).has_value();
}

/// A file given twice is no repeat: nothing was measured again.
void refuse_copy(const Recording& before, const std::string& name, const Recording& next, const std::string& copy) {
  const char* const help = "give each recording once; a repeat has other values, and another 'run'";
  if (same_rows(before, next))
    throw UserError(diagnostic(Code::E0713, fmt::format("'{}' holds the same touches as '{}'", copy, name), help));
  if (same_positions(before, next))
    throw UserError(diagnostic(Code::E0713,
                               fmt::format("'{}' holds the same touches as '{}', to the last digit of their positions, "
                                           "under another setup or run: rows were copied",
                                           copy, name),
                               help));
}

/// Files may spell one machine file differently. Where it is not here, its spelling is all that is known of it.
bool same_machine(const std::string& one, const std::string& file, const std::string& other,
                  const std::string& other_file) {
  const auto name = name_of_recorded_machine(one, {file}), other_name = name_of_recorded_machine(other, {other_file});
  return name && other_name ? *name == *other_name : one == other;
}

/// Recordings of one machine belong together.
void doubt_machine(const Recording& first, const std::string& name, const Recording& next, const std::string& file,
                   std::vector<Diagnostic>& messages) {
  const auto one = said(first.metadata, "machine"), other = said(next.metadata, "machine");
  if (one && other && !same_machine(*one, name, *other, file))
    messages.push_back(diagnostic(
        Code::W0714,
        fmt::format("'{}' is of machine '{}', '{}' of '{}'; they are judged as one machine", name, *one, file, *other),
        "judge each machine by its own recordings"));
}

/// Files that are one recording have positions of one kind.
void refuse_unlike(const Recording& first, const std::string& name, const Recording& next, const std::string& file) {
  if (next.in_part_frame != first.in_part_frame || next.point != first.point)
    throw UserError(diagnostic(Code::E0707, fmt::format("'{}' and '{}' have different frames or points", name, file),
                               "the lines '# frame:' and '# point:' must say the same in all files"));
  const auto surfaces = said(first.metadata, "surfaces"), others = said(next.metadata, "surfaces");
  if (surfaces && others && *surfaces != *others)
    throw UserError(diagnostic(
        Code::E0707, fmt::format("'# surfaces:' says {} in '{}' and {} in '{}'", *surfaces, name, *others, file),
        "judge them one by one, or say of both what holds for both"));
}

}  // namespace

Recording joined(const std::vector<SourceFile>& files, Positions positions, std::vector<Diagnostic>& messages) {
  std::vector<Recording> read;
  std::map<std::string, std::string> as_met_first;  // labels are the same whatever their case
  for (const SourceFile& file : files) {
    Recording next = read_recording(file, positions);
    messages.insert(messages.end(), next.messages.begin(), next.messages.end());
    for (RecordingRow& row : next.rows) {
      row.file = static_cast<int>(read.size());
      row.feature = as_met_first.emplace(upper(row.feature), row.feature).first->second;
    }
    if (!read.empty()) refuse_unlike(read.front(), files.front().name(), next, file.name());
    for (std::size_t k = 0; k < read.size(); ++k) refuse_copy(read[k], files[k].name(), next, file.name());
    leave_out_copies(read, next, file.name(), messages);
    read.push_back(std::move(next));
  }
  doubt_qualifications(read, files);
  const auto [order, told_by] = order_of(read);
  if (!std::is_sorted(order.begin(), order.end()))
    messages.push_back(diagnostic(
        Code::N0708,
        fmt::format("by {0} the files are given in another order than they were measured in; they count in that of {0}",
                    told_by),
        "if they were measured in the order given, write true times into time_s, and number the runs by them"));
  const std::string& first = files[order.front()].name();
  Recording all = std::move(read[order.front()]);
  for (const SourceFile& file : files) all.files.push_back(file.name());
  ToldOnce later, further_runs;
  for (std::size_t k = 1; k < files.size(); ++k) {
    const std::string& name = files[order[k]].name();
    Recording& one = read[order[k]];
    doubt_machine(all, first, one, name, messages);
    continue_clock_of(all, one, name, later);
    continue_runs(all, one, name, further_runs);
    all.rows.insert(all.rows.end(), one.rows.begin(), one.rows.end());
    // new styli; of what is said twice the first counts
    all.metadata.insert(all.metadata.end(), one.metadata.begin(), one.metadata.end());
  }
  later.tell("if they were measured at another time, write their true times into time_s", messages);
  further_runs.tell("give every repeat its own number in the column 'run'", messages);
  return all;
}

}  // namespace abbe
