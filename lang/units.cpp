#include "lang/units.hpp"

#include <charconv>
#include <cmath>
#include <utility>

namespace abbe::lang {

namespace {

/// "-12:30:15.5" in degrees.
std::optional<double> sexagesimal(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  double degrees = 0, unit = 1;
  for (int part = 0; part < 3; ++part) {
    double value = 0;
    const auto [end, failure] =
        std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (failure != std::errc{} || !std::isfinite(value) || value < 0 || (part > 0 && value >= 60)) return std::nullopt;
    degrees += value * unit;
    unit /= 60;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return part == 0 ? std::nullopt : std::optional(negative ? -degrees : degrees);
    if (text.front() != ':') return std::nullopt;
    text.remove_prefix(1);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> length_unit_mm(std::string_view word) {
  constexpr std::pair<std::string_view, double> units[] = {
      {"MM", 1}, {"CM", 10}, {"M", 1000}, {"INCH", kMmPerInch}, {"FEET", 304.8}};
  for (const auto& [name, mm] : units)
    if (word == name) return mm;
  return std::nullopt;
}

std::optional<double> angle_unit_rad(std::string_view word) {
  if (word == "ANGRAD") return 1;
  return word == "ANGDEC" || word == "ANGDMS" ? std::optional(kDegree) : std::nullopt;
}

double unit_of(Quantity quantity, const Units& units) {
  return quantity == Quantity::length ? units.mm_per_unit : quantity == Quantity::angle ? units.rad_per_unit : 1;
}

std::optional<double> constant(const RawArgument& argument, Quantity quantity, const Units& units) {
  const bool plain = argument.kind == RawArgument::Kind::number;
  if (quantity == Quantity::angle && argument.kind == RawArgument::Kind::expression) {
    const std::optional<double> degrees = sexagesimal(argument.text);
    return degrees ? std::optional(*degrees * kDegree) : std::nullopt;
  }
  if (!plain) return std::nullopt;
  const double value = argument.number * unit_of(quantity, units);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace abbe::lang
