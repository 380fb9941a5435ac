#include "programs/expectations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "engine/base/ids.hpp"
#include "engine/base/letter_case.hpp"

namespace abbe {

namespace {

std::string bounds(const lang::Expectation& e) {
  if (e.low && e.high) return fmt::format("between {} and {}", *e.low, *e.high);
  return e.low ? fmt::format(">= {}", *e.low) : fmt::format("<= {}", *e.high);
}

std::optional<double> figure(const CharacteristicReport& c, const std::string& quantity) {
  const Summary& s = c.summary;
  if (quantity == "mean") return s.mean;
  if (quantity == "value") return c.reference;
  if (!c.varies) return std::nullopt;  // the others are of an uncertainty that nobody knows
  if (quantity == "u") return s.u;
  if (quantity == "u95") return (s.symmetric.high - s.symmetric.low) / 2;
  if (quantity == "lcl") return c.lcl;
  if (quantity == "ucl") return c.ucl;
  ABBE_CHECK(quantity == "conformance");
  return c.conformance_probability;
}

bool names(const lang::Expectation& e, const CharacteristicReport& c) {
  const auto of_it = [&](const std::string& feature) {
    return std::any_of(c.features.begin(), c.features.end(), [&](const auto& own) { return same_label(own, feature); });
  };
  return same_label(c.tolerance, e.subject) && (e.occurrence == 0 || e.occurrence == c.occurrence) &&
      std::all_of(e.features.begin(), e.features.end(), of_it);
}

ExpectationVerdict unknown(const lang::Expectation& e, const RunReport& report) {
  std::vector<std::string_view> tolerances;
  for (const CharacteristicReport& c : report.characteristics) tolerances.push_back(c.tolerance);
  std::string what = fmt::format("TA({})", e.subject);
  if (!e.features.empty()) what = fmt::format("FA({}) with ", fmt::join(e.features, "),FA(")) + what;
  if (e.occurrence > 0) what += fmt::format(", occurrence {}", e.occurrence);
  const bool label_known =
      std::any_of(tolerances.begin(), tolerances.end(), [&](auto t) { return same_label(t, e.subject); });
  const std::string near = label_known ? "" : nearest_word(e.subject, tolerances);
  const Diagnostic d =
      diagnostic(Code::E0608, "the program evaluates no " + what,
                 near.empty() ? "see the characteristics that `abbe run` lists" : "did you mean TA(" + near + ")?");
  return {false, fmt::format("{} {}; {}", info(d.code).name, d.message, d.help)};
}

/// Why a characteristic has no such figure.
const char* reason(const CharacteristicReport& c, const std::string& quantity) {
  if (!c.varies && quantity != "value") return "nothing that is modelled makes the value vary";
  return quantity == "conformance" ? "the tolerance has no limits" : "a condition sends the error-free machine past it";
}

/// Six significant digits, and a nanometre of a length, which a mean of 200.0005 mm needs.
std::string shown(double value) {
  constexpr int kDigits = 6, kDecimals = 6;
  const int before_point = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return fmt::format("{:.{}g}", value, std::max(kDigits, before_point + kDecimals));
}

ExpectationVerdict compare(const lang::Expectation& e, const std::string& name, double value) {
  const bool inside = (!e.low || value >= *e.low) && (!e.high || value <= *e.high);
  return {inside, fmt::format("{} = {}, {} {}", name, shown(value), inside ? "is" : "is not", bounds(e))};
}

}  // namespace

ExpectationVerdict judge(const lang::Expectation& e, const RunReport& report) {
  ABBE_CHECK(e.low || e.high);
  if (e.subject == "accepted") return compare(e, "accepted", report.machines.share_accepted());
  std::optional<ExpectationVerdict> verdict;
  int evaluations = 0;
  for (const CharacteristicReport& c : report.characteristics) {
    if (!names(e, c)) continue;
    ++evaluations;
    const std::string name = fmt::format("TA({}) {}", c.tolerance, e.quantity);
    const std::optional<double> value = figure(c, e.quantity);
    if (!value) return {false, fmt::format("{}: there is none, because {}", name, reason(c, e.quantity))};
    const ExpectationVerdict next = compare(e, name, *value);
    if (!next.passed) return next;
    if (!verdict) verdict = next;
  }
  if (!verdict) return unknown(e, report);
  if (evaluations > 1) verdict->outcome += fmt::format(" (the first of {}; all are)", evaluations);
  return *verdict;
}

}  // namespace abbe
