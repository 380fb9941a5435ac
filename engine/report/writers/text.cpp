// The report for a person: one line per characteristic, then what limits its meaning.
//
// u is rounded to two significant digits and the other figures of its line to the same place, but
// mm and degrees keep at least four decimals. Decimal points stand below each other.
#include <fmt/format.h>

#include <algorithm>

#include "engine/report/writer.hpp"
#include "engine/report/writers/sentences.hpp"
#include "engine/report/writers/table.hpp"

namespace abbe {

namespace {

/// A number with `decimals`, followed by blanks up to the width of `most` decimals.
std::string aligned(std::optional<double> value, int decimals, int most, bool sign = false) {
  const int after = value ? most - decimals : most + 1;
  return decimal(value, decimals, sign) + std::string(static_cast<std::size_t>(after), ' ');
}

/// Decimals of the figures with the most.
int most_decimals(const RunReport& r) {
  int most = 0;
  for (const auto& c : r.characteristics) most = std::max(most, decimals_for(c));
  return most;
}

std::vector<Table::Column> columns(const std::vector<std::string>& contributors) {
  using enum Table::Align;
  std::vector<Table::Column> list{{"line"}, {"feature", left}, {"tolerance", left}, {"unit", left}, {"value"},   {"u"},
                                  {"LCL"},  {"UCL"},           {"lower"},           {"upper"},      {"conforms"}};
  for (const std::string& name : contributors) list.push_back({name});
  return list;
}

std::string characteristics_table(const RunReport& r) {
  if (r.characteristics.empty()) return "No characteristic was evaluated.\n";
  const int most = most_decimals(r);
  int most_of_limits = kFewestDecimals;
  for (const auto& c : r.characteristics)
    most_of_limits = std::max({most_of_limits, decimals_of(c.lower), decimals_of(c.upper)});
  const std::vector<std::string> contributors = contributor_names(r);
  Table table(columns(contributors));
  for (const auto& c : r.characteristics) {
    const int decimals = decimals_for(c);
    std::vector<std::string> cells{std::to_string(c.line),
                                   joined(c.features),
                                   tolerance_name(c),
                                   c.unit,
                                   aligned(c.reference, decimals, most),
                                   aligned(known(c, c.summary.u), decimals, most),
                                   aligned(known(c, c.lcl), decimals, most, true),
                                   aligned(known(c, c.ucl), decimals, most, true),
                                   aligned(c.lower, decimals_of(c.lower), most_of_limits),
                                   aligned(c.upper, decimals_of(c.upper), most_of_limits),
                                   conforms(c)};
    for (std::size_t k = 0; k < contributors.size(); ++k) cells.push_back(share_of(c, k));
    table.add(std::move(cells));
  }
  return table.to_text();
}

/// What is proven of the characteristics that have limits; nothing when none has.
std::string decision_table(const RunReport& r) {
  using enum Table::Align;
  Table table({{"line"},
               {"feature", left},
               {"tolerance", left},
               {"unit", left},
               {"value"},
               {"accepted", left},
               {"verdict", left},
               {"T/U"}});
  const int most = most_decimals(r);
  bool any = false;
  for (const auto& c : r.characteristics) {
    if (!c.decision) continue;
    any = true;
    table.add({std::to_string(c.line), joined(c.features), tolerance_name(c), c.unit,
               aligned(c.reference, decimals_for(c), most), accepted(c, *c.decision),
               std::string(name(c.decision->verdict)), tolerance_to_uncertainty(*c.decision)});
  }
  if (!any) return "";
  return "\n" + table.to_text() + "\n" + decision_legend() + "\n";
}

/// The budgets, one source a line, the largest first; nothing when none was asked for.
std::string budget_table(const RunReport& r) {
  using enum Table::Align;
  Table table({{"line"}, {"feature", left}, {"tolerance", left}, {"source", left}, {"u"}, {"share"}});
  bool any = false;
  for (const auto& c : r.characteristics)
    for (const auto& line : budget_lines(c)) {
      any = true;
      table.add({std::to_string(c.line), joined(c.features), c.tolerance, line.name,
                 decimal(line.u, decimals_for(line.u)) + " " + c.unit, decimal(100 * line.share, 1) + " %"});
    }
  if (!any) return "";
  return "\n" + table.to_text() + "\n" + budget_legend() + "\n";
}

/// The intervals of another coverage probability; nothing when none was asked for.
std::string interval_table(const RunReport& r) {
  using enum Table::Align;
  if (r.characteristics.empty() || !r.characteristics.front().interval) return "";
  const std::string percent = fmt::format("{:g} %", 100 * r.characteristics.front().interval->coverage);
  Table table({{"line"},
               {"feature", left},
               {"tolerance", left},
               {"unit", left},
               {"symmetric " + percent, left},
               {"shortest " + percent, left}});
  for (const auto& c : r.characteristics)
    table.add({std::to_string(c.line), joined(c.features), c.tolerance, c.unit,
               from_reference(c, c.interval->symmetric), from_reference(c, c.interval->shortest)});
  return "\n" + table.to_text() + "\nlimits minus value.\n";
}

std::string write_text(const RunReport& r) {
  std::string out = report_header(r) + "\n" + characteristics_table(r);
  if (!r.characteristics.empty()) out += report_legend(r) + decision_table(r) + interval_table(r) + budget_table(r);
  const std::string remarks = report_remarks(r);
  if (!remarks.empty()) out += "\n" + remarks;
  return out + report_bounds(r);
}

}  // namespace

extern const ReportWriter text_writer{"text", write_text};

}  // namespace abbe
