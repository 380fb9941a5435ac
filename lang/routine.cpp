#include "lang/routine.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace abbe::lang {

bool Routine::within(int line, int block) const {
  int at = (*this)[line].parent;
  while (at != block && at != -1) at = (*this)[at].parent;
  return at == block;
}

int Routine::end_of(int line) const {
  while ((*this)[line].partner >= 0) line = (*this)[line].partner;
  return line;
}

Macro macro_at(const Routine& routine, int line) {
  const Line &begin = routine[line], &end = routine[begin.partner];
  Macro macro{begin.raw.label->name, routine.file, {}, begin.raw.arguments};
  macro.lines.assign(routine.text.begin() + static_cast<std::ptrdiff_t>(begin.logical) + 1,
                     routine.text.begin() + static_cast<std::ptrdiff_t>(end.logical));
  return macro;
}

namespace {

/// Which words may stand for the end of what `control` opened.
bool closes(Control opener, Control closer) {
  switch (closer) {
    case Control::otherwise: return opener == Control::condition;
    case Control::end_condition: return opener == Control::condition || opener == Control::otherwise;
    case Control::end_loop: return opener == Control::loop;
    case Control::end_case: return opener == Control::one_case || opener == Control::any_case;
    case Control::end_choice: return opener == Control::choice;
    case Control::end_macro: return opener == Control::macro;
    default: return false;
  }
}

bool opens(Control c) {
  return c == Control::condition || c == Control::otherwise || c == Control::loop || c == Control::choice ||
      c == Control::one_case || c == Control::any_case || c == Control::macro;
}

bool is_closer(Control c) {
  return c == Control::otherwise || c == Control::end_condition || c == Control::end_loop || c == Control::end_case ||
      c == Control::end_choice || c == Control::end_macro;
}

std::string_view end_of(Control c) {
  switch (c) {
    case Control::condition:
    case Control::otherwise: return "ENDIF";
    case Control::loop: return "ENDDO";
    case Control::choice: return "ENDSEL";
    case Control::macro: return "ENDMAC";
    default: return "ENDCAS";
  }
}

/// Finds the partner and the parent of every line.
class Blocks {
 public:
  Blocks(Routine& routine, Lowering& lowering) : routine_(routine), lowering_(lowering) {}

  void find() {
    for (int at = 0; at < routine_.size(); ++at) {
      Line& line = routine_.lines[static_cast<std::size_t>(at)];
      if (line.skipped) continue;
      if (is_closer(line.control)) close(at, line);
      line.parent = open_.empty() ? -1 : open_.back();
      if (line.control == Control::one_case || line.control == Control::any_case) check_case(line);
      if (line.raw.target) target(at, line);
      if (opens(line.control)) open_.push_back(at);
    }
    for (const int at : open_) unclosed(at);
    // What stands behind a word that opens nothing stands in the block around it.
    for (Line& l : routine_.lines)
      if (l.parent >= 0 && line(l.parent).control == Control::lost) l.parent = line(l.parent).parent;
  }

 private:
  Line& line(int at) { return routine_.lines[static_cast<std::size_t>(at)]; }

  void error(Code code, const Line& at, std::string message, std::string help) {
    lowering_.statement = &at.raw;
    lowering_.failed = false;
    lowering_.error(code, at.raw.span, std::move(message), std::move(help));
    if (lowering_.flow_doubt.empty()) lowering_.flow_doubt = lowering_.blame();
    lowering_.statement = nullptr;
  }

  void unclosed(int at) {
    Line& l = line(at);
    error(Code::E0117, l, fmt::format("this {} has no {}", l.raw.word, end_of(l.control)),
          fmt::format("end the block with {}", end_of(l.control)));
    l.control = Control::lost;
  }

  void close(int at, Line& l) {
    auto opener = std::find_if(open_.rbegin(), open_.rend(), [&](int o) { return closes(line(o).control, l.control); });
    if (opener == open_.rend()) {
      error(Code::E0116, l, fmt::format("{} closes nothing", l.raw.word),
            "remove it, or write the word that opens its block");
      l.control = Control::lost;
      return;
    }
    for (; !closes(line(open_.back()).control, l.control); open_.pop_back()) {
      Line& inner = line(open_.back());
      error(Code::E0118, l,
            fmt::format("{} stands before the {} of line {} is closed", l.raw.word, inner.raw.word, inner.raw.line),
            fmt::format("write {} before it", end_of(inner.control)));
      inner.control = Control::lost;
    }
    line(open_.back()).partner = at;
    open_.pop_back();
  }

  void check_case(Line& l) {
    if (l.parent >= 0 && line(l.parent).control == Control::choice) return;
    error(Code::E0116, l, fmt::format("{} outside a SELECT", l.raw.word),
          "cases stand between SELECT/value and ENDSEL");
    l.control = Control::lost;
  }

  void target(int at, const Line& l) {
    const auto [known, is_new] = routine_.targets.emplace(upper(l.raw.target->name), at);
    if (!is_new)
      error(Code::E0246, l,
            fmt::format("({}) stands in line {} already", l.raw.target->name, line(known->second).raw.line),
            "give each target a name of its own");
  }

  Routine& routine_;
  Lowering& lowering_;
  std::vector<int> open_;
};

}  // namespace

Routine make_routine(const SourceFile& file, std::vector<LogicalLine> text, Lowering& lowering) {
  Routine routine;
  routine.file = &file;
  routine.text = std::move(text);
  bool off = false;
  for (std::size_t k = 0; k < routine.text.size(); ++k) {
    Sink found;
    std::optional<RawStatement> raw = parse_statement(routine.text[k], file, found);
    for (const Diagnostic& d : found.list()) lowering.add(d);
    if (!raw) continue;
    Line line{std::move(*raw), Control::none, -1, -1, off, k};
    const Statement* known = line.raw.target ? nullptr : find_statement(line.raw.word);
    if (known) line.control = known->control;
    if (line.raw.word == "DMESW" && line.raw.arguments.size() == 1) {
      if (line.raw.arguments[0].word == "OFF") off = true;
      if (line.raw.arguments[0].word == "ON") line.skipped = off = false;
    }
    routine.lines.push_back(std::move(line));
  }
  routine.visited.resize(routine.lines.size());
  Blocks(routine, lowering).find();
  for (int at = 0; at < routine.size(); ++at)
    if (routine[at].control == Control::jump) routine.jumps.push_back(at);
  return routine;
}

namespace {

bool is_sign(char c) { return c == '+' || c == '-'; }
bool in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

/// Where no variables are.
class NoNames : public Names {
 public:
  std::optional<Value> variable(std::string_view, const std::optional<Value>&) override { return std::nullopt; }
  std::string near(std::string_view) override { return ""; }
  Texts& texts() override { return texts_; }

 private:
  Texts texts_;
};

/// What stands for an argument: an expression without variables is computed, so that it stays short however often
/// macros hand it on.
RawArgument folded(const RawArgument& actual) {
  if (actual.kind != RawArgument::Kind::expression) return actual;
  NoNames none;
  const Evaluation result = evaluate(actual.text, 0, actual.text.size(), none);
  const Value* value = std::get_if<Value>(&result);
  if (!value || !value->is_number()) return actual;
  RawArgument out = actual;
  out.kind = RawArgument::Kind::number;
  out.text = fmt::format("{}", value->constant());
  if (value->type == Type::real && out.text.find_first_of(".e") == std::string::npos) out.text += '.';
  return out;
}

/// Copies one line, with actuals in place of dummies.
class Replacer {
 public:
  Replacer(const Macro& macro, std::span<const RawArgument> actuals, std::span<const RawArgument> values,
           const JoinedText& from)
      : macro_(macro), actuals_(actuals), values_(values), from_(from), text_(from.text()) {}

  /// Nothing when the arguments are too long.
  std::optional<JoinedText> run() {
    std::size_t added = 0;
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = token_end(at);
      const std::string_view token = text_.substr(at, end - at);
      if (token == "(") label_ = at > 0 && in_name(text_[at - 1]);
      if (token == ")") label_ = false;
      const int k = dummy(token);
      if (token == "@" && label_ && names_itself(dummy(text_.substr(end, token_end(end) - end)))) {
        // F(@NAME) with a text for NAME: the label itself stands there, not a variable that holds it
      } else if (k < 0) {
        copy(at, end);
      } else {
        const std::string by =
            replacement(static_cast<std::size_t>(k), token.front() == '\'', at > 0 && is_sign(text_[at - 1]));
        added += by.size();
        if (added > kLongestArguments) return std::nullopt;
        out_.append_instead(by, from_.span(at, end));
      }
      at = end;
    }
    return std::move(out_);
  }

 private:
  /// A quoted text, a name, or one character.
  std::size_t token_end(std::size_t at) const {
    std::size_t end = at + 1;
    if (text_[at] == '\'') {
      while (end < text_.size() && text_[end] != '\'') ++end;
      return std::min(end + 1, text_.size());
    }
    if (in_name(text_[at]))
      while (end < text_.size() && in_name(text_[end])) ++end;
    return end;
  }

  int dummy(std::string_view token) const {
    const bool quoted = token.size() > 2 && token.front() == '\'';
    const std::string name = upper(quoted ? token.substr(1, token.size() - 2) : token);
    for (std::size_t k = 0; k < macro_.dummies.size(); ++k) {
      const RawArgument& d = macro_.dummies[k];
      if ((d.kind == RawArgument::Kind::text) == quoted && upper(d.text) == name) return static_cast<int>(k);
    }
    return -1;
  }

  /// Whether the argument for a dummy is what a label is made of, and no variable that holds it.
  bool names_itself(int k) const {
    using K = RawArgument::Kind;
    return k >= 0 &&
        (actuals_[static_cast<std::size_t>(k)].kind == K::text ||
         actuals_[static_cast<std::size_t>(k)].kind == K::number);
  }

  /// In a label a text loses its quotes; an expression keeps its worth whatever stands beside it.
  std::string replacement(std::size_t k, bool quoted, bool after_sign) const {
    const RawArgument& a = label_ ? actuals_[k] : values_[k];
    using K = RawArgument::Kind;
    if (a.kind == K::text) return label_ ? a.text : fmt::format("'{}'", a.text);
    const bool grouped = a.kind == K::expression && a.text.starts_with('(') && a.text.find(')') == a.text.size() - 1;
    if (grouped && quoted)
      return label_ ? a.text.substr(1, a.text.size() - 2) : fmt::format("'{}'", a.text.substr(1, a.text.size() - 2));
    // `X -Y` is no list of two numbers
    const bool signs = a.kind == K::number && (is_sign(a.text.front()) || after_sign);
    const bool guarded = !label_ && ((a.kind == K::expression && !grouped) || signs);
    return guarded ? fmt::format("({})", a.text) : a.text;
  }

  /// In one piece, or in several where a `$` cuts the token.
  void copy(std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end;) {
      std::size_t next = at + 1;
      while (next < end && from_.file_offset(next) == from_.file_offset(next - 1) + 1) ++next;
      out_.append(text_.substr(at, next - at), from_.file_offset(at));
      at = next;
    }
  }

  const Macro& macro_;
  std::span<const RawArgument> actuals_, values_;
  const JoinedText& from_;
  std::string_view text_;
  JoinedText out_;
  bool label_ = false;
};

}  // namespace

std::optional<std::vector<LogicalLine>> expand(const Macro& macro, std::span<const RawArgument> actuals) {
  std::vector<RawArgument> values;
  for (const RawArgument& a : actuals) values.push_back(folded(a));
  std::vector<LogicalLine> out;
  for (const LogicalLine& line : macro.lines) {
    std::optional<JoinedText> code = Replacer(macro, actuals, values, line.code).run();
    if (!code) return std::nullopt;
    out.push_back({std::move(*code), std::nullopt, line.line});
  }
  return out;
}

}  // namespace abbe::lang
