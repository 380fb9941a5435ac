#include "lang/directives.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <type_traits>

#include "engine/base/numbers.hpp"
#include "engine/plan/lifetimes.hpp"

namespace abbe::lang {

namespace {

constexpr std::array kKnownDirectives = {
    DirectiveHelp{"machine", "machine NAME", "machine file, or name of a shipped machine; the command line wins"},
    DirectiveHelp{"machines", "machines N", "how many virtual machines"},
    DirectiveHelp{"seed", "seed N", "seed of the random numbers"},
    DirectiveHelp{"workpiece", "workpiece FILE", "true sizes and calibration of the part"},
    DirectiveHelp{"place", "place X Y Z", "where the program's machine coordinate system lies in the machine, mm"},
    DirectiveHelp{"answer", "answer NAME=VALUE", "what PROMPT gives to the variable NAME; the command line wins"},
    DirectiveHelp{"expect", "expect [FA(x) ...] TA(t) [occurrence N] QUANTITY between A B | >= A | <= B",
                  "an expected result, checked by `abbe test`; also: expect accepted between A B"}};

constexpr std::array<std::string_view, 7> kQuantities = {"u", "u95", "lcl", "ucl", "mean", "value", "conformance"};

struct Token {
  std::string text;
  Span span;
  std::size_t begin = 0;  ///< in the comment
};

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, end + 1 - begin);
}

/// Behind the `!`: what blanks separate, in an expectation also commas, except for those in parentheses.
std::vector<Token> split(const JoinedText& comment) {
  std::vector<Token> tokens;
  const std::string& text = comment.text();
  std::string_view between = " \t";
  for (std::size_t i = text.find('!') + 1; i < text.size();) {
    const std::size_t begin = text.find_first_not_of(between, i);
    if (begin == std::string::npos) break;
    std::size_t end = begin;
    for (int depth = 0; end < text.size() && (depth > 0 || between.find(text[end]) == between.npos); ++end)
      depth += text[end] == '(' ? 1 : text[end] == ')' && depth > 0 ? -1 : 0;
    tokens.push_back({text.substr(begin, end - begin), comment.span(begin, end), begin});
    if (upper(tokens.back().text) == "EXPECT") between = " \t,";  // reports write FA(A),FA(B),TA(L)
    i = end;
  }
  return tokens;
}

/// "TA(LEN)" to LEN when the kind is one of the two, else nothing.
std::optional<std::string> label_of(const std::string& token, std::string_view kind, std::string_view other) {
  const std::size_t open = token.find('(');
  if (open == std::string::npos || !token.ends_with(')')) return std::nullopt;
  const std::string written = upper(token.substr(0, open));
  if (written != kind && written != other) return std::nullopt;
  return token.substr(open + 1, token.size() - open - 2);
}

/// Thrown inside this file to leave a directive that has a mistake; the message is in the sink.
struct Abandoned {};

class DirectiveReader {
 public:
  DirectiveReader(const JoinedText& comment, Lowering& lowering, int line)
      : lowering_(lowering),
        line_(line),
        comment_(comment),
        tokens_(split(comment)),
        whole_(comment.span(0, comment.text().size())) {}

  void read() {
    try {
      while (next_ < tokens_.size()) one();
    } catch (const Abandoned&) {  // the rest of the comment cannot be told apart from the mistake
    }
  }

 private:
  [[noreturn]] void mistake(Code code, Span at, std::string message, std::string help, std::string replacement = "") {
    lowering_.sink.add(
        diagnostic_at(lowering_.source, at, code, std::move(message), std::move(help), std::move(replacement)));
    throw Abandoned{};
  }

  const Token* peek() const { return next_ < tokens_.size() ? &tokens_[next_] : nullptr; }

  const Token& take(std::string_view directive, std::string_view expected) {
    if (next_ < tokens_.size()) return tokens_[next_++];
    const Span at = tokens_.empty() ? whole_ : tokens_.back().span;
    mistake(Code::E0114, at, fmt::format("directive '{}' ends where {} is expected", directive, expected),
            help_for(directive));
  }

  static std::string help_for(std::string_view directive) {
    const auto it = std::find_if(kKnownDirectives.begin(), kKnownDirectives.end(),
                                 [&](const DirectiveHelp& d) { return d.word == directive; });
    return fmt::format("write $$! {}", it->form);
  }

  template <class Number>
  static std::optional<Number> whole_number(std::string_view digits) {
    if (digits.starts_with('+')) digits.remove_prefix(1);
    Number value{};
    const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (failure != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    return value;
  }

  template <class Number>
  Number number(std::string_view directive, std::string_view expected) {
    const Token& token = take(directive, expected);
    std::optional<Number> value;
    if constexpr (std::is_floating_point_v<Number>)
      value = finite_number(token.text);
    else
      value = whole_number<Number>(token.text);
    if (!value)
      mistake(Code::E0114, token.span, fmt::format("directive '{}': '{}' is not {}", directive, token.text, expected),
              help_for(directive));
    return *value;
  }

  void one() {
    const Token& word = tokens_[next_++];
    const std::string name = upper(word.text);
    Directives& out = lowering_.out.directives;
    const bool again = (name == "MACHINE" && out.machine) || (name == "MACHINES" && out.machines) ||
        (name == "SEED" && out.seed) || (name == "WORKPIECE" && out.workpiece) || (name == "PLACE" && out.place_mm);
    if (again)
      lowering_.sink.add(diagnostic_at(lowering_.source, word.span, Code::W0265,
                                       fmt::format("directive '{}' was given before: this one counts", word.text),
                                       "remove one of the two"));
    if (name == "MACHINE") {
      const Token& machine = take("machine", "a name");
      out.machine = machine.text, out.machine_span = machine.span;
    } else if (name == "MACHINES") {
      const Span at = peek() ? peek()->span : word.span;
      out.machines = number<int>("machines", "a whole number");
      if (*out.machines < 2)
        mistake(Code::E0114, at, "directive 'machines': at least two are needed, for a standard uncertainty",
                help_for("machines"));
    } else if (name == "SEED") {
      out.seed = number<std::uint64_t>("seed", "a whole number");
    } else if (name == "WORKPIECE") {
      const Token& workpiece = take("workpiece", "a file");
      out.workpiece = workpiece.text, out.workpiece_span = workpiece.span;
    } else if (name == "PLACE") {
      Vec3 place;
      for (int k = 0; k < 3; ++k) place[k] = number<double>("place", "a number in mm");
      out.place_mm = place;
    } else if (name == "ANSWER") {
      answer();
    } else if (name == "EXPECT") {
      expect();
    } else {
      unknown(word);
    }
  }

  /// Takes the rest of the comment: an answer may hold blanks.
  void answer() {
    const Token& first = take("answer", "NAME=VALUE");
    const std::string rest = comment_.text().substr(first.begin);
    next_ = tokens_.size();
    const std::size_t equals = rest.find('=');
    const std::string variable = upper(trimmed(rest.substr(0, equals)));
    if (equals == std::string::npos || variable.empty())
      mistake(Code::E0114, first.span, "directive 'answer': NAME=VALUE is expected here", help_for("answer"));
    if (!lowering_.out.directives.answers.emplace(variable, trimmed(rest.substr(equals + 1))).second)
      mistake(Code::E0114, first.span, fmt::format("directive 'answer': {} has an answer already", variable),
              "give every variable one answer");
  }

  [[noreturn]] void unknown(const Token& word) {
    std::vector<std::string_view> words;
    for (const DirectiveHelp& d : kKnownDirectives) words.push_back(d.word);
    const std::string near = nearest_word(word.text, words);
    mistake(Code::E0113, word.span, fmt::format("'{}' is not a directive", word.text),
            near.empty() ? fmt::format("known: {}", fmt::join(words, " ")) : fmt::format("did you mean {}?", near),
            near);
  }

  void expect() {
    Expectation e;
    e.line = line_;
    const std::string& text = comment_.text();
    e.text = text.substr(text.find_first_not_of(" \t", text.find('!') + 1));
    const Token* first = &take("expect", "TA(label) or accepted");
    while (const auto feature = label_of(first->text, "FA", "F")) {
      e.features.push_back(*feature);
      first = &take("expect", "TA(label)");
    }
    const Span subject_span = first->span;
    if (const auto tolerance = label_of(first->text, "TA", "T")) {
      e.subject = *tolerance;
      occurrence(e);
      quantity(e);
    } else if (upper(first->text) == "ACCEPTED" && e.features.empty()) {
      e.subject = e.quantity = "accepted";
    } else {
      mistake(Code::E0114, subject_span,
              fmt::format("directive 'expect': '{}' is neither TA(label) nor accepted", first->text),
              help_for("expect"));
    }
    bounds(e);
    occurrence(e);
    if (const Token* extra = peek())
      mistake(Code::E0114, extra->span, fmt::format("directive 'expect' takes no '{}' here", extra->text),
              help_for("expect"));
    lowering_.expectation_spans.push_back(subject_span);
    lowering_.out.directives.expectations.push_back(std::move(e));
  }

  void occurrence(Expectation& e) {
    if (!peek() || upper(peek()->text) != "OCCURRENCE") return;
    ++next_;
    const Span at = peek() ? peek()->span : whole_;
    e.occurrence = number<int>("expect", "a whole number");
    if (e.occurrence < 1) mistake(Code::E0114, at, "directive 'expect': occurrences count from 1", help_for("expect"));
  }

  void quantity(Expectation& e) {
    const Token& token = take("expect", "a quantity");
    e.quantity = token.text;
    if (std::find(kQuantities.begin(), kQuantities.end(), token.text) != kQuantities.end()) return;
    const std::string near = nearest_word(token.text, {kQuantities.begin(), kQuantities.end()});
    mistake(
        Code::E0114, token.span, fmt::format("directive 'expect': '{}' is not a quantity", token.text),
        near.empty() ? fmt::format("one of {}", fmt::join(kQuantities, " ")) : fmt::format("did you mean {}?", near),
        near);
  }

  void bounds(Expectation& e) {
    const Token& relation = take("expect", "between, >= or <=");
    if (upper(relation.text) == "BETWEEN") {
      e.low = number<double>("expect", "a number");
      const Span at = peek() ? peek()->span : whole_;
      e.high = number<double>("expect", "a number");
      if (*e.low > *e.high)
        mistake(Code::E0114, at, "directive 'expect': nothing lies between these bounds",
                "write the smaller bound first");
    } else if (relation.text == ">=") {
      e.low = number<double>("expect", "a number");
    } else if (relation.text == "<=") {
      e.high = number<double>("expect", "a number");
    } else {
      mistake(Code::E0114, relation.span,
              fmt::format("directive 'expect': '{}' is not between, >= or <=", relation.text), help_for("expect"));
    }
  }

  Lowering& lowering_;
  int line_;
  const JoinedText& comment_;
  const std::vector<Token> tokens_;
  const Span whole_;
  std::size_t next_ = 0;
};

bool is_of(const Expectation& e, const plan::Plan& plan, const plan::CharacteristicDef& c) {
  const auto evaluated = [&](const std::string& feature) {
    return std::any_of(c.features.begin(), c.features.end(),
                       [&](plan::FeatureId f) { return same_label(plan[f].label, feature); });
  };
  return same_label(plan[c.tolerance].label, e.subject) && std::all_of(e.features.begin(), e.features.end(), evaluated);
}

/// How often at most one line evaluates the same, as reports count occurrences; none where only the machines
/// know, in a loop that is run as one.
std::optional<int> most_occurrences(const plan::Plan& plan, const Expectation& e) {
  std::map<plan::EvaluatedAs, int> met;
  int most = 0;
  for (const plan::CharacteristicDef& c : plan.characteristics)
    if (is_of(e, plan, c)) most = std::max(most, ++met[plan::evaluated_as(plan, c)]);
  return most > 0 && !plan::loops(plan).empty() ? std::nullopt : std::optional(most);
}

bool is_directive(const LogicalLine& line) { return line.comment && line.comment->text().starts_with('!'); }

/// How many words behind its name a directive takes; `answer` and `expect` take the rest of the comment.
std::size_t words_of(std::string_view directive) {
  constexpr std::size_t kRest = 1000;
  return directive == "PLACE" ? 3 : directive == "ANSWER" || directive == "EXPECT" ? kRest : 1;
}

/// The first token of the directive that is not complete before `count`; `count` when the next one begins there.
std::size_t last_directive(const std::vector<Token>& tokens, std::size_t count) {
  std::size_t at = 0;
  while (at < count && at + words_of(upper(tokens[at].text)) < count) at += words_of(upper(tokens[at].text)) + 1;
  return at;
}

/// Behind these words of an `expect`.
DirectiveNext next_expected(std::span<const Token> before) {
  DirectiveNext next;
  const auto words = [&](std::initializer_list<std::string_view> list, std::string_view help) {
    for (const std::string_view word : list) next.words.push_back({word, "", help});
  };
  const auto is = [&](std::size_t from_end, std::string_view word) {
    return before.size() >= from_end && upper(before[before.size() - from_end].text) == word;
  };
  if (before.empty()) {
    next.kinds = {"FA", "TA"};
    words({"accepted"}, "share of the machines that satisfy the specification");
  } else if (before.size() == 1 && label_of(before[0].text, "FA", "F")) {
    next.kinds = {"TA"};
  } else if (const std::string& last = before.back().text; label_of(last, "TA", "T") || is(2, "OCCURRENCE")) {
    for (const std::string_view quantity : kQuantities) next.words.push_back({quantity, "", ""});
    if (!is(2, "OCCURRENCE")) words({"occurrence"}, "which evaluation of the tolerance, counted from 1");
  } else if (is(1, "ACCEPTED") || std::find(kQuantities.begin(), kQuantities.end(), last) != kQuantities.end()) {
    words({"between", ">=", "<="}, "");
  }
  return next;
}

}  // namespace

std::vector<LabelRef> directive_labels(const LogicalLine& line) {
  std::vector<LabelRef> out;
  if (!is_directive(line)) return out;
  const std::vector<Token> tokens = split(*line.comment);
  const std::size_t at = last_directive(tokens, tokens.size());
  if (at >= tokens.size()) return out;
  const std::string directive = upper(tokens[at].text);
  for (std::size_t k = at + 1; k < tokens.size() && directive == "EXPECT"; ++k)
    for (const auto& [kind, other] : {std::pair{"FA", "F"}, std::pair{"TA", "T"}})
      if (auto name = label_of(tokens[k].text, kind, other)) out.push_back({other, std::move(*name), tokens[k].span});
  if (directive != "ANSWER" || at + 1 >= tokens.size()) return out;
  const std::size_t begin = tokens[at + 1].begin;
  const std::string name = trimmed(line.comment->text().substr(begin, line.comment->text().find('=', begin) - begin));
  if (!name.empty()) out.push_back({"", name, line.comment->span(begin, begin + name.size())});
  return out;
}

DirectiveNext next_in_directive(const JoinedText& comment) {
  const std::vector<Token> tokens = split(comment);
  const bool half = !tokens.empty() && tokens.back().begin + tokens.back().text.size() == comment.text().size();
  const std::size_t count = tokens.size() - (half ? 1 : 0), at = last_directive(tokens, count);
  if (at >= count) return {{kKnownDirectives.begin(), kKnownDirectives.end()}, {}};
  if (upper(tokens[at].text) != "EXPECT") return {};
  return next_expected(std::span(tokens).subspan(at + 1, count - at - 1));
}

std::span<const DirectiveHelp> directives() { return kKnownDirectives; }

void read_directives(const LogicalLine& line, Lowering& lowering) {
  if (is_directive(line))
    DirectiveReader(*line.comment, lowering, lowering.source.place(line.comment->file_offset(0)).line).read();
}

void refuse_directives(const LogicalLine& line, Lowering& lowering) {
  if (!is_directive(line)) return;
  const JoinedText& comment = *line.comment;
  lowering.add(diagnostic_at(*lowering.file, comment.span(0, comment.text().size()), Code::E0127,
                             "a directive stands in the program, not in a module",
                             fmt::format("move it to '{}'", lowering.source.name())));
}

void check_expectations(Lowering& lowering) {
  const auto& expectations = lowering.out.directives.expectations;
  for (std::size_t i = 0; i < expectations.size(); ++i) {
    const Expectation& e = expectations[i];
    if (e.subject == "accepted" && e.quantity == "accepted") continue;
    const std::optional<int> most = most_occurrences(lowering.out.plan, e);
    if (!most || *most >= std::max(1, e.occurrence) || !lowering.out.lost.empty()) continue;
    lowering.sink.add(diagnostic_at(
        lowering.source, lowering.expectation_spans[i], Code::E0215,
        *most == 0 ? fmt::format("TA({}) is evaluated 0 times in this program", e.subject)
                   : fmt::format("no line of this program evaluates TA({}) more than {} time{}", e.subject, *most,
                                 *most == 1 ? "" : "s"),
        *most == 0 ? "expect a tolerance that OUTPUT or EVAL names"
                   : "occurrences are counted within a line, where a loop or a macro evaluates it again"));
  }
}

}  // namespace abbe::lang
