#include "lang/intrinsics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "engine/base/letter_case.hpp"
#include "engine/base/numbers.hpp"
#include "engine/base/utf8.hpp"
#include "engine/math/axis.hpp"
#include "engine/math/units.hpp"
#include "lang/expression.hpp"

namespace abbe::lang {

namespace {

using Values = std::vector<Value>;
using plan::Op1, plan::Op2;

plan::Expression constant_of(double v) { return {plan::PushConstant{v}}; }
Value real(plan::Expression e) { return {Type::real, {std::move(e)}}; }
Value whole(plan::Expression e) { return {Type::integer, {std::move(e)}}; }
plan::Expression times(plan::Expression a, const plan::Expression& b) {
  return combine(Op2::multiply, std::move(a), b);
}
plan::Expression minus(plan::Expression a, const plan::Expression& b) {
  return combine(Op2::subtract, std::move(a), b);
}

[[noreturn]] void refuse(std::string message, std::string help = "") {
  throw Mistake{Code::E0119, 0, 0, std::move(message), std::move(help), ""};
}

template <Op1 op>
Value function(Values& a, Texts&) {
  return real(combine(op, std::move(a[0].parts[0])));
}
/// Of the type of its argument.
template <Op1 op>
Value same(Values& a, Texts&) {
  a[0].parts[0] = combine(op, std::move(a[0].parts[0]));
  return std::move(a[0]);
}
template <Op1 op>
Value to_integer(Values& a, Texts&) {
  return whole(combine(op, std::move(a[0].parts[0])));
}
/// From left to right over all arguments.
template <Op2 op>
Value chained(Values& a, Texts&) {
  Value v = std::move(a[0]);
  for (std::size_t k = 1; k < a.size(); ++k) {
    v.parts[0] = combine(op, std::move(v.parts[0]), a[k].parts[0]);
    if (a[k].type == Type::real) v.type = Type::real;
  }
  return v;
}
Value angle_of_point(Values& a, Texts&) { return real(combine(Op2::atan2, std::move(a[0].parts[0]), a[1].parts[0])); }
Value degrees_to_radians(Values& a, Texts&) { return real(times(std::move(a[0].parts[0]), constant_of(kDegree))); }
Value radians_to_degrees(Values& a, Texts&) {
  return real(times(std::move(a[0].parts[0]), constant_of(in_degrees(1))));
}
template <std::size_t k>
Value part(Values& a, Texts&) {
  return real(std::move(a[0].parts[k]));
}

plan::Expression dot(const Value& a, const Value& b) {
  plan::Expression sum = times(a.parts[0], b.parts[0]);
  for (std::size_t k = 1; k < 3; ++k) sum = combine(Op2::add, std::move(sum), times(a.parts[k], b.parts[k]));
  return sum;
}

Value cross(Values& v, Texts&) {
  Value out{Type::vector, {}};
  const Value &a = v[0], &b = v[1];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    out.parts.push_back(minus(times(a.parts[i], b.parts[j]), times(a.parts[j], b.parts[i])));
  }
  return out;
}

Value unit_vector(Values& a, Texts&) {
  const plan::Expression length = combine(Op1::sqrt, dot(a[0], a[0]));
  for (plan::Expression& p : a[0].parts) p = combine(Op2::divide, std::move(p), length);
  return std::move(a[0]);
}

Value polar(Values& a, Texts&) {
  const auto &r = a[0].parts[0], &angle = a[1].parts[0];
  return {Type::vector, {times(combine(Op1::cos, angle), r), times(combine(Op1::sin, angle), r), a[2].parts[0]}};
}

Value temperature(Values&, Texts&) {
  refuse("QTEMP has no value here: the program's temperature sensors are not simulated",
         "temperatures stand in the workpiece file");
}

// ---- texts

/// Cut before it is converted: most numbers are no int.
int count_up_to(int most, double asked) { return asked > 0 ? static_cast<int>(std::min(asked, double(most))) : 0; }

/// What STR writes: as few digits as identify the number, or `decimals` digits after the point, in at least
/// `width` characters.
Value number_text(Values& a, Texts& texts) {
  const Value& v = a[0];
  if (v.type == Type::text) return std::move(a[0]);
  std::string text;
  for (std::size_t k = 0; k < v.parts.size(); ++k)
    text += (k ? "," : "") +
        (a.size() > 2 ? fmt::format("{:.{}f}", v.constant(k) + 0.0, count_up_to(17, a[2].constant()))
                      : fmt::format("{}", v.constant(k) + 0.0));
  const int width = a.size() > 1 ? count_up_to(255, a[1].constant()) : 0;
  return texts.value(fmt::format("{:>{}}", text, width));
}

Value text_number(Values& a, Texts& texts) {
  std::string_view text = texts[a[0]];
  const auto blank = [](char c) { return c == ' '; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  const std::optional<double> v = finite_number(text);
  if (!v) refuse(fmt::format("the text '{}' is not a number", texts[a[0]]), "VAL takes a text like '12.5'");
  return text.find_first_of(".eE") == std::string_view::npos ? integer(*v) : number(*v);
}

Value joined(Values& a, Texts& texts) {
  std::string text;
  for (const Value& v : a) text += texts[v];
  if (text.size() > 65536) refuse("this text is longer than 65536 characters");
  return texts.value(text);
}

template <std::string (*f)(std::string_view)>
Value letters(Values& a, Texts& texts) {
  return texts.value(f(texts[a[0]]));
}

Value character_count(Values& a, Texts& texts) { return integer(static_cast<double>(count_characters(texts[a[0]]))); }

Value piece(Values& a, Texts& texts) {
  const std::string text = texts[a[0]];
  const double size = static_cast<double>(count_characters(text)), first = a[1].constant(),
               last = a.size() > 2 ? a[2].constant() : size;
  if (!(first >= 1 && last <= size && first <= last + 1))
    refuse(fmt::format("characters {} to {} of a text of {}", first, last, size),
           "SUBSTR(text,first,last) counts from 1");
  const std::string_view start = first_characters(text, static_cast<std::size_t>(last));
  return texts.value(start.substr(first_characters(start, static_cast<std::size_t>(first) - 1).size()));
}

Value position(Values& a, Texts& texts) {
  const std::string_view text = texts[a[0]];
  const std::size_t at = text.find(texts[a[1]]);
  return integer(at == std::string::npos ? 0 : static_cast<double>(count_characters(text.substr(0, at)) + 1));
}

Value trimmed(Values& a, Texts& texts) {
  std::string text = texts[a[0]];
  text.erase(text.find_last_not_of(' ') + 1);
  return texts.value(text);
}

Value character(Values& a, Texts& texts) {
  const double code = a[0].constant();
  if (!(code >= 0 && code <= 255)) refuse(fmt::format("there is no character {}", code), "CHR takes 0 to 255");
  std::string text;
  append_utf8(text, static_cast<char32_t>(code));
  return texts.value(text);
}

Value code_of(Values& a, Texts& texts) {
  const std::string& text = texts[a[0]];
  if (text.empty()) refuse("an empty text has no first character");
  return integer(static_cast<double>(character_at(text, 0).code));
}

// clang-format off
constexpr std::array kIntrinsics = {
    Intrinsic{"ABS", "ABS(x)", "n", "absolute value", same<Op1::abs>},
    Intrinsic{"ACOS", "ACOS(x)", "n", "arc cosine, radians", function<Op1::acos>},
    Intrinsic{"ASIN", "ASIN(x)", "n", "arc sine, radians", function<Op1::asin>},
    Intrinsic{"ATAN", "ATAN(x)", "n", "arc tangent, radians", function<Op1::atan>},
    Intrinsic{"ATAN2", "ATAN2(y,x)", "nn", "angle of the point (x,y), radians, -pi to pi", angle_of_point},
    Intrinsic{"COS", "COS(x)", "n", "cosine of an angle in radians", function<Op1::cos>},
    Intrinsic{"SIN", "SIN(x)", "n", "sine of an angle in radians", function<Op1::sin>},
    Intrinsic{"TAN", "TAN(x)", "n", "tangent of an angle in radians", function<Op1::tan>},
    Intrinsic{"DTOR", "DTOR(x)", "n", "degrees to radians", degrees_to_radians},
    Intrinsic{"RTOD", "RTOD(x)", "n", "radians to degrees", radians_to_degrees},
    Intrinsic{"EXP", "EXP(x)", "n", "e to the power x", function<Op1::exp>},
    Intrinsic{"LN", "LN(x)", "n", "natural logarithm", function<Op1::ln>},
    Intrinsic{"LOG", "LOG(x)", "n", "logarithm to the base 10", function<Op1::log10>},
    Intrinsic{"SQRT", "SQRT(x)", "n", "square root", function<Op1::sqrt>},
    Intrinsic{"MOD", "MOD(x,y)", "nn", "remainder of x/y, with the sign of x", chained<Op2::modulo>},
    Intrinsic{"MN", "MN(x,y,...)", "nn+", "the smallest", chained<Op2::minimum>},
    Intrinsic{"MX", "MX(x,y,...)", "nn+", "the greatest", chained<Op2::maximum>},
    Intrinsic{"SIGN", "SIGN(x,y)", "nn", "x with the sign of y", chained<Op2::sign>},
    Intrinsic{"INT", "INT(x)", "n", "the whole part, cut off towards zero", to_integer<Op1::truncate>},
    Intrinsic{"NINT", "NINT(x)", "n", "the nearest whole number", to_integer<Op1::round>},
    Intrinsic{"VCART", "VCART(x,y,z)", "nnn", "vector from its components", [](Values& a, Texts&) { return Value{Type::vector, {a[0].parts[0], a[1].parts[0], a[2].parts[0]}}; }},
    Intrinsic{"VPOL", "VPOL(r,a,h)", "nnn", "vector from radius, angle in radians, height", polar},
    Intrinsic{"VCROSS", "VCROSS(u,v)", "vv", "cross product", cross},
    Intrinsic{"VDOT", "VDOT(u,v)", "vv", "scalar product", [](Values& a, Texts&) { return real(dot(a[0], a[1])); }},
    Intrinsic{"VMAG", "VMAG(v)", "v", "length of a vector", [](Values& a, Texts&) { return real(combine(Op1::sqrt, dot(a[0], a[0]))); }},
    Intrinsic{"VUNIT", "VUNIT(v)", "v", "the vector divided by its length", unit_vector},
    Intrinsic{"VECX", "VECX(v)", "v", "first component", part<0>},
    Intrinsic{"VECY", "VECY(v)", "v", "second component", part<1>},
    Intrinsic{"VECZ", "VECZ(v)", "v", "third component", part<2>},
    Intrinsic{"CHR", "CHR(n)", "k", "the character with this code of Latin-1, 0 to 255", character},
    Intrinsic{"ORD", "ORD(text)", "t", "the code of the first character in Unicode; up to 255 it is that of Latin-1", code_of},
    Intrinsic{"CONCAT", "CONCAT(text,text,...)", "tt+", "texts joined", joined},
    Intrinsic{"LEN", "LEN(text)", "t", "how many characters a text has", character_count},
    Intrinsic{"LWC", "LWC(text)", "t", "in lower case", letters<lower>},
    Intrinsic{"UPC", "UPC(text)", "t", "in upper case", letters<upper>},
    Intrinsic{"SUBSTR", "SUBSTR(text,first,last)", "tk?k", "from the first to the last character, counted from 1; without last to the end", piece},
    Intrinsic{"INDX", "INDX(text,part)", "tt", "where part begins in text, 0 when it is not there", position},
    Intrinsic{"TRIM", "TRIM(text)", "t", "without blanks at the end", trimmed},
    Intrinsic{"STR", "STR(x:width:decimals)", "s?kk", "a number as text", number_text},
    Intrinsic{"VAL", "VAL(text)", "t", "the number that a text holds", text_number},
    Intrinsic{"QTEMP", "QTEMP(sensor)", "t", "temperature: refused, because sensors of temperature are not simulated", temperature},
};
// clang-format on

/// Letters of `arguments`: k is a number and s any value, both known while the program is compiled.
bool suits(char letter, const Value& v) {
  switch (letter) {
    case 'n':
    case 'k': return v.is_number();
    case 't': return v.type == Type::text;
    case 'v': return v.type == Type::vector;
    default: return v.type != Type::boolean;
  }
}

}  // namespace

std::span<const Intrinsic> intrinsics() { return kIntrinsics; }

const Intrinsic* find_intrinsic(std::string_view name) {
  const auto it =
      std::find_if(kIntrinsics.begin(), kIntrinsics.end(), [&](const Intrinsic& f) { return f.name == name; });
  return it == kIntrinsics.end() ? nullptr : &*it;
}

Value apply(const Intrinsic& f, std::vector<Value> arguments, Texts& texts) {
  const std::string help = fmt::format("write {}", f.form);
  std::string_view letters = f.arguments;
  const bool repeats = letters.ends_with('+');
  if (repeats) letters.remove_suffix(1);
  const std::size_t mark = letters.find('?');
  const std::size_t least = mark == std::string_view::npos ? letters.size() : mark;
  std::string types(letters.substr(0, least));
  if (mark != std::string_view::npos) types += letters.substr(mark + 1);
  if (arguments.size() < least || (arguments.size() > types.size() && !repeats))
    refuse(fmt::format("{} with {} argument{}", f.name, arguments.size(), arguments.size() == 1 ? "" : "s"), help);
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const char letter = types[std::min(k, types.size() - 1)];
    if (!suits(letter, arguments[k]))
      refuse(fmt::format("{} takes no {} as argument {}", f.name, name_of(arguments[k].type), k + 1), help);
    if (letter != 'n' && letter != 'v' && !arguments[k].known())
      throw Mistake{Code::E0231,
                    0,
                    0,
                    fmt::format("argument {} of {} depends on a measured value", k + 1, f.name),
                    "texts are made while the program is compiled: compare the numbers instead",
                    ""};
  }
  return f.value(arguments, texts);
}

}  // namespace abbe::lang
