// The report for a person: one line per characteristic, then what limits its meaning.
//
// u is rounded to two significant digits and the other figures of its line to the same place, but
// mm and degrees keep at least four decimals. Decimal points stand below each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/writer.hpp"
#include "engine/report/writers/sentences.hpp"
#include "engine/report/writers/table.hpp"

namespace abbe {

namespace {

/// A number with `decimals`, followed by blanks up to the width of `most` decimals.
std::string aligned(std::optional<double> value, int decimals, int most, const char* sign = "-") {
  if (!value) return "-" + std::string(most + 1, ' ');
  const double rounded =
      std::fabs(*value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : *value;  // no "-0.0000"
  const std::string number = *sign == '+' ? fmt::format("{:+.{}f}", rounded, decimals)
                                          : fmt::format("{:.{}f}", rounded, decimals);
  return number + std::string(most - decimals, ' ');
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
                                   conforms(c)};
    for (std::size_t k = 0; k < contributors.size(); ++k)
      cells.push_back(k < c.contributions.size()
                          ? fmt::format("{:.0f} %", 100 * c.contributions[k].share)
                          : "-");
    table.add(std::move(cells));
  }
  return table.to_text();
}

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
      if (line.share >= kSmallestShare) add(line);
    for (const auto& line : c.alignment_split) add(line);
  }
  if (!any) return "";
  return "\n" + table.to_text() +
         "\n" + budget_legend() + "\n";
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
      if (!c.reference) return std::string("-");
      return fmt::format("{:+.{}f} to {:+.{}f}", i.low - *c.reference, decimals,
                         i.high - *c.reference, decimals);
    };
    table.add({std::to_string(c.line), joined(c.features), c.tolerance, c.unit,
               from_value(c.interval->symmetric), from_value(c.interval->shortest)});
  }
  return "\n" + table.to_text() + "\nlimits minus value.\n";
}

std::string write_text(const RunReport& r) {
  std::string out = report_header(r) + "\n" + characteristics_table(r);
  if (!r.characteristics.empty()) out += report_legend(r) + interval_table(r) + budget_table(r);
  const std::string remarks = report_remarks(r);
  if (!remarks.empty()) out += "\n" + remarks;
  return out + report_bounds(r);
}

}  // namespace

extern const ReportWriter text_writer{"text", "a table to read", write_text};

}  // namespace abbe
