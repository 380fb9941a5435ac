#include "lang/signature.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/ids.hpp"
#include "lang/intrinsics.hpp"

namespace abbe::lang {

namespace {

using ItemKind = SignatureItem::Kind;

struct TypeInfo {
  ValueType type;
  std::string_view name, article_name;
  std::array<std::string_view, 2> label_kinds;  ///< which labels it takes; none for values
};

constexpr std::array kTypes = {
    TypeInfo{ValueType::number, "number", "a number", {}},
    TypeInfo{ValueType::length, "length", "a length", {}},
    TypeInfo{ValueType::angle, "angle", "an angle", {}},
    TypeInfo{ValueType::integer, "integer", "a whole number", {}},
    TypeInfo{ValueType::text, "text", "a text in quotes", {}},
    TypeInfo{ValueType::feature, "feature", "a feature FA(...)", {"FA", "F"}},
    TypeInfo{ValueType::datum, "datum", "a datum DAT(...)", {"DAT", "FA"}},
    TypeInfo{ValueType::tolerance, "tolerance", "a tolerance TA(...)", {"TA", "T"}},
    TypeInfo{ValueType::sensor, "sensor", "a sensor S(...)", {"SA", "S"}},
    TypeInfo{ValueType::frame, "frame", "a coordinate system D(...)", {"DA", "D"}},
    TypeInfo{ValueType::label, "label", "a label", {}},
    TypeInfo{ValueType::word, "word", "a word", {}},
    TypeInfo{ValueType::condition, "condition", "a condition", {}},
    TypeInfo{ValueType::value, "value", "a value", {}},
};

const TypeInfo& type_info(ValueType type) { return kTypes[static_cast<std::size_t>(type)]; }

/// Recursive descent over the notation.
class NotationReader {
 public:
  explicit NotationReader(std::string_view text) : text_(text) {}

  Signature read() {
    Signature out = items();
    ABBE_CHECK(at_ == text_.size());
    return out;
  }

 private:
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == ',' || text_[at_] == '\n')) ++at_;
  }
  char peek() {
    skip();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  void expect(char c) {
    ABBE_CHECK(peek() == c);
    ++at_;
  }

  Signature items() {
    Signature out;
    for (char c = peek(); c != '\0' && c != ']' && c != '}' && c != ')' && c != ';'; c = peek()) out.push_back(item(c));
    return out;
  }

  SignatureItem item(char c) {
    if (c == '[') return bracketed(ItemKind::optional, ']');
    if (c == '{') return bracketed(ItemKind::repeat, '}');
    if (c == '(') return bracketed(ItemKind::alternatives, ')');
    SignatureItem out;
    if (text_.substr(at_, 3) == "...") {
      at_ += 3;
      out.kind = ItemKind::rest;
      return out;
    }
    std::string token = name();
    if (at_ < text_.size() && text_[at_] == ':') {
      ++at_;
      out.name = std::move(token);
      token = name();
    }
    for (const TypeInfo& info : kTypes) {
      if (out.name.empty() || token != info.name) continue;
      out.kind = ItemKind::value;
      out.type = info.type;
      return out;
    }
    out.kind = ItemKind::words;
    for (out.words.push_back(token); at_ < text_.size() && text_[at_] == '|';) {
      ++at_;
      out.words.push_back(name());
    }
    for (const std::string& word : out.words) ABBE_CHECK(word == upper(word));
    return out;
  }

  SignatureItem bracketed(ItemKind kind, char close) {
    ++at_;
    SignatureItem out;
    out.kind = kind;
    out.branches.push_back(items());
    while (kind == ItemKind::alternatives && peek() == ';') {
      ++at_;
      out.branches.push_back(items());
    }
    expect(close);
    return out;
  }

  std::string name() {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' || text_[at_] == '-'))
      ++at_;
    ABBE_CHECK(at_ > begin);
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// Matches one signature against arguments and remembers the furthest failure.
class Matcher {
 public:
  Matcher(std::span<const RawArgument> arguments, const Units& units, const Evaluator& evaluator)
      : arguments_(arguments), units_(units), evaluator_(evaluator), computed_(arguments.size()) {}

  std::variant<Match, Mismatch> run(const Signature& signature) {
    if (!sequence(signature)) {
      furthest_.mistake = mistake_at(furthest_.argument);
      return std::move(furthest_);
    }
    if (!rest_taken_ && at_ < arguments_.size()) {
      if (furthest_.argument < at_) furthest_ = {at_, {}, {}, {}};
      furthest_.complete = furthest_.argument == at_;
      furthest_.mistake = mistake_at(furthest_.argument);
      return std::move(furthest_);
    }
    match_.used = at_;
    return std::move(match_);
  }

 private:
  bool sequence(const Signature& items) {
    return std::all_of(items.begin(), items.end(), [&](const SignatureItem& item) { return one(item); });
  }

  /// Like sequence, but leaves no trace when it fails.
  bool attempt(const Signature& items) {
    const std::size_t at = at_, values = match_.values.size();
    if (sequence(items)) return true;
    at_ = at;
    match_.values.resize(values);
    return false;
  }

  bool one(const SignatureItem& item) {
    switch (item.kind) {
      case ItemKind::optional: attempt(item.branches[0]); return true;
      case ItemKind::repeat: return repeat(item.branches[0]);
      case ItemKind::alternatives:
        return std::any_of(item.branches.begin(), item.branches.end(), [&](const Signature& s) { return attempt(s); });
      case ItemKind::rest: return rest_taken_ = true;
      case ItemKind::words: return word(item);
      case ItemKind::value: return value(item);
    }
    return false;
  }

  bool repeat(const Signature& items) {
    for (std::size_t before = at_; attempt(items) && at_ > before;) before = at_;
    return true;
  }

  bool word(const SignatureItem& item) {
    if (at_ < arguments_.size() && is_word(arguments_[at_]) &&
        std::find(item.words.begin(), item.words.end(), arguments_[at_].word) != item.words.end()) {
      if (!item.name.empty()) keep(item, ValueType::word, arguments_[at_].word, 0);
      ++at_;
      return true;
    }
    std::string list;
    for (const std::string& w : item.words) list += (list.empty() ? "" : "|") + w;
    failed(list, item.words);
    return false;
  }

  bool value(const SignatureItem& item) {
    if (at_ < arguments_.size() && take(item, arguments_[at_])) {
      ++at_;
      return true;
    }
    failed(fmt::format("{} ({})", type_info(item.type).article_name, item.name), {});
    return false;
  }

  bool take(const SignatureItem& item, const RawArgument& argument) {
    switch (item.type) {
      case ValueType::number: return take_number(item, argument, Quantity::number);
      case ValueType::integer: return take_number(item, argument, Quantity::number);
      case ValueType::length: return take_number(item, argument, Quantity::length);
      case ValueType::angle: return take_number(item, argument, Quantity::angle);
      case ValueType::text:
        if (argument.kind == RawArgument::Kind::text) keep(item, item.type, argument.text, 0);
        return argument.kind == RawArgument::Kind::text;
      case ValueType::condition:
      case ValueType::value: return take_value(item, argument);
      case ValueType::word:
        if (is_word(argument)) keep(item, item.type, argument.word, 0);
        return is_word(argument);
      default: return take_label(item, argument);
    }
  }

  bool take_number(const SignatureItem& item, const RawArgument& argument, Quantity quantity) {
    const auto suits = [&](double v) { return item.type != ValueType::integer || v == std::floor(v); };
    if (const std::optional<double> number = constant(argument, quantity, units_)) {
      if (suits(*number)) keep(item, item.type, argument.text, *number);
      return suits(*number);
    }
    const Value* value = computed(argument);
    if (!value || !value->is_number()) return false;
    if (item.type == ValueType::integer && value->type == Type::real && !value->known()) return false;
    Value scaled = *value;
    const double factor = unit_of(quantity, units_);
    if (factor != 1)
      scaled.parts[0] = combine(plan::Op2::multiply, std::move(scaled.parts[0]), {plan::PushConstant{factor}});
    if (!scaled.known()) {
      keep(item, item.type, argument.text, 0);
      match_.values.back().value = std::move(scaled);
      return true;
    }
    if (suits(scaled.constant())) keep(item, item.type, argument.text, scaled.constant());
    return suits(scaled.constant());
  }

  bool take_value(const SignatureItem& item, const RawArgument& argument) {
    const Value* value = computed(argument);
    if (!value) must_have_value_ = at_;
    if (!value || (item.type == ValueType::condition && value->type != Type::boolean)) return false;
    keep(item, item.type, argument.text, 0);
    match_.values.back().value = *value;
    return true;
  }

  /// The value of an argument that may be an expression, computed once; nullptr when it has none.
  const Value* computed(const RawArgument& argument) {
    using K = RawArgument::Kind;
    if (!evaluator_ || argument.kind == K::empty || argument.kind == K::several) return nullptr;
    std::optional<Evaluation>& known = computed_[static_cast<std::size_t>(&argument - arguments_.data())];
    if (!known) known = evaluator_(argument);
    return std::get_if<Value>(&*known);
  }

  /// Why the argument that nothing suited has no value; nothing for a word or a label that may be meant as one.
  std::optional<Mistake> mistake_at(std::size_t at) const {
    if (at >= arguments_.size() || !computed_[at]) return std::nullopt;
    const RawArgument& a = arguments_[at];
    constexpr std::size_t kLongestLabelKind = 3;  // a longer word before a parenthesis is meant as a function
    const bool function =
        a.kind == RawArgument::Kind::label && (find_intrinsic(a.label.kind) || a.label.kind.size() > kLongestLabelKind);
    const bool meant_as_value = a.kind == RawArgument::Kind::expression || function || at == must_have_value_;
    const auto* mistake = std::get_if<Mistake>(&*computed_[at]);
    return mistake && (meant_as_value || mistake->of_variable) ? std::optional(*mistake) : std::nullopt;
  }

  bool take_label(const SignatureItem& item, const RawArgument& argument) {
    if (argument.kind != RawArgument::Kind::label) return false;
    const auto& kinds = type_info(item.type).label_kinds;
    if (item.type != ValueType::label && argument.label.kind != kinds[0] && argument.label.kind != kinds[1])
      return false;
    keep(item, item.type, argument.label.name, 0);
    return true;
  }

  static bool is_word(const RawArgument& argument) { return argument.kind == RawArgument::Kind::word; }

  void keep(const SignatureItem& item, ValueType type, std::string text, double number) {
    match_.values.push_back(
        {item.name, type, number, std::nullopt, {}, std::move(text), arguments_[at_].label, arguments_[at_].span});
  }

  void failed(std::string expected, const std::vector<std::string>& words) {
    if (at_ > furthest_.argument) furthest_ = {at_, {}, {}, {}};
    if (at_ < furthest_.argument) return;
    if (std::find(furthest_.expected.begin(), furthest_.expected.end(), expected) == furthest_.expected.end())
      furthest_.expected.push_back(std::move(expected));
    furthest_.words.insert(furthest_.words.end(), words.begin(), words.end());
  }

  std::span<const RawArgument> arguments_;
  const Units& units_;
  const Evaluator& evaluator_;
  std::vector<std::optional<Evaluation>> computed_;  ///< by argument
  Match match_;
  Mismatch furthest_;
  std::size_t at_ = 0;
  std::optional<std::size_t> must_have_value_;  ///< an argument where only a value can stand
  bool rest_taken_ = false;
};

/// Blanks between values, outside quotes and parentheses, become commas: how the text was meant.
std::string with_commas(std::string_view text) {
  std::string out;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\'') quoted = !quoted;
    if (!quoted) depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    const bool blank = c == ' ' || c == '\t';
    if (quoted || depth > 0 || !blank) {
      out += c;
      continue;
    }
    i = text.find_first_not_of(" \t", i) - 1;  // the text has no blanks at its end
    if (text[i + 1] != '(') out += ',';
  }
  return out;
}

/// Words that the standard allows behind the arguments of GEOALG and TOL.
bool is_not_supported(std::string_view what, const RawArgument& a) {
  return (what == "GEOALG" || what.starts_with("TOL/")) && a.kind == RawArgument::Kind::word &&
      (a.word == "MINMAX" || a.word == "FILTER" || a.word == "OFF");
}

std::string either(const std::vector<std::string>& list) {
  std::string out;
  for (std::size_t i = 0; i < list.size(); ++i) out += (i == 0 ? "" : i + 1 == list.size() ? " or " : ", ") + list[i];
  return out;
}

}  // namespace

Signature parse_signature(std::string_view text) { return NotationReader(text).read(); }

const MatchedValue* Match::find(std::string_view name) const {
  const auto it = std::find_if(values.begin(), values.end(), [&](const MatchedValue& v) { return v.name == name; });
  return it == values.end() ? nullptr : &*it;
}
double Match::number(std::string_view name, double otherwise) const {
  const MatchedValue* value = find(name);
  return value ? value->number : otherwise;
}
std::string Match::text(std::string_view name, std::string_view otherwise) const {
  const MatchedValue* value = find(name);
  return value ? value->text : std::string(otherwise);
}

std::variant<Match, Mismatch> match(const Signature& signature, std::span<const RawArgument> arguments,
                                    const Units& units, const Evaluator& evaluator) {
  return Matcher(arguments, units, evaluator).run(signature);
}

Diagnostic describe(const Mismatch& mismatch, std::span<const RawArgument> arguments, std::string_view what,
                    std::size_t first, Span statement, const SourceFile& source) {
  const std::string expected = either(mismatch.expected);
  const std::size_t number = mismatch.argument + first + 1;
  const std::string see =
      fmt::format("`abbe explain {}` shows all arguments", what.substr(what.find_last_of("/,") + 1));
  if (mismatch.argument >= arguments.size()) {
    const Span end{statement.end > statement.begin ? statement.end - 1 : statement.end, statement.end};
    return diagnostic_at(source, end, Code::E0107,
                         fmt::format("{} ends where argument {} should be {}", what, number, expected), see);
  }
  const RawArgument& written = arguments[mismatch.argument];
  if (written.kind == RawArgument::Kind::several) {
    const bool difference = written.text.find_first_of("+-", 1) != std::string::npos;
    return diagnostic_at(source, written.span, Code::E0105, fmt::format("a comma is missing in '{}'", written.text),
                         fmt::format("arguments are separated by commas{}",
                                     difference ? "; a sum has blanks on both sides of its sign, or none" : ""),
                         with_commas(written.text));
  }
  if (is_not_supported(what, written))
    return diagnostic_at(source, written.span, expected.empty() ? Code::E0108 : Code::E0106,
                         fmt::format("{} of {} is not supported yet", written.word, what),
                         fmt::format("leave it out where nothing depends on it; {}", see));
  const bool limits_bonus = what.starts_with("TOL/") && written.kind == RawArgument::Kind::number &&
      mismatch.argument > 0 &&
      (arguments[mismatch.argument - 1].word == "MMC" || arguments[mismatch.argument - 1].word == "LMC");
  if (limits_bonus)
    return diagnostic_at(source, written.span, Code::E0106,
                         fmt::format("a greatest bonus of {} is not supported yet", what),
                         fmt::format("leave it out; {}", see));
  if (expected.empty())
    return diagnostic_at(source, written.span, Code::E0108,
                         fmt::format("{} takes no argument {} ('{}')", what, number, written.text), see);
  const bool computed = written.kind == RawArgument::Kind::expression;
  const std::string as_written = written.kind == RawArgument::Kind::empty ? "empty" : "'" + written.text + "'";
  const std::string message = fmt::format("argument {} of {} is {}, expected {}{}", number, what, as_written, expected,
                                          mismatch.complete ? " or nothing more" : "");
  if (computed)
    return diagnostic_at(source, written.span, Code::E0111, message, "an expression gives a number or a logical value");
  const std::vector<std::string_view> words(mismatch.words.begin(), mismatch.words.end());
  const std::string near = written.kind == RawArgument::Kind::word ? nearest_word(written.word, words) : "";
  return diagnostic_at(source, written.span, Code::E0106, message,
                       near.empty() ? see : fmt::format("did you mean {}?", near), near);
}

}  // namespace abbe::lang
