#include "lang/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "lang/intrinsics.hpp"
#include "lang/parser.hpp"

namespace abbe::lang {

namespace {

constexpr const char* kHasNoValue = "correct the numbers, or test them with IF before";

}  // namespace

plan::Expression combine(plan::Op2 op, plan::Expression left, const plan::Expression& right) {
  const double *a = plan::constant(left), *b = plan::constant(right);
  if (a && b) {
    const Outcome<double> v = plan::apply(op, *a, *b);
    if (!v) throw Mistake{Code::E0119, 0, 0, fmt::format("this is {}", v.failure), kHasNoValue, ""};
    return {plan::PushConstant{v.value}};
  }
  if (left.size() + right.size() >= kLargestExpression)
    throw Mistake{Code::E0104,
                  0,
                  0,
                  fmt::format("this expression has more than {} numbers and operators", kLargestExpression),
                  "assign parts of it to variables first",
                  ""};
  left.insert(left.end(), right.begin(), right.end());
  left.push_back(op);
  if (plan::stack_depth(left) > plan::kExpressionStack)
    throw Mistake{Code::E0104, 0, 0, "this expression is nested too deep", "assign parts of it to variables first", ""};
  return left;
}

plan::Expression combine(plan::Op1 op, plan::Expression operand) {
  if (const double* a = plan::constant(operand)) {
    const Outcome<double> v = plan::apply(op, *a);
    if (!v) throw Mistake{Code::E0119, 0, 0, fmt::format("this is {}", v.failure), kHasNoValue, ""};
    return {plan::PushConstant{v.value}};
  }
  operand.push_back(op);
  return operand;
}

namespace {

struct Operator {
  std::string_view text;
  plan::Op2 op;
};
constexpr std::array kComparisons = {Operator{".EQ.", plan::Op2::equal},   Operator{".NE.", plan::Op2::not_equal},
                                     Operator{".LT.", plan::Op2::less},    Operator{".LE.", plan::Op2::less_equal},
                                     Operator{".GT.", plan::Op2::greater}, Operator{".GE.", plan::Op2::greater_equal}};
constexpr std::array<std::string_view, 5> kDotted = {".AND.", ".OR.", ".NOT.", ".TRUE.", ".FALSE."};

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Recursive descent, one function per level of precedence.
class Reader {
 public:
  Reader(std::string_view text, std::size_t begin, std::size_t end, Names& names)
      : text_(text.substr(0, end)), at_(begin), names_(names) {}

  Value read() {
    Value v = any();
    skip();
    if (at_ < text_.size())
      fail(at_, text_.size(), fmt::format("'{}' does not belong to this expression", text_.substr(at_)),
           "an operator is missing, or one too many is written");
    return v;
  }

 private:
  [[noreturn]] void fail(std::size_t begin, std::size_t end, std::string message, std::string help = "") const {
    throw Mistake{Code::E0119, begin, std::max(end, begin + 1), std::move(message), std::move(help), ""};
  }

  /// Runs `f` and gives a mistake without a place the place [begin, here).
  template <class F>
  auto located(std::size_t begin, F&& f) {
    try {
      return f();
    } catch (Mistake& m) {
      if (m.end == 0) {
        m.begin = begin;
        m.end = at_;
      }
      throw;
    }
  }

  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  char peek() {
    skip();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool sees(std::string_view word) {
    skip();
    return upper(text_.substr(at_, word.size())) == word;
  }
  bool take(std::string_view word) {
    if (!sees(word)) return false;
    at_ += word.size();
    return true;
  }

  Value any() {
    if (++depth_ > kMaximumNesting + 1)
      throw Mistake{Code::E0104,
                    at_,
                    at_ + 1,
                    fmt::format("this is nested deeper than {}", kMaximumNesting),
                    "assign parts of it to variables first",
                    ""};
    Value left = all();
    for (std::size_t begin = at_; take(".OR.");)
      left = logical(plan::Op2::logical_or, ".OR.", std::move(left), all(), begin);
    --depth_;
    return left;
  }

  Value all() {
    Value left = negation();
    for (std::size_t begin = at_; take(".AND.");)
      left = logical(plan::Op2::logical_and, ".AND.", std::move(left), negation(), begin);
    return left;
  }

  Value logical(plan::Op2 op, std::string_view word, Value left, const Value& right, std::size_t begin) {
    for (const Value* v : {static_cast<const Value*>(&left), &right})
      if (v->type != Type::boolean)
        fail(begin, at_, fmt::format("{} joins logical values, this is {}", word, name_of(v->type)),
             "compare first: (A .GT. 1) .AND. (B .LT. 2)");
    left.parts[0] = combine(op, std::move(left.parts[0]), right.parts[0]);
    return left;
  }

  Value negation() {
    skip();
    const std::size_t begin = at_;
    bool negate = false, any_not = false;
    while (take(".NOT.")) {
      negate = !negate;
      any_not = true;
    }
    Value v = comparison();
    if (any_not && v.type != Type::boolean)
      fail(begin, at_, fmt::format(".NOT. takes a logical value, this is {}", name_of(v.type)));
    if (negate) v.parts[0] = combine(plan::Op1::logical_not, std::move(v.parts[0]));
    return v;
  }

  Value comparison() {
    skip();
    const std::size_t begin = at_;
    Value left = sum();
    for (const Operator& o : kComparisons) {
      if (!take(o.text)) continue;
      const Value right = sum();
      const bool numbers = left.is_number() && right.is_number();
      const bool same = left.type == right.type && left.type != Type::vector;
      const bool ordered = o.op != plan::Op2::equal && o.op != plan::Op2::not_equal;
      if (!numbers && (!same || ordered))
        fail(begin, at_, fmt::format("{} cannot compare {} with {}", o.text, name_of(left.type), name_of(right.type)),
             ordered ? "only numbers have an order" : "compare values of the same type");
      return located(begin, [&] {
        return Value{Type::boolean, {combine(o.op, std::move(left.parts[0]), right.parts[0])}};
      });
    }
    return left;
  }

  Value sum() {
    skip();
    const std::size_t begin = at_;
    Value left = product();
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      ++at_;
      left = arithmetic(c == '+' ? plan::Op2::add : plan::Op2::subtract, std::move(left), product(), begin);
    }
    return left;
  }

  Value product() {
    skip();
    const std::size_t begin = at_;
    Value left = signed_power();
    for (char c = peek(); c == '*' || c == '/'; c = peek()) {
      ++at_;
      left = arithmetic(c == '*' ? plan::Op2::multiply : plan::Op2::divide, std::move(left), signed_power(), begin);
    }
    return left;
  }

  bool take_signs() {
    bool negative = false;
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      ++at_;
      negative ^= c == '-';
    }
    return negative;
  }

  Value signed_power() {
    skip();
    const std::size_t begin = at_;
    const bool negative = take_signs();
    return signed_value(negative, power(), begin);
  }

  Value signed_value(bool negative, Value v, std::size_t begin) {
    if (!negative) return v;
    if (!v.is_number() && v.type != Type::vector)
      fail(begin, at_, fmt::format("a sign before {}", name_of(v.type)), "signs belong to numbers");
    for (plan::Expression& part : v.parts) part = combine(plan::Op1::negate, std::move(part));
    return v;
  }

  /// 2 ** 3 ** 2 is 2 ** (3 ** 2).
  Value power() {
    skip();
    const std::size_t begin = at_;
    std::vector<Value> list{primary()};
    while (take("**")) {
      const bool negative = take_signs();
      list.push_back(signed_value(negative, primary(), begin));
    }
    while (list.size() > 1) {
      Value exponent = std::move(list.back());
      list.pop_back();
      list.back() = arithmetic(plan::Op2::power, std::move(list.back()), std::move(exponent), begin);
    }
    return std::move(list[0]);
  }

  Value arithmetic(plan::Op2 op, Value left, Value right, std::size_t begin) {
    using enum plan::Op2;
    const bool both = left.is_number() && right.is_number();
    const bool vectors = left.type == Type::vector && right.type == Type::vector && (op == add || op == subtract);
    const bool scaled = left.type == Type::vector && right.is_number() && (op == multiply || op == divide);
    if (op == multiply && left.is_number() && right.type == Type::vector)
      return arithmetic(op, std::move(right), std::move(left), begin);
    if (!both && !vectors && !scaled)
      fail(begin, at_, fmt::format("no arithmetic between {} and {}", name_of(left.type), name_of(right.type)),
           left.type == Type::text || right.type == Type::text
               ? "VAL(text) makes a number of a text, CONCAT joins texts"
               : "");
    return located(begin, [&] {
      for (std::size_t k = 0; k < left.parts.size(); ++k)
        left.parts[k] = combine(op, std::move(left.parts[k]), right.parts[vectors ? k : 0]);
      if (both && (op == divide || op == power || right.type == Type::real)) left.type = Type::real;
      return std::move(left);
    });
  }

  Value primary() {
    const char c = peek();
    const std::size_t begin = at_;
    if (c == '(') {
      ++at_;
      Value v = any();
      if (peek() != ')') fail(begin, begin + 1, "this '(' is not closed");
      ++at_;
      return v;
    }
    if (c == '\'') return quoted();
    if (take(".TRUE.")) return boolean(true);
    if (take(".FALSE.")) return boolean(false);
    if (is_digit(c) || c == '.') return literal();
    if (is_letter(c)) return named();
    if (c == '\0') fail(begin == 0 ? 0 : begin - 1, begin, "a value is missing at the end of this expression");
    fail(begin, begin + 1, fmt::format("a value is expected here, not '{}'", c),
         "a value is a number, a variable, a function or a text");
  }

  Value quoted() {
    std::string out;
    const std::size_t begin = at_++;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\'') {
        if (text_.substr(at_ + 1, 1) != "'") return ++at_, names_.texts().value(out);
        ++at_;
      }
      out += text_[at_];
    }
    fail(begin, at_, "this text is not closed");
  }

  /// The dot of 3.EQ.X belongs to the operator.
  bool dot_is_operator() const {
    const std::string next = upper(text_.substr(at_, 7));
    return std::any_of(kComparisons.begin(), kComparisons.end(),
                       [&](const Operator& o) { return next.starts_with(o.text); }) ||
        std::any_of(kDotted.begin(), kDotted.end(), [&](std::string_view w) { return next.starts_with(w); });
  }

  Value literal() {
    const std::size_t begin = at_;
    bool whole = true;
    const auto digits = [&] {
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    };
    digits();
    if (at_ < text_.size() && text_[at_] == '.' && !dot_is_operator()) {
      whole = false;
      ++at_;
      digits();
    }
    const std::size_t before_exponent = at_;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      if (at_ < text_.size() && is_digit(text_[at_])) {
        whole = false;
        digits();
      } else {
        at_ = before_exponent;
      }
    }
    double v = 0;
    const auto result = std::from_chars(text_.data() + begin, text_.data() + at_, v);
    const std::string_view written = text_.substr(begin, std::max(at_, begin + 1) - begin);
    if (result.ec == std::errc{} && v > kLargestNumber)
      fail(begin, at_, fmt::format("'{}' is larger than anything that is measured", written));
    if (result.ec != std::errc{} || result.ptr != text_.data() + at_)
      fail(begin, at_, fmt::format("'{}' is not a number", written));
    return whole ? integer(v) : number(v);
  }

  Value named() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    const std::size_t name_end = at_;
    const char next = peek();
    if (next == '[') return element(name, begin, ']');
    if (next == '(') {
      if (const Intrinsic* f = find_intrinsic(upper(name))) return call(*f, begin);
      if (located(begin, [&] { return names_.variable(name, integer(1)); })) return element(name, begin, ')');
      std::vector<std::string_view> words;
      for (const Intrinsic& f : intrinsics()) words.push_back(f.name);
      const std::string near = nearest_word(name, words);
      throw Mistake{Code::E0119,
                    begin,
                    name_end,
                    fmt::format("{} is not a function", name),
                    near.empty() ? "`abbe explain` lists the functions" : fmt::format("did you mean {}?", near),
                    near};
    }
    at_ = name_end;
    if (auto v = located(begin, [&] { return names_.variable(name, std::nullopt); })) return std::move(*v);
    const std::string word = upper(name);
    if (word == "TRUE" || word == "FALSE") return boolean(word == "TRUE");
    const std::string near = names_.near(name);
    throw Mistake{Code::E0230,
                  begin,
                  name_end,
                  fmt::format("{} is no variable here", name),
                  near.empty() ? fmt::format("declare it and give it a value: DECL/REAL,{0}, then {0}=ASSIGN/...", name)
                               : fmt::format("did you mean {}?", near),
                  near};
  }

  Value element(std::string_view name, std::size_t begin, char close) {
    const std::size_t open = at_++;
    const Value index = any();
    if (peek() != close) fail(open, open + 1, fmt::format("this '{}' is not closed", text_[open]));
    ++at_;
    if (!index.is_index())
      fail(open + 1, at_ - 1, fmt::format("an index is a whole number, this is {}", name_of(index.type)));
    auto v = located(begin, [&] { return names_.variable(name, index); });
    if (!v)
      throw Mistake{Code::E0230,
                    begin,
                    open,
                    fmt::format("{} is no variable here", name),
                    fmt::format("declare it: DECL/REAL,{}[10]", name),
                    ""};
    return std::move(*v);
  }

  Value call(const Intrinsic& f, std::size_t begin) {
    ++at_;
    std::vector<Value> arguments;
    if (peek() != ')') arguments.push_back(any());
    while (!arguments.empty() && (peek() == ',' || peek() == ':')) {
      ++at_;
      arguments.push_back(any());
    }
    if (peek() != ')')
      fail(at_, at_ + 1, fmt::format("the arguments of {} end with ')'", f.name), fmt::format("write {}", f.form));
    ++at_;
    return located(begin, [&] { return apply(f, std::move(arguments), names_.texts()); });
  }

  std::string_view text_;
  std::size_t at_;
  Names& names_;
  int depth_ = 0;
};

}  // namespace

Evaluation evaluate(std::string_view text, std::size_t begin, std::size_t end, Names& names) {
  try {
    return Reader(text, begin, end, names).read();
  } catch (Mistake& m) {
    if (m.end == 0) {
      m.begin = begin;
      m.end = end;
    }
    return std::move(m);
  }
}

}  // namespace abbe::lang
