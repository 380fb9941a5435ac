#include "engine/base/numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace abbe {

std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

double last_digit(std::string_view number) {
  const std::size_t exponent = std::min(number.find_first_of("eE"), number.size()),
                    point = std::min(number.find('.'), exponent);
  const double power = finite_number(number.substr(std::min(exponent + 1, number.size()))).value_or(0);
  const std::size_t decimals = exponent > point ? exponent - point - 1 : 0;
  return std::pow(10, power - double(decimals));
}

}  // namespace abbe
