// The only file that includes PEGTL.
#include "lang/parser.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <tao/pegtl.hpp>

namespace abbe::lang {

namespace grammar {

using namespace tao::pegtl;

// clang-format off
struct blanks : star<blank> {};
struct beyond_ascii : range<'\x80', '\xff'> {};
struct letter : sor<alpha, one<'_'>, beyond_ascii> {};
struct identifier : seq<letter, star<sor<letter, digit, one<'.', '-', '+'>>>> {};
struct quoted : seq<one<'\''>, star<sor<two<'\''>, not_one<'\''>>>, one<'\''>> {};

// ---- a statement
struct label_kind : seq<letter, star<sor<letter, digit>>> {};
struct label_name : star<not_one<'(', ')', ','>> {};
struct labelled : seq<label_kind, blanks, one<'('>, label_name, one<')'>> {};
struct index : seq<blanks, one<'['>, star<not_one<'[', ']', '='>>, one<']'>> {};
struct variable : seq<identifier, opt<index>> {};
struct label : sor<labelled, variable> {};
struct labelling : seq<blanks, label, blanks, one<'='>, blanks> {};
struct major_word : seq<alpha, star<sor<alnum, one<'_'>>>> {};
struct head : seq<if_then_else<at<labelling>, labelling, blanks>, major_word, blanks> {};
struct group;
struct group_part : sor<quoted, group, not_one<'(', ')', '\''>> {};
struct group : seq<one<'('>, star<group_part>, one<')'>> {};
struct element : seq<one<'['>, star<sor<group, not_one<'[', ']', '(', ')', '\''>>>, one<']'>> {};
struct argument : star<sor<quoted, group, element, not_one<',', '(', ')', '\''>>> {};
struct arguments : list<argument, one<','>> {};
struct slash : one<'/'> {};
struct leftover : star<any> {};
struct statement : seq<head, opt<slash, arguments>, leftover, eof> {};
struct head_only : seq<head, opt<slash>> {};
struct target_name : plus<sor<letter, digit, one<'.', '-', '+'>>> {};
struct target : seq<blanks, one<'('>, blanks, target_name, blanks, one<')'>, blanks, eof> {};

// ---- one argument
struct sign : one<'+', '-'> {};
struct exponent : seq<one<'e', 'E'>, opt<sign>, plus<digit>> {};
struct unsigned_number : seq<sor<seq<plus<digit>, opt<one<'.'>, star<digit>>>, seq<one<'.'>, plus<digit>>>, opt<exponent>,
                             not_at<sor<letter, digit, one<'.'>>>> {};
struct number : seq<opt<sign>, unsigned_number> {};
struct word : seq<opt<sign>, star<digit>, letter, star<sor<letter, digit>>> {};
struct label_value : seq<label_kind, blanks, one<'('>, label_name, one<')'>> {};
struct ends_itself : sor<quoted, label_value> {};
struct one_more_number;
struct numbers : seq<unsigned_number, star<one_more_number>> {};
struct needs_blank : seq<sor<numbers, word>, at<sor<blank, eof, one<'\''>>>> {};
struct value : sor<ends_itself, needs_blank> {};
struct first_value : sor<ends_itself, seq<opt<sign>, needs_blank>> {};
struct only_number : seq<number, eof> {};
struct only_word : seq<word, eof> {};
struct only_label : seq<label_kind, blanks, one<'('>, label_name, one<')'>, eof> {};
struct only_text : seq<quoted, eof> {};
// A sign that follows blanks and touches a digit is that of a number of its own; `0 - 1` and `A -1` are differences.
struct one_more_number : seq<plus<blank>, sign, unsigned_number> {};
struct several_numbers : seq<opt<sign>, unsigned_number, plus<one_more_number>> {};
struct several : seq<sor<seq<first_value, plus<blanks, value>>, several_numbers>, blanks, eof> {};
// clang-format on

/// Offsets into the text that was parsed.
struct Range {
  std::size_t begin = 0, end = 0;
};

struct Found {
  std::optional<Range> label_kind, label_name, variable, word, target;
  std::vector<Range> arguments;
  bool slash = false;
  Range leftover;
};

template <class Input>
Range range_of(const Input& in, std::size_t base = 0) {
  const std::size_t begin = base + in.position().byte;
  return {begin, begin + in.size()};
}

template <class Rule>
struct action : nothing<Rule> {};
template <>
struct action<label_kind> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.label_kind = range_of(in);
  }
};
template <>
struct action<label_name> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.label_name = range_of(in);
  }
};
template <>
struct action<variable> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.variable = range_of(in);
  }
};
template <>
struct action<major_word> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.word = range_of(in);
  }
};
template <>
struct action<target_name> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.target = range_of(in);
  }
};
template <>
struct action<slash> {
  template <class Input>
  static void apply(const Input&, Found& found) {
    found.slash = true;
  }
};
template <>
struct action<argument> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.arguments.push_back(range_of(in));
  }
};
template <>
struct action<leftover> {
  template <class Input>
  static void apply(const Input& in, Found& found) {
    found.leftover = range_of(in);
  }
};

template <class Rule>
bool matches(std::string_view text, Found& found) {
  memory_input in(text.data(), text.data() + text.size(), "");
  return parse<Rule, action>(in, found);
}

template <class Rule>
bool matches(std::string_view text) {
  Found ignored;
  return matches<Rule>(text, ignored);
}

}  // namespace grammar

namespace {

using grammar::Range;

Range trimmed(std::string_view text, Range r) {
  const auto blank = [&](std::size_t i) { return text[i] == ' ' || text[i] == '\t'; };
  while (r.begin < r.end && blank(r.begin)) ++r.begin;
  while (r.end > r.begin && blank(r.end - 1)) --r.end;
  return r;
}

std::string_view slice(std::string_view text, Range r) { return text.substr(r.begin, r.end - r.begin); }

std::string unquoted(std::string_view text) {
  std::string out;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '\'') ++i;  // '' is one quote
    out += text[i];
  }
  return out;
}

/// Turns one logical line into a statement; every member speaks of offsets into the joined text.
class LineParser {
 public:
  LineParser(const LogicalLine& line, const SourceFile& source, Sink& sink)
      : line_(line), text_(line.code.text()), source_(source), sink_(sink) {}

  std::optional<RawStatement> parse() {
    const Range code = trimmed(text_, {0, text_.size()});
    if (code.begin == code.end) return std::nullopt;
    statement_.line = source_.place(span(code).begin).line;
    statement_.span = span(code);
    const std::optional<Slip> slip = unpaired();
    grammar::Found found;
    if (!slip && grammar::matches<grammar::target>(text_, found)) return jump_target(found);
    found = {};
    const bool matched =
        slip ? grammar::matches<grammar::head_only>(text_, found) : grammar::matches<grammar::statement>(text_, found);
    if (!matched) {
      not_a_statement(code);
      return std::nullopt;
    }
    read_head(found);
    statement_.usable = !slip && leftover_is_empty(found, code);
    if (slip && found.slash)
      error(slip->code, slip->at, slip->message, slip->help);
    else if (slip)  // free text that holds an apostrophe, perhaps
      statement_.missing_slash = span({found.word->end, code.end});
    if (statement_.usable && found.slash)
      for (const Range& r : found.arguments) statement_.arguments.push_back(argument(trimmed(text_, r)));
    if (statement_.arguments.size() == 1 && statement_.arguments[0].kind == RawArgument::Kind::empty)
      statement_.arguments.clear();
    if (statement_.word.empty()) return std::nullopt;
    statement_.code = std::make_shared<const JoinedText>(line_.code);
    return std::move(statement_);
  }

 private:
  Span span(Range r) const { return line_.code.span(r.begin, r.end); }

  void error(Code code, Range at, std::string message, std::string help = "", std::string replacement = "") {
    sink_.add(diagnostic_at(source_, span(at), code, std::move(message), std::move(help), std::move(replacement)));
  }

  /// A string or a parenthesis without its partner.
  struct Slip {
    Code code;
    Range at;
    std::string message, help;
  };

  /// The first one, if any.
  std::optional<Slip> unpaired() const {
    std::vector<std::size_t> open;
    std::size_t quote = std::string_view::npos;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      if (text_[i] == '\'') quote = quote == std::string_view::npos ? i : std::string_view::npos;
      if (quote != std::string_view::npos) continue;
      if (text_[i] == '(') open.push_back(i);
      if (open.size() > static_cast<std::size_t>(kMaximumNesting))
        return Slip{Code::E0104,
                    {i, i + 1},
                    fmt::format("parentheses are nested deeper than {}", kMaximumNesting),
                    "write the expression in steps"};
      if (text_[i] != ')') continue;
      if (open.empty())
        return Slip{
            Code::E0103, {i, i + 1}, "this ')' closes nothing", "remove it, or write the '(' that it should close"};
      open.pop_back();
    }
    if (quote != std::string_view::npos)
      return Slip{Code::E0102,
                  {quote, text_.size()},
                  "this string is not closed",
                  "end it with '; a quote inside a string is written ''"};
    if (!open.empty())
      return Slip{
          Code::E0103, {open.back(), open.back() + 1}, "this '(' is not closed", "write the ')' that closes it"};
    return std::nullopt;
  }

  void not_a_statement(Range code) {
    error(Code::E0101, code, fmt::format("'{}' is not a statement", slice(text_, code)),
          "a statement is WORD/argument,argument; a comment begins with $$");
  }

  std::optional<RawStatement> jump_target(const grammar::Found& found) {
    const Range name = trimmed(text_, *found.target);
    statement_.code = std::make_shared<const JoinedText>(line_.code);
    statement_.target = LabelRef{"", std::string(slice(text_, name)), span(name)};
    return std::move(statement_);
  }

  void read_head(const grammar::Found& found) {
    if (found.label_name) {
      const Range kind = *found.label_kind, name = trimmed(text_, *found.label_name);
      statement_.label = LabelRef{upper(slice(text_, kind)), std::string(slice(text_, name)),
                                  span({kind.begin, found.label_name->end + 1})};
    } else if (found.variable) {
      statement_.label = LabelRef{"", std::string(slice(text_, *found.variable)), span(*found.variable)};
    }
    if (!found.word) return;
    statement_.word = upper(slice(text_, *found.word));
    statement_.word_span = span(*found.word);
  }

  /// Text after a statement, or instead of its slash.
  bool leftover_is_empty(const grammar::Found& found, Range code) {
    const Range rest = trimmed(text_, found.leftover);
    if (rest.begin == rest.end) return true;
    if (found.slash) {
      error(Code::E0105, rest, fmt::format("'{}' is not part of any argument", slice(text_, rest)),
            "arguments are separated by commas");
      return false;
    }
    const Range word = *found.word;
    if (text_[rest.begin] == '(' && !statement_.label) {
      error(Code::E0101, code, fmt::format("'{}' is not a statement", slice(text_, code)),
            "after a label comes '=' and a word: F(name)=FEAT/...");
      statement_.word.clear();
      return false;
    }
    statement_.word = upper(slice(text_, word));
    statement_.missing_slash = span(rest);
    return false;
  }

  RawArgument argument(Range r) const {
    const std::string_view text = slice(text_, r);
    RawArgument out;
    out.text = text;
    out.span = span(r);
    out.begin = r.begin;
    out.end = r.end;
    using Kind = RawArgument::Kind;
    grammar::Found found;
    if (text.empty()) {
      out.kind = Kind::empty;
    } else if (grammar::matches<grammar::only_number>(text)) {
      read_number(out);
    } else if (grammar::matches<grammar::only_word>(text)) {
      out.kind = Kind::word;
      out.word = upper(text.starts_with('+') ? text.substr(1) : text);
    } else if (grammar::matches<grammar::only_text>(text)) {
      out.kind = Kind::text;
      out.text = unquoted(text);
    } else if (grammar::matches<grammar::only_label>(text, found)) {
      out.kind = Kind::label;
      const Range name = trimmed(text, *found.label_name);
      out.label = {upper(slice(text, *found.label_kind)), std::string(slice(text, name)), out.span};
    } else {
      out.kind = grammar::matches<grammar::several>(text) ? Kind::several : Kind::expression;
    }
    return out;
  }

  /// A number too large for a double, or for anything that is measured, stays an expression, which no signature takes.
  static void read_number(RawArgument& out) {
    std::string_view digits = out.text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), out.number);
    const bool meant = result.ec == std::errc{} && std::abs(out.number) <= kLargestNumber;
    out.kind = meant ? RawArgument::Kind::number : RawArgument::Kind::expression;
  }

  const LogicalLine& line_;
  std::string_view text_;
  const SourceFile& source_;
  Sink& sink_;
  RawStatement statement_;
};

}  // namespace

std::string written(const LabelRef& label) {
  return label.kind.empty() ? label.name : fmt::format("{}({})", label.kind, label.name);
}

std::optional<RawStatement> parse_statement(const LogicalLine& line, const SourceFile& source, Sink& sink) {
  return LineParser(line, source, sink).parse();
}

}  // namespace abbe::lang
