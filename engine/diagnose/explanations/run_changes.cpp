#include "engine/diagnose/explanations/run_changes.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/explanations/value_called.hpp"

namespace abbe::diagnose {

namespace {

/// Stretches of runs that are told apart at first; where the recording speaks for one, it is divided (refine.cpp).
constexpr std::size_t kMostChanges = 8, kMostGone = 4, kMostBetween = 3;
/// Runs in the middle of which each may be the only bad one, as a day of a week.
constexpr std::size_t kMostSingle = 8;

/// Of several files, how long the longest takes of the whole; nothing of one.
std::optional<double> share_of_longest_file(const RecordedTouches& t, const std::vector<int>& rows) {
  std::map<int, Cell> spans_s;
  for (const int i : rows) {
    const double now_s = t.touches[i].scene.time_s;
    spans_s.try_emplace(t.touches[i].file, Cell{now_s, now_s}).first->second.high = now_s;
  }
  if (spans_s.size() < 2) return {};
  double longest_s = 0;
  for (const auto& [file, span_s] : spans_s) longest_s = std::max(longest_s, span_s.high - span_s.low);
  return longest_s / lasts_s(t);
}

/// One of several files by the runs that it has, and no other file.
struct FileOfRuns {
  RunChange only;  ///< what acts in it alone
  Cell runs;       ///< the run that this begins or ends with
};

/// Nothing where files share runs, or where there are more of them than days are told apart by.
std::vector<FileOfRuns> files_of_runs(const RecordedTouches& t, const std::vector<int>& rows) {
  constexpr std::size_t kMost = 8;
  std::map<int, std::pair<int, int>> runs_of;  // by file: the first and the last
  for (const int i : rows) {
    const int run = t.touches[i].scene.run;
    auto& [first, last] = runs_of.try_emplace(t.touches[i].file, run, run).first->second;
    first = std::min(first, run), last = std::max(last, run);
  }
  std::vector<std::pair<int, int>> runs;
  for (const auto& [file, of_file] : runs_of) runs.push_back(of_file);
  std::sort(runs.begin(), runs.end());
  const auto shared = [](const auto& a, const auto& b) { return b.first <= a.second; };
  if (runs.size() < 2 || runs.size() > kMost || std::adjacent_find(runs.begin(), runs.end(), shared) != runs.end())
    return {};
  const std::vector<LaterRun> later = later_runs(t, rows);
  std::vector<FileOfRuns> out;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunChange only{k > 0 ? runs[k].first : 0, k + 1 < runs.size() ? runs[k + 1].first : 0, true};
    const auto at =
        std::find_if(later.begin(), later.end(), [&](const LaterRun& run) { return run.from_run == only.first(); });
    out.push_back({only, at->runs});
  }
  return out;
}

/// Whether it is as it was at the qualification, and shows at other speeds only: this is not new in any run.
bool is_as_qualified(const Effect& effect, const Variant& variant) {
  const auto speed = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                  [](const EffectParameter& p) { return p.sought == Sought::speed; });
  return speed != effect.parameters.end() && variant.theta[speed - effect.parameters.begin()] > 0;
}

}  // namespace

std::vector<LaterRun> later_runs(const RecordedTouches& t, const std::vector<int>& rows) {
  const auto scene = [&](int row) -> const TouchScene& { return t.touches[row].scene; };
  std::map<int, Cell> begin;
  double before = scene(rows.front()).time_s;
  for (const int i : rows) {
    const double now = scene(i).time_s, last = std::exchange(before, now);
    begin.emplace(scene(i).run, Cell{std::min(last, now), std::max(last, now)});
  }
  begin.erase(begin.begin());
  std::vector<LaterRun> out;
  for (const auto& [run, gap_s] : begin) out.push_back({run, {double(out.size()), double(out.size() + 1)}, gap_s});
  return out;
}

std::vector<LaterRun> in_stretches(const std::vector<LaterRun>& single, std::size_t most) {
  const std::size_t count = std::min(most, single.size());
  std::vector<LaterRun> out;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = k * single.size() / count, last = (k + 1) * single.size() / count - 1;
    out.push_back(single[(first + last) / 2]);
    out.back().runs = {single[first].runs.low, single[last].runs.high};
  }
  return out;
}

std::vector<Variant> with_beginnings(std::vector<Variant> list, const Effect& effect, const RecordedTouches& t,
                                     const std::vector<int>& rows) {
  const auto settles = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                    [](const EffectParameter& p) { return p.sought == Sought::time_constant; });
  const std::optional<double> share_of_longest = share_of_longest_file(t, rows);
  if (!share_of_longest || settles == effect.parameters.end()) return list;
  const auto constant = static_cast<std::size_t>(settles - effect.parameters.begin());
  const std::vector<FileOfRuns> files = files_of_runs(t, rows);
  for (std::size_t k = 0, once = list.size(); k < once; ++k) {
    Variant anew = list[k];
    anew.change.in_each_file = true;
    anew.theta[constant] *= *share_of_longest;
    anew.cells[constant].low *= *share_of_longest, anew.cells[constant].high *= *share_of_longest;
    list.push_back(anew);
    for (const FileOfRuns& file : files) {
      anew.change = file.only, anew.runs = file.runs;
      list.push_back(anew);
    }
  }
  return list;
}

std::vector<Variant> with_changes(std::vector<Variant> list, const Effect& effect, const std::vector<LaterRun>& later) {
  const std::optional<std::size_t> moment = moment_of(effect);
  const bool goes_on = !moment && (effect.needs & static_cast<unsigned>(Covariate::time));
  if (goes_on || (effect.draws > 0 && effect.draws_per == DrawsPer::visit)) return list;
  const std::vector<Variant> in_all = list;
  const auto add = [&](const LaterRun& at, RunChange change) {
    for (Variant variant : in_all) {
      if (moment && variant.theta[*moment] != in_all.front().theta[*moment]) continue;
      if (is_as_qualified(effect, variant)) continue;
      if (moment) variant.theta[*moment] = at.between_s(), variant.cells[*moment] = at.gap_s;
      variant.change = change;
      variant.runs = at.runs;
      list.push_back(std::move(variant));
    }
  };
  for (const LaterRun& at : in_stretches(later, kMostChanges)) add(at, {.from = at.from_run});
  for (const LaterRun& at : in_stretches(later, moment ? 0 : kMostGone)) add(at, {.until = at.from_run});
  const std::vector<LaterRun> ends = in_stretches(later, kMostBetween);
  std::set<std::pair<int, int>> between;
  const auto came_and_went = [&](const LaterRun& from, const LaterRun& until) {
    if (between.emplace(from.from_run, until.from_run).second) add(from, {from.from_run, until.from_run});
  };
  for (std::size_t k = 0; k < ends.size(); ++k)
    for (std::size_t j = k + 1; j < ends.size(); ++j) came_and_went(ends[k], ends[j]);
  for (std::size_t k = 0; k + 1 < later.size() && later.size() < kMostSingle; ++k)
    came_and_went(later[k], later[k + 1]);
  if (!moment) return list;
  for (Variant variant : in_all) {
    if (!counts(effect, effect.parameters[*moment], variant.theta)) continue;
    const auto next = std::find_if(later.begin(), later.end(),
                                   [&](const LaterRun& run) { return run.gap_s.low >= variant.theta[*moment]; });
    if (next == later.end()) continue;
    Cell& cell = variant.cells[*moment];
    cell.high = std::min(cell.high, next->gap_s.low);
    variant.change.until = next->from_run;
    variant.runs = next->runs;
    list.push_back(std::move(variant));
  }
  return list;
}

}  // namespace abbe::diagnose
