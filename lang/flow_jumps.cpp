// JUMPTO and its targets.
//
// While all machines are together a jump just says where to go on. Where they may be parted, everything
// between a jump and its target is a *region*: lowered once, with labels at its targets.
#include <fmt/format.h>

#include <algorithm>

#include "lang/flow.hpp"

namespace abbe::lang {

namespace {

/// The name of `(NAME)`, or "".
std::string target_name(const RawStatement& raw) {
  if (raw.arguments.size() != 1) return "";
  std::string_view text = raw.arguments[0].text;
  if (text.size() < 3 || text.front() != '(' || text.back() != ')') return "";
  text = text.substr(1, text.size() - 2);
  const auto first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? "" : std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

}  // namespace

Flow::Step Flow::jump(int at) {
  const Line& line = (*routine_)[at];
  const RawStatement& raw = line.raw;
  const Step nowhere{at + 1, std::nullopt};
  if (!matched(raw)) return nowhere;
  const std::string name = target_name(raw);
  const auto found = routine_->targets.find(upper(name));
  if (name.empty() || found == routine_->targets.end()) {
    std::vector<std::string_view> names;
    for (const auto& [key, target] : routine_->targets) names.push_back(key);
    const std::string near = nearest_word(name, names);
    lowering_.error(name.empty() ? Code::E0106 : Code::E0233, raw.span,
                    name.empty() ? "JUMPTO names no target" : fmt::format("there is no target ({})", name),
                    near.empty() ? "write the target (NAME) alone on a line, and JUMPTO/(NAME)"
                                 : fmt::format("did you mean ({})?", near));
    failed_control();
    return nowhere;
  }
  const int target = found->second;
  if (!routine_->within(at, (*routine_)[target].parent)) {
    lowering_.error(Code::E0234, raw.span,
                    fmt::format("({}) in line {} stands inside a block that this jump is outside of", name,
                                (*routine_)[target].raw.line),
                    "a jump may leave blocks, not enter them");
    failed_control();
    return nowhere;
  }
  if (lowering_.parted == 0) return {at + 1, target};
  const auto active = targets_.find(target);
  if (active == targets_.end()) {
    again_ |= moving_.insert({routine_->file->name(), raw.span.begin}).second;
    ABBE_CHECK(again_);
    lowering_.reachable = false;
    return nowhere;
  }
  store(lowering_, active->second.names);
  if (active->second.passed) check_same_meaning(*active->second.passed);
  lowering_.emit(plan::Jump{active->second.label});
  if (!active->second.passed) active->second.arrivals.push_back(lowering_);
  lowering_.reachable = false;
  return nowhere;
}

/// The lines of the block `level` that moving jumps pass, each from the block that the jump stands in to its
/// target or back.
std::vector<Flow::Interval> Flow::moving_intervals(int level) const {
  std::vector<Interval> intervals;
  const auto at_this_level = [&](const auto& target) { return (*routine_)[target.second].parent == level; };
  if (moving_.empty() || std::none_of(routine_->targets.begin(), routine_->targets.end(), at_this_level))
    return intervals;
  for (const int k : routine_->jumps) {
    const Line& line = (*routine_)[k];
    if (!moving_.count({routine_->file->name(), line.raw.span.begin})) continue;
    const auto target = routine_->targets.find(upper(target_name(line.raw)));
    if (target == routine_->targets.end() || (*routine_)[target->second].parent != level || !routine_->within(k, level))
      continue;
    int top = k;
    while ((*routine_)[top].parent != level) top = (*routine_)[top].parent;
    if ((*routine_)[top].control == Control::otherwise) top = opener_of(top);
    intervals.push_back({std::min(top, target->second), std::max(routine_->end_of(top), target->second)});
  }
  return intervals;
}

/// The region around line `at`: all intervals that hang together with one that holds it; nothing when none does.
std::optional<Flow::Interval> Flow::region_at(int at, const std::vector<Interval>& intervals) {
  std::optional<Interval> region;
  for (const Interval& i : intervals)
    if (i.first <= at && at <= i.last) region = i;
  for (bool grown = region.has_value(); grown;) {
    grown = false;
    for (const Interval& i : intervals) {
      if (i.last < region->first || i.first > region->last || (i.first >= region->first && i.last <= region->last))
        continue;
      region = Interval{std::min(i.first, region->first), std::max(i.last, region->last)};
      grown = true;
    }
  }
  return region;
}

/// The IF that an ELSE belongs to.
int Flow::opener_of(int otherwise) const {
  for (int k = 0; k < routine_->size(); ++k)
    if ((*routine_)[k].partner == otherwise) return k;
  return otherwise;
}

/// Lowers the lines of a region once, for machines that may be anywhere in it. `entry`: where they come in,
/// when not at the top.
void Flow::region(Interval lines, std::optional<int> entry) {
  lowering_.statement = &(*routine_)[lines.first].raw;
  const VariableNames names = assigned(lines.first, lines.last + 1);
  store(lowering_, names);
  forget(lowering_, names);
  const State before = lowering_;
  std::map<int, Target> outside;
  std::swap(outside, targets_);
  targets_ = outside;
  const int level = (*routine_)[lines.first].parent;
  for (const auto& [name, at] : routine_->targets)
    if (at >= lines.first && at <= lines.last && (*routine_)[at].parent == level)
      targets_[at] = {new_label(), names, std::nullopt, {}};
  part();
  ++lowering_.looping;
  if (entry) {
    lowering_.emit(plan::Jump{targets_.at(*entry).label});
    targets_.at(*entry).arrivals.push_back(before);
    lowering_.reachable = false;
  }
  for (int at = lines.first; at <= lines.last;) {
    if (targets_.count(at)) arrive(at, names, before);
    at = lowering_.reachable ? step(at).next : routine_->end_of(at) + 1;
  }
  --lowering_.looping;
  meet();
  if (!lowering_.reachable) static_cast<State&>(lowering_) = before;  // nothing leads out: what follows is never run
  targets_ = std::move(outside);
}

void Flow::arrive(int at, const VariableNames& names, const State& before) {
  Target& target = targets_.at(at);
  lowering_.statement = &(*routine_)[at].raw;
  if (lowering_.reachable) store(lowering_, names);
  for (const State& arrival : target.arrivals) {
    check_measurement(arrival);
    merge(lowering_, arrival);
  }
  if (!lowering_.reachable) static_cast<State&>(lowering_) = before;  // only jumps from below lead here
  forget(lowering_, names);
  carry_settings(lowering_);
  place(target.label);
  target.passed = lowering_;
}

/// What labels meant and settings were when a loop was entered they must still be on its next turn, because the loop is
/// lowered once.
void Flow::check_same_meaning(const State& passed) {
  const auto differs = [&](const auto& then, const auto& now, std::string_view kind, const auto& meaning) {
    now.differences(then, [&](const std::string& name, const auto* is, const auto& was) {
      if (!is || meaning(*is) == meaning(was)) return;
      lowering_.failed = false;
      lowering_.error(
          Code::E0238, lowering_.statement->span,
          fmt::format("{}({}) was something else on the turn before, and machines take different numbers of turns here",
                      kind, name),
          "define it before the loop, or give it another label inside");
      failed_control();
    });
  };
  const auto changed = [&](const auto& then, const auto& now, const std::string& what) {
    if (now.relied_on == then.relied_on || (!now.varies && now.value == then.value)) return;
    lowering_.failed = false;
    lowering_.error(
        Code::E0238, lowering_.statement->span,
        fmt::format("{} was another on the turn before, and machines take different numbers of turns here", what),
        fmt::format("write {} before it is used on each turn", what));
    failed_control();
  };
  changed(passed.mount, lowering_.mount, "SNSMNT");
  changed(passed.machine_chooses, lowering_.machine_chooses, "MODE");
  for (const auto& [shape, criterion] : passed.criteria)
    changed(criterion, lowering_.criteria[shape], fmt::format("GEOALG/{}", feature_kind(shape).word));
  const auto id = [](const auto& v) { return v.value; };
  differs(passed.symbols.features, lowering_.symbols.features, "F", id);
  differs(passed.symbols.datums, lowering_.symbols.datums, "DAT", id);
  differs(passed.symbols.sensors, lowering_.symbols.sensors, "S", id);
  differs(passed.symbols.tolerances, lowering_.symbols.tolerances, "T",
          [](const ToleranceSymbol& t) { return t.instances; });
}

}  // namespace abbe::lang
