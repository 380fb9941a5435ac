// IF, DO and SELECT.
#include <fmt/format.h>

#include <cmath>

#include "lang/flow.hpp"

namespace abbe::lang {

using plan::Op2;

/// Lowers both branches for machines that part at `condition`. `begin` to `end`: the lines of both.
void Flow::branch(int begin, int end, plan::Expression condition, const Body& then, const Body& otherwise) {
  const RawStatement* statement = lowering_.statement;
  const VariableNames names = assigned(begin, end);
  store(lowering_, names);
  const int other = new_label(), meeting = new_label();
  lowering_.emit(plan::JumpUnless{std::move(condition), other});
  part();
  const State before = lowering_;
  const auto path = [&](const Body& body) {
    body();
    lowering_.statement = statement;
    if (lowering_.reachable) store(lowering_, names);
  };
  path(then);
  if (lowering_.reachable) lowering_.emit(plan::Jump{meeting});
  const State after_then = lowering_;
  static_cast<State&>(lowering_) = before;
  place(other);
  path(otherwise);
  place(meeting);
  meet();
  check_measurement(after_then);
  merge(lowering_, after_then);
}

/// A measurement begins and ends on the same path.
void Flow::check_measurement(const State& other) {
  if (!other.reachable || !lowering_.reachable) return;
  const auto& mine = lowering_.measuring;
  const auto& theirs = other.measuring;
  const bool same =
      mine.has_value() == theirs.has_value() && (!mine || mine->first_operation == theirs->first_operation);
  if (same) return;
  const OpenMeasure& open = mine ? *mine : *theirs;
  lowering_.failed = false;
  lowering_.error(Code::E0239, open.span, "this measurement is open on one path only where two paths meet",
                  "write MEAS and ENDMES on the same path");
  failed_control();
  lowering_.measuring.reset();
}

/// The block from line `at` to `end` is left out.
Flow::Step Flow::lost(int at, int end) {
  lose(at + 1, end);
  return {end + 1, std::nullopt};
}

Flow::Step Flow::condition(int at) {
  const Line& line = (*routine_)[at];
  const int end = routine_->end_of(at);
  const auto match = matched(line.raw);
  if (!match) return lost(at, end);
  const Value condition = *match->find("condition")->value;
  const int other = line.partner;
  const Body then = [&, other] { return range(at + 1, other, at); };
  const Body otherwise = [&, other] { return other == end ? Jump{} : range(other + 1, end, other); };
  if (condition.known()) return {end + 1, condition.constant() != 0 ? then() : otherwise()};
  branch(at + 1, end, condition.parts[0], then, otherwise);
  return {end + 1, std::nullopt};
}

namespace {

/// A turn n of DO, counted from 0, has the variable at first + n step. It is run while n <= (limit - first) / step; this is
/// added to the right, because 0.1 three times is not 0.3.
constexpr double kTurnSlack = 1e-9;

plan::Expression fixed_number(double v) { return {plan::PushConstant{v}}; }
plan::Expression number_in(plan::ColumnId id) { return {plan::PushColumn{id}}; }

bool is_whole(const MatchedValue& v) {
  return v.column.valid() ? v.value->type == Type::integer : v.number == std::floor(v.number);
}

Value number_of(const MatchedValue& v, const Value& known) {
  return v.column.valid() ? Value{Type::real, {{plan::PushColumn{v.column}}}} : known;
}

}  // namespace

Flow::Step Flow::loop(int at) {
  const Line& line = (*routine_)[at];
  const int end = line.partner;
  const auto match = matched(line.raw);
  if (!match) return lost(at, end);
  const std::string variable = match->text("variable");
  const MatchedValue *first = match->find("first"), *limit = match->find("limit"), *step = match->find("step");
  if (!find_variable(lowering_, variable)) {
    const bool counts = is_whole(*first) && (!step || is_whole(*step));
    declare(lowering_, variable, counts ? Type::integer : Type::real, 0, 0, false);
  }
  const double by = step ? step->number : 1;
  if (by == 0 && !(step && step->column.valid())) {
    lowering_.error(Code::E0242, step->span, "a DO with a step of 0 never ends", "leave the step out for 1");
    failed_control();
    return lost(at, end);
  }
  const VariableNames names = assigned(at + 1, end);
  const bool known = !first->column.valid() && !limit->column.valid() && !(step && step->column.valid()) &&
      !names.all && names.names.count(variable) == 0;
  if (const double last = known ? (limit->number - first->number) / by : 0; known && last < kMaximumTurns)
    return {end + 1, written_out(at, variable, first->number, by, last + kTurnSlack)};
  rolled(at, variable, *match);
  return {end + 1, std::nullopt};
}

Flow::Jump Flow::written_out(int at, const std::string& variable, double first, double step, double last) {
  const Line& line = (*routine_)[at];
  for (int turn = 0;; ++turn) {
    lowering_.statement = &line.raw;
    count();
    if (!set(variable, number(first + turn * step)) || turn > last) return std::nullopt;
    if (const Jump out = range(at + 1, line.partner, at)) return out;
    if (!lowering_.reachable) return std::nullopt;
  }
}

/// Assigns; false after an error.
bool Flow::set(const std::string& variable, const Value& value) {
  try {
    assign(lowering_, *find_variable(lowering_, variable), std::nullopt, value);
    return true;
  } catch (const Mistake& m) {
    lowering_.error(m.code, lowering_.statement->span, m.message, m.help);
    failed_control();
    return false;
  }
}

/// A loop whose turns differ from machine to machine, or that has too many to write them out. Where its body sets the
/// variable itself, turns are counted from there.
void Flow::rolled(int at, const std::string& variable, const Match& match) {
  const RawStatement& raw = (*routine_)[at].raw;
  const int end = (*routine_)[at].partner;
  const MatchedValue *first = match.find("first"), *limit = match.find("limit"), *step = match.find("step");
  const Value from = number_of(*first, number(first->number));
  if (!set(variable, from)) return;
  VariableNames names = assigned(at + 1, end);
  const bool body_sets_it = names.all || names.names.count(variable) > 0;
  names.names.insert(variable);
  const plan::ColumnId start = lowering_.evaluated(from.parts[0]), turn = lowering_.evaluated(fixed_number(0));
  store(lowering_, names);
  forget(lowering_, names);
  carry_settings(lowering_);
  const State before = lowering_;
  const int top = new_label(), out = new_label();
  place(top);
  part();
  ++lowering_.looping;
  const plan::Expression to = number_of(*limit, number(limit->number)).parts[0];
  const plan::Expression by = (step ? number_of(*step, number(step->number)) : number(1)).parts[0];
  const plan::Expression last = combine(Op2::divide, combine(Op2::subtract, to, number_in(start)), by);
  lowering_.emit(plan::JumpUnless{
      combine(Op2::less_equal, number_in(turn), combine(Op2::add, last, fixed_number(kTurnSlack))), out});
  range(at + 1, end, at);
  lowering_.statement = &raw;
  if (lowering_.reachable) {
    if (body_sets_it) {
      const Value now = read(lowering_, *find_variable(lowering_, variable), std::nullopt);
      lowering_.emit(plan::Assign{start, now.parts[0]});
      lowering_.emit(plan::Assign{turn, fixed_number(0)});
    }
    lowering_.emit(plan::Assign{turn, combine(Op2::add, number_in(turn), fixed_number(1))});
    set(variable, {Type::real, {combine(Op2::add, number_in(start), combine(Op2::multiply, number_in(turn), by))}});
    store(lowering_, names);
    check_same_meaning(before);
    lowering_.emit(plan::Jump{top});
  }
  check_measurement(before);
  place(out);
  --lowering_.looping;
  meet();
  State after = before;
  std::swap(static_cast<State&>(lowering_), after);
  merge(lowering_, after);
  forget(lowering_, names);
}

Flow::Step Flow::choice(int at) {
  const int end = routine_->end_of(at);
  const auto match = matched((*routine_)[at].raw);
  if (!match) return lost(at, end);
  Value value = *match->find("value")->value;
  if (!value.known() && value.parts.size() == 1)
    value.parts[0] = {plan::PushColumn{lowering_.evaluated(value.parts[0])}};
  std::vector<int> cases;
  int fallback = -1;
  for (int k = at + 1; k < end; ++k) {
    if ((*routine_)[k].parent != at) continue;
    if ((*routine_)[k].control == Control::one_case) cases.push_back(k);
    if ((*routine_)[k].control == Control::any_case) fallback = k;
  }
  return {end + 1, choose(cases, 0, fallback, value)};
}

/// The first of cases[first..] that suits, or the fallback.
Flow::Jump Flow::choose(const std::vector<int>& cases, std::size_t first, int fallback, const Value& value) {
  const Deeper inside(*this);
  const auto body = [&](int at) { return range(at + 1, (*routine_)[at].partner, at); };
  for (; first < cases.size(); ++first) {
    const int at = cases[first];
    const auto condition = case_condition(at, value);
    if (!condition) {
      lose(at + 1, (*routine_)[at].partner);
      continue;
    }
    if (const double* known = plan::constant(*condition)) {
      if (*known != 0) return body(at);
      continue;
    }
    const int begin = (*routine_)[at].parent + 1, end = routine_->end_of((*routine_)[at].parent);
    branch(
        begin, end, *condition, [&] { return body(at); }, [&] { return choose(cases, first + 1, fallback, value); });
    return std::nullopt;
  }
  return fallback < 0 ? Jump{} : body(fallback);
}

/// Whether the value is one of those that CASE names; nothing after an error.
std::optional<plan::Expression> Flow::case_condition(int at, const Value& value) {
  const auto match = matched((*routine_)[at].raw);
  if (!match) return std::nullopt;
  std::optional<plan::Expression> any;
  for (const MatchedValue& v : match->values) {
    const bool comparable =
        value.type != Type::vector && (v.value->type == value.type || (v.value->is_number() && value.is_number()));
    if (!comparable) {
      lowering_.error(Code::E0232, v.span,
                      fmt::format("this case is {}, SELECT chooses by {}", name_of(v.value->type), name_of(value.type)),
                      "compare values of one type");
      failed_control();
      return std::nullopt;
    }
    plan::Expression same = combine(Op2::equal, value.parts[0], v.value->parts[0]);
    any = any ? combine(Op2::logical_or, std::move(*any), same) : std::move(same);
  }
  return any;
}

}  // namespace abbe::lang
