#include "lang/value.hpp"

#include <algorithm>
#include <cmath>

namespace abbe::lang {

std::string_view name_of(Type type) {
  constexpr std::string_view kNames[] = {"BOOL", "INTGR", "REAL", "CHAR", "VECTOR"};
  return kNames[static_cast<std::size_t>(type)];
}

bool Value::is_index() const {
  return type == Type::integer || (type == Type::real && (!known() || std::floor(constant()) == constant()));
}

bool Value::known() const {
  return std::all_of(parts.begin(), parts.end(),
                     [](const plan::Expression& e) { return plan::constant(e) != nullptr; });
}

Value number(double v) { return {Type::real, {{plan::PushConstant{v}}}}; }
Value integer(double v) { return {Type::integer, {{plan::PushConstant{v}}}}; }
Value boolean(bool v) { return {Type::boolean, {{plan::PushConstant{v ? 1.0 : 0.0}}}}; }

Value Texts::value(std::string_view text) {
  const auto it = std::find(texts_.begin(), texts_.end(), text);
  const auto index = it - texts_.begin();
  if (it == texts_.end()) texts_.emplace_back(text);
  return {Type::text, {{plan::PushConstant{static_cast<double>(index)}}}};
}

}  // namespace abbe::lang
