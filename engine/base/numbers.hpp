// Numbers in what users write. std::from_chars alone takes "nan" and "inf" too, which pass range checks and
// spoil every figure.
#pragma once

#include <optional>
#include <string_view>

namespace abbe {

/// A number with a decimal point that a double can hold: "12.5", "+3", "-2e-4". Nothing for any other text,
/// "nan" and "inf" among them.
std::optional<double> finite_number(std::string_view text);

/// What the last digit of such a number counts: 0.001 of "2.150".
double last_digit(std::string_view number);

}  // namespace abbe
