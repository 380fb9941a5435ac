#include "engine/report/writers/sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace abbe {

namespace {

/// "37 of 1000 machines stopped at line 84: reason", one line per place and reason.
std::string trapped_machines(const RunReport& r) {
  std::map<std::pair<int, std::string>, int> stopped;
  for (const Trap& trap : r.traps) ++stopped[{trap.line, trap.reason}];
  std::string out;
  for (const auto& [where, count] : stopped)
    out += fmt::format("{} of {} machines stopped at line {}: {}\n", count, r.machines.used, where.first, where.second);
  return out;
}

std::string lost_characteristics(const RunReport& r) {
  std::string out;
  for (const LostCharacteristic& l : r.lost) out += fmt::format("lost: line {}: {}: {}\n", l.line, l.feature, l.reason);
  return out;
}

std::string not_modelled(const RunReport& r) {
  std::vector<std::string> names;
  for (const Influence& influence : r.influences)
    if (influence.status == InfluenceStatus::not_modelled) names.push_back(influence.name);
  return names.empty() ? "" : "Not modelled: " + joined(names) + ".\n";
}

/// What is in no figure of the report, but known to be small.
std::string bounded(const RunReport& r) {
  std::string out;
  for (const Influence& i : r.influences)
    if (i.status == InfluenceStatus::bounded)
      out += fmt::format("Bounded, not in u: {}, at most {:g} um at a touch ({}).\n", i.name, i.at_most_um, i.source);
  return out;
}

/// "3 min 12 s", "12 s".
std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  return whole < 60 ? fmt::format("{} s", whole) : fmt::format("{} min {} s", whole / 60, whole % 60);
}

}  // namespace

std::string conforms(const CharacteristicReport& c) {
  if (!c.conformance_probability) return "-";
  const std::string share = fmt::format("{:.1f} %", 100 * *c.conformance_probability);
  return c.elsewhere > 0 ? fmt::format("{} of {}", share, c.evaluated) : share;
}

std::optional<double> known(const CharacteristicReport& c, std::optional<double> figure) {
  return c.varies ? figure : std::nullopt;
}

int decimals_for(double u) {
  constexpr double kRounding = 1e-9;
  if (!(u >= kRounding)) return kFewestDecimals;
  const std::string scientific = fmt::format("{:.1e}", u);  // rounds first: 0.0996 is 1.0e-01
  const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
  return std::clamp(1 - exponent, kFewestDecimals, kMostDecimals);
}

int decimals_for(const CharacteristicReport& c) { return decimals_for(known(c, c.summary.u).value_or(0)); }

int decimals_of(std::optional<double> limit) {
  constexpr double kRounding = 1e-9;
  int decimals = kFewestDecimals;
  while (limit && decimals < kMostDecimals && std::fabs(std::stod(decimal(limit, decimals)) - *limit) > kRounding)
    ++decimals;
  return decimals;
}

std::string decimal(std::optional<double> value, int decimals, bool sign) {
  if (!value) return "-";
  const double shown = std::fabs(*value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : *value;
  return sign ? fmt::format("{:+.{}f}", shown, decimals) : fmt::format("{:.{}f}", shown, decimals);
}

std::string tolerance_name(const CharacteristicReport& c) {
  return fmt::format("{} ({}){}", c.tolerance, c.kind, c.occurrence > 1 ? fmt::format(" #{}", c.occurrence) : "");
}

std::string from_reference(const CharacteristicReport& c, const Interval& i) {
  if (!c.reference || !c.varies) return "-";
  const int decimals = decimals_for(c);
  return decimal(i.low - *c.reference, decimals, true) + " to " + decimal(i.high - *c.reference, decimals, true);
}

std::string share_of(const CharacteristicReport& c, std::size_t k) {
  return c.varies && k < c.contributions.size() ? fmt::format("{:.0f} %", 100 * c.contributions[k].share) : "-";
}

std::vector<CharacteristicReport::BudgetLine> budget_lines(const CharacteristicReport& c) {
  if (!c.varies) return {};
  std::vector<CharacteristicReport::BudgetLine> lines = c.budget;
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  std::erase_if(lines, [](const auto& line) { return line.share < 0.001; });
  lines.insert(lines.end(), c.alignment_split.begin(), c.alignment_split.end());
  return lines;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::vector<std::string> contributor_names(const RunReport& r) {
  std::vector<std::string> names;
  for (const auto& c : r.characteristics) {
    for (const auto& contribution : c.contributions) names.push_back(contribution.name);
    if (!names.empty()) break;
  }
  return names;
}

std::string report_header(const RunReport& r) {
  const ScreeningCounts& m = r.machines;
  std::string out =
      fmt::format("{}\nmachine {}: {} virtual machines used of {} generated ({:.1f} % accepted), seed {}\n", r.program,
                  r.machine, m.used, m.generated, 100 * m.share_accepted(), r.seed);
  if (r.workpiece) out += fmt::format("workpiece {}\n", *r.workpiece);
  if (r.recorded_points) out += "errors added to recorded points\n";
  if (r.effect_use) out += fmt::format("effects {}\n", name(*r.effect_use));
  return out + fmt::format("estimated cycle time {}\n", duration(r.cycle_time_s));
}

std::string report_legend(const RunReport& r) {
  std::optional<double> worst;
  for (const auto& c : r.characteristics)
    if (c.varies) worst = std::max(worst.value_or(0), c.summary.u_error / c.summary.u);
  std::string out = fmt::format(
      "\nvalue: {}; u: standard uncertainty; LCL, UCL: 95 % limits (2.5 % and 97.5 %) minus value;\n"
      "lower, upper: tolerance limits; conforms: share of machines inside them; then shares of the variance.\n",
      r.recorded_points ? "from the recorded points" : "on an error-free machine");
  if (worst)
    out += fmt::format("Monte Carlo error of u: {:.1f} % (standard error, the largest of the table).\n", 100 * *worst);
  return out;
}

namespace {

/// An acceptance limit rounded inwards, up or down: what is printed proves conformity too.
std::string inwards(double limit, int decimals, double way) {
  constexpr double kRounding = 1e-6;  // of a step
  const double step = std::pow(10.0, -decimals), shown = std::stod(decimal(limit, decimals));
  const bool outside = way * (shown - limit) < -kRounding * step;
  return decimal(outside ? shown + way * step : shown, decimals);
}

}  // namespace

std::string accepted(const CharacteristicReport& c, const CharacteristicReport::Decision& d) {
  if (!d.guard_band) return "none";
  const int decimals = decimals_for(c);
  return (d.lower ? inwards(*d.lower, decimals, 1) + " to " : "up to ") + inwards(*d.upper, decimals, -1);
}

std::string tolerance_to_uncertainty(const CharacteristicReport::Decision& d) {
  const std::optional<double>& ratio = d.tolerance_to_uncertainty;
  return ratio && std::isfinite(*ratio) ? fmt::format("{:.1f}", *ratio) : "-";
}

std::string decision_legend() {
  return fmt::format(
      "accepted: the values that prove conformity by {} ({:g} %), the tolerance limits less a guard band from the simulated\n"
      "errors; verdict: on the value; T/U: tolerance over expanded uncertainty (half of the 95 % interval).",
      kDecisionRule, 100 * kProvenProbability);
}

std::string budget_legend() {
  return "source: acting alone, shares below 0.1 % left out; then the touches of features that coordinate systems are built from\n"
         "(alignment) against the others (feature).";
}

std::string report_remarks(const RunReport& r) { return trapped_machines(r) + lost_characteristics(r); }

std::string report_bounds(const RunReport& r) { return bounded(r) + not_modelled(r); }

}  // namespace abbe
