// The units in force (UNITS) and the one place where a number of the program becomes a value in
// engine units.
#pragma once

#include <optional>
#include <string_view>

#include "engine/math/units.hpp"
#include "lang/parser.hpp"

namespace abbe::lang {

struct Units {
  double mm_per_unit = 1;
  double rad_per_unit = kDegree;
};

/// What UNITS calls it, in mm: MM, CM, M, INCH or FEET; nothing for another word.
std::optional<double> length_unit_mm(std::string_view word);
/// Likewise in rad: ANGDEC, ANGDMS or ANGRAD.
std::optional<double> angle_unit_rad(std::string_view word);

enum class Quantity { number, length, angle };

/// How many mm, rad or plain numbers one unit of the program is.
double unit_of(Quantity, const Units&);

/// The constant that the argument stands for: mm, rad, or as written for a plain number. Nothing
/// when it is no constant. Angles may also be written degrees:minutes:seconds.
std::optional<double> constant(const RawArgument&, Quantity, const Units&);

}  // namespace abbe::lang
