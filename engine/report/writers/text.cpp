// The report for a person: one line per characteristic, then what limits its meaning.
//
// u is rounded to two significant digits and the other figures of its line to the same place, but
// mm and degrees keep at least four decimals. Decimal points stand below each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/report/writer.hpp"
#include "engine/report/writers/table.hpp"

namespace abbe {

namespace {

constexpr int kFewestDecimals = 4, kMostDecimals = 9;

/// Decimals that show two significant digits of u.
int decimals_for(double u) {
  if (!(u > 0)) return kFewestDecimals;
  const std::string scientific = fmt::format("{:.1e}", u);  // rounds first: 0.0996 is 1.0e-01
  const int exponent = std::stoi(scientific.substr(scientific.find('e') + 1));
  return std::clamp(1 - exponent, kFewestDecimals, kMostDecimals);
}

/// A number with `decimals`, followed by blanks up to the width of `most` decimals.
std::string aligned(std::optional<double> value, int decimals, int most, const char* sign = "-") {
  if (!value) return "-" + std::string(most + 1, ' ');
  const double rounded =
      std::fabs(*value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : *value;  // no "-0.0000"
  const std::string number = *sign == '+' ? fmt::format("{:+.{}f}", rounded, decimals)
                                          : fmt::format("{:.{}f}", rounded, decimals);
  return number + std::string(most - decimals, ' ');
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

/// From the first characteristic that knows its shares.
std::vector<std::string> contributor_names(const RunReport& r) {
  std::vector<std::string> names;
  for (const auto& c : r.characteristics) {
    for (const auto& contribution : c.contributions) names.push_back(contribution.name);
    if (!names.empty()) break;
  }
  return names;
}

std::vector<Table::Column> columns(const std::vector<std::string>& contributors) {
  using enum Table::Align;
  std::vector<Table::Column> list{
      {"line"}, {"feature", left}, {"tolerance", left}, {"unit", left}, {"value"},   {"u"},
      {"LCL"},  {"UCL"},           {"lower"},           {"upper"},      {"conforms"}};
  for (const std::string& name : contributors) list.push_back({name});
  return list;
}

std::string characteristics_table(const RunReport& r) {
  if (r.characteristics.empty()) return "No characteristic was evaluated.\n";
  int most = 0;
  for (const auto& c : r.characteristics) most = std::max(most, decimals_for(c.summary.u));
  const std::vector<std::string> contributors = contributor_names(r);
  Table table(columns(contributors));
  for (const auto& c : r.characteristics) {
    const int decimals = decimals_for(c.summary.u);
    const std::string repeat = c.occurrence > 1 ? fmt::format(" #{}", c.occurrence) : "";
    std::vector<std::string> cells{std::to_string(c.line),
                                   joined(c.features),
                                   fmt::format("{} ({}){}", c.tolerance, c.kind, repeat),
                                   c.unit,
                                   aligned(c.reference, decimals, most),
                                   aligned(c.summary.u, decimals, most),
                                   aligned(c.lcl, decimals, most, "+"),
                                   aligned(c.ucl, decimals, most, "+"),
                                   aligned(c.lower, kFewestDecimals, most),
                                   aligned(c.upper, kFewestDecimals, most),
                                   c.conformance_probability
                                       ? fmt::format("{:.1f} %", 100 * *c.conformance_probability)
                                       : "-"};
    for (std::size_t k = 0; k < contributors.size(); ++k)
      cells.push_back(k < c.contributions.size()
                          ? fmt::format("{:.0f} %", 100 * c.contributions[k].share)
                          : "-");
    table.add(std::move(cells));
  }
  return table.to_text();
}

constexpr double kSmallestShown = 0.001;

/// The budgets, one source a line, the largest first; nothing when none was asked for.
std::string budget_table(const RunReport& r) {
  using enum Table::Align;
  Table table(
      {{"line"}, {"feature", left}, {"tolerance", left}, {"source", left}, {"u"}, {"share"}});
  bool any = false;
  for (const auto& c : r.characteristics) {
    const auto add = [&](const CharacteristicReport::BudgetLine& line) {
      any = true;
      table.add({std::to_string(c.line), joined(c.features), c.tolerance, line.name,
                 fmt::format("{:.{}f} {}", line.u, decimals_for(line.u), c.unit),
                 fmt::format("{:.1f} %", 100 * line.share)});
    };
    auto sources = c.budget;
    std::stable_sort(sources.begin(), sources.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    for (const auto& line : sources)
      if (line.share >= kSmallestShown) add(line);
    for (const auto& line : c.alignment_split) add(line);
  }
  if (!any) return "";
  return "\n" + table.to_text() +
         "\nsource: acting alone, shares below 0.1 % left out; then the touches of features that "
         "coordinate systems are built from\n(alignment) against the others (feature).\n";
}

/// The intervals of another coverage probability; nothing when none was asked for.
std::string interval_table(const RunReport& r) {
  using enum Table::Align;
  if (r.characteristics.empty() || !r.characteristics.front().interval) return "";
  const std::string percent =
      fmt::format("{:g} %", 100 * r.characteristics.front().interval->coverage);
  Table table({{"line"},
               {"feature", left},
               {"tolerance", left},
               {"unit", left},
               {"symmetric " + percent, left},
               {"shortest " + percent, left}});
  for (const auto& c : r.characteristics) {
    const int decimals = decimals_for(c.summary.u);
    const auto from_value = [&](const Interval& i) {
      return fmt::format("{:+.{}f} to {:+.{}f}", i.low - c.reference, decimals,
                         i.high - c.reference, decimals);
    };
    table.add({std::to_string(c.line), joined(c.features), c.tolerance, c.unit,
               from_value(c.interval->symmetric), from_value(c.interval->shortest)});
  }
  return "\n" + table.to_text() + "\nlimits minus value.\n";
}

std::string legend(const RunReport& r) {
  double worst = 0;
  for (const auto& c : r.characteristics)
    if (c.summary.u > 0) worst = std::max(worst, c.summary.u_error / c.summary.u);
  return fmt::format(
      "\nvalue: on an error-free machine; u: standard uncertainty; LCL, UCL: 95 % limits (2.5 % "
      "and 97.5 %) minus value;\n"
      "lower, upper: tolerance limits; conforms: share of machines inside them; then shares of the "
      "variance.\n"
      "Monte Carlo error of u: {:.1f} % (standard error, the largest of the table).\n",
      100 * worst);
}

/// "37 of 1000 machines stopped at line 84: reason", one line per place and reason.
std::string trapped_machines(const RunReport& r) {
  std::map<std::pair<int, std::string>, int> stopped;
  for (const Trap& trap : r.traps) ++stopped[{trap.line, trap.reason}];
  std::string out;
  for (const auto& [where, count] : stopped)
    out += fmt::format("{} of {} machines stopped at line {}: {}\n", count, r.machines.used,
                       where.first, where.second);
  return out;
}

std::string lost_characteristics(const RunReport& r) {
  std::string out;
  for (const LostCharacteristic& l : r.lost)
    out += fmt::format("lost: line {}: {}: {}\n", l.line, l.feature, l.reason);
  return out;
}

/// Messages without a place in a file; those with one are shown when the program is read.
std::string general_messages(const RunReport& r) {
  std::string out;
  for (const Diagnostic& d : r.messages)
    if (!d.span) out += render(d);
  return out;
}

std::string not_modelled(const RunReport& r) {
  std::vector<std::string> names;
  for (const Influence& influence : r.influences)
    if (influence.status == "not modelled") names.push_back(influence.name);
  return names.empty() ? "" : "Not modelled: " + joined(names) + ".\n";
}

/// What is in no figure of the report, but known to be small.
std::string bounded(const RunReport& r) {
  std::string out;
  for (const Influence& i : r.influences)
    if (i.status == "bounded")
      out += fmt::format("Bounded, not in u: {}, at most {:g} um at a touch ({}).\n", i.name,
                         i.at_most_um, i.source);
  return out;
}

/// "3 min 12 s", "12 s".
std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  return whole < 60 ? fmt::format("{} s", whole)
                    : fmt::format("{} min {} s", whole / 60, whole % 60);
}

/// What was run, on what.
std::string header(const RunReport& r) {
  const ScreeningCounts& m = r.machines;
  std::string out = fmt::format(
      "{}\nmachine {}: {} virtual machines used of {} generated ({:.1f} % accepted), seed {}\n",
      r.program, r.machine, m.used, m.generated, 100 * m.share_accepted(), r.seed);
  if (r.workpiece) out += fmt::format("workpiece {}\n", *r.workpiece);
  if (r.recorded_points) out += "errors added to recorded points\n";
  if (r.effect_use) out += fmt::format("effects {}\n", name(*r.effect_use));
  return out + fmt::format("estimated cycle time {}\n", duration(r.cycle_time_s));
}

std::string write_text(const RunReport& r) {
  std::string out = header(r) + "\n" + characteristics_table(r);
  if (!r.characteristics.empty()) out += legend(r) + interval_table(r) + budget_table(r);
  const std::string remarks = trapped_machines(r) + lost_characteristics(r) + general_messages(r);
  if (!remarks.empty()) out += "\n" + remarks;
  return out + bounded(r) + not_modelled(r);
}

}  // namespace

extern const ReportWriter text_writer{"text", "a table to read", write_text};

}  // namespace abbe
