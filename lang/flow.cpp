#include "lang/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace abbe::lang {

Flow::Flow(Lowering& lowering, Moving& moving, std::function<void(const RawStatement&)> ordinary)
    : lowering_(lowering), moving_(moving), lower_ordinary_(std::move(ordinary)) {}

void Flow::run(Routine& program) {
  routine_ = &program;
  for (int at = 0; at < program.size(); ++at)
    if (program[at].control == Control::macro && !program[at].skipped) define_macro(at);
  try {
    range(0, program.size(), -1);
  } catch (const TooLong&) {
    if (again_) throw Restart{};
    lowering_.statement = nullptr;
    lowering_.end_line = lowering_.source.line_count();  // where it would have ended is not known
  }
  if (again_) throw Restart{};
  finish_plan();
}

void Flow::count() {
  if (++statements_ <= kMaximumStatements) return;
  lowering_.error(
      Code::E0120, lowering_.statement->span,
      fmt::format("this program has more than {} statements when its loops, jumps and macros are written out",
                  kMaximumStatements),
      "does a loop or jump near here ever end?");
  failed_control();
  throw TooLong{};
}

void Flow::deepen() {
  if (nesting_ > kMaximumDepth) {  // the program itself is not nested
    lowering_.error(Code::E0126, lowering_.statement->span,
                    fmt::format("blocks and calls are nested deeper than {}", kMaximumDepth),
                    "write the inner blocks as macros that are called one after the other, or as cases of one SELECT");
    failed_control();
    throw TooLong{};
  }
  ++nesting_;
}

void Flow::failed_control() {
  if (lowering_.flow_doubt.empty()) lowering_.flow_doubt = lowering_.blame();
}

/// The lines [begin, end) are not lowered, because the word that decides on them failed: what they evaluate is lost.
void Flow::lose(int begin, int end) {
  for (int at = begin; at < end; ++at) {
    const Line& line = (*routine_)[at];
    if (line.skipped || (line.raw.word != "OUTPUT" && line.raw.word != "EVAL")) continue;
    std::string features;
    for (const RawArgument& a : line.raw.arguments)
      if (a.kind == RawArgument::Kind::label && a.label.kind == "FA")
        features += (features.empty() ? "" : ", ") + a.label.name;
    lowering_.out.lost.push_back(
        {lowering_.place ? lowering_.place->second : line.raw.line, features, lowering_.flow_doubt});
  }
}

/// Lowers the lines [begin, end), which are those of the block that line `level` opens. Returns where a jump
/// leads to that leaves them.
Flow::Jump Flow::range(int begin, int end, int level) {
  const Deeper inside(*this);
  const std::vector<Interval> intervals = moving_intervals(level);
  for (int at = begin; at < end && lowering_.reachable;) {
    if (const auto moving = region_at(at, intervals)) {
      region(*moving, at == moving->first ? std::nullopt : std::optional(at));
      at = moving->last + 1;
      continue;
    }
    const Step done = step(at);
    at = done.next;
    if (!done.jump) continue;
    if ((*routine_)[*done.jump].parent != level) return done.jump;
    at = *done.jump;
  }
  return std::nullopt;
}

Flow::Step Flow::step(int at) {
  const Line& line = (*routine_)[at];
  routine_->visited[static_cast<std::size_t>(at)] = 1;
  lowering_.statement = &line.raw;
  lowering_.failed = false;
  count();
  const bool program_is_over = depth_ == 0 && (lowering_.end_line != 0 || lowering_.second_program);
  const bool module_is_over = depth_ > 0 && line.raw.word == "ENDFIL";
  if (module_is_over) return {routine_->size(), std::nullopt};
  if (line.skipped || program_is_over) {
    lower_ordinary_(line.raw);
    return {at + 1, std::nullopt};
  }
  switch (line.control) {
    case Control::none: ordinary(line); break;
    case Control::condition: return condition(at);
    case Control::loop: return loop(at);
    case Control::choice: return choice(at);
    case Control::jump: return jump(at);
    case Control::macro: define_macro(at); return {routine_->end_of(at) + 1, std::nullopt};
    case Control::call: call(at); break;
    case Control::module: module(at); break;
    default: break;
  }
  lowering_.statement = nullptr;
  return {at + 1, std::nullopt};
}

/// The arguments of a word of control; nothing after an error.
std::optional<Match> Flow::matched(const RawStatement& raw) {
  const Statement& statement = *find_statement(raw.word);
  lowering_.statement = &raw;
  lowering_.failed = false;
  std::optional<Match> match;
  if (raw.missing_slash && !statement.signature.empty())
    lowering_.error(Code::E0115, *raw.missing_slash, fmt::format("expected '/' after {}", raw.word),
                    fmt::format("for example: {}", statement.example));
  else if (!raw.usable)
    lowering_.fail("the statement is not complete");
  else
    match = lowering_.match(statement.signature, raw, raw.word, 0, Varying::taken);
  if (!match) failed_control();
  return match;
}

void Flow::ordinary(const Line& line) {
  const auto needs = [](const LabelRef& label) { return label.name.find('@') != std::string::npos; };
  const bool computed = (line.raw.label && needs(*line.raw.label)) ||
      std::any_of(line.raw.arguments.begin(), line.raw.arguments.end(),
                  [&](const RawArgument& a) { return a.kind == RawArgument::Kind::label && needs(a.label); });
  if (!computed) return lower_ordinary_(line.raw);
  const RawStatement resolved = with_labels(line.raw);
  lower_ordinary_(resolved);
}

/// F(@NAME): every @NAME in a label gives way to what the variable holds.
RawStatement Flow::with_labels(const RawStatement& raw) {
  RawStatement out = raw;
  lowering_.statement = &raw;
  if (out.label) resolve(*out.label, 0);
  for (RawArgument& a : out.arguments)
    if (a.kind == RawArgument::Kind::label) resolve(a.label, a.begin);
  if (lowering_.failed) out.usable = false;
  return out;
}

/// `begin`: where in the statement's text the label begins, or a place before it.
void Flow::resolve(LabelRef& label, std::size_t begin) {
  const std::string& code = lowering_.statement->code->text();
  const auto in_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
  };
  std::string out;
  for (std::size_t at = 0; at < label.name.size() && !lowering_.failed;) {
    if (label.name[at] != '@') {
      out += label.name[at++];
      continue;
    }
    std::size_t end = at + 1;
    while (end < label.name.size() && in_name(label.name[end])) ++end;
    if (end < label.name.size() && label.name[end] == '[')
      end = std::min(label.name.find(']', end), label.name.size() - 1) + 1;
    begin = code.find('@', begin) + 1;
    RawArgument variable;
    variable.begin = begin;
    variable.end = begin + end - at - 1;
    if (const std::optional<Value> value = lowering_.value(variable)) out += label_text(label, *value);
    at = end;
  }
  if (!lowering_.failed) label.name = std::move(out);
}

std::string Flow::label_text(const LabelRef& label, const Value& value) {
  if (!value.known()) {
    lowering_.error(Code::E0231, label.span,
                    fmt::format("the label {}({}) depends on a measured value", label.kind, label.name),
                    "write the statement once for each label, under IF");
  } else if (value.is_number() && value.constant() == std::floor(value.constant())) {
    return fmt::format("{}", value.constant());
  } else if (value.type != Type::text) {
    lowering_.error(Code::E0232, label.span,
                    fmt::format("a label is made of a text or a whole number, this is {}", name_of(value.type)),
                    "STR(x) makes a text of a number");
  } else {
    const std::string& text = lowering_.texts[value];
    return text.substr(0, text.find_last_not_of(' ') + 1);
  }
  return "";
}

void Flow::part() {
  if (lowering_.parted++ == 0) ++lowering_.parting;
  if (lowering_.measuring) lowering_.measuring->varies = true;
}

int Flow::new_label() {
  positions_.push_back(-1);
  return static_cast<int>(positions_.size()) - 1;
}

/// Resolves labels to operations and leaves out what does nothing: dropped operations and jumps to the next one.
void Flow::finish_plan() {
  auto& operations = lowering_.out.plan.operations;
  const int count = static_cast<int>(operations.size());
  const auto target_of = [](plan::Action& action) -> int* {
    if (auto* jump = std::get_if<plan::Jump>(&action)) return &jump->target;
    if (auto* jump = std::get_if<plan::JumpUnless>(&action)) return &jump->target;
    return nullptr;
  };
  std::vector<char> kept(operations.size(), 1);
  for (int i = count - 1; i >= 0; --i) {
    auto& action = operations[static_cast<std::size_t>(i)].action;
    int* target = target_of(action);
    if (!target) continue;
    const int label = *target;
    *target = label == kDropped                           ? i + 1
        : positions_[static_cast<std::size_t>(label)] < 0 ? count
                                                          : positions_[static_cast<std::size_t>(label)];
    const bool passes =
        *target > i && std::none_of(kept.begin() + i + 1, kept.begin() + *target, [](char k) { return k != 0; });
    if (std::holds_alternative<plan::Jump>(action) && passes) kept[static_cast<std::size_t>(i)] = 0;
  }
  std::vector<int> moved(operations.size() + 1, 0);
  for (std::size_t i = 0; i < operations.size(); ++i) moved[i + 1] = moved[i] + kept[i];
  std::vector<plan::Operation> out;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    if (!kept[i]) continue;
    out.push_back(std::move(operations[i]));
    if (int* target = target_of(out.back().action)) *target = moved[static_cast<std::size_t>(*target)];
  }
  operations = std::move(out);
}

}  // namespace abbe::lang
