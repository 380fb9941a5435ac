// The report as a page to file and to send: the table, and how the values of each characteristic are distributed.
#include <fmt/format.h>

#include <algorithm>

#include "engine/report/html_page.hpp"
#include "engine/report/plot.hpp"
#include "engine/report/writer.hpp"
#include "engine/report/writers/sentences.hpp"

namespace abbe {

namespace {

/// Pages with more characteristics than this would be slow to open: the first ones have a plot.
constexpr std::size_t kMostPlots = 200;

std::string name_of(const CharacteristicReport& c) { return joined(c.features) + ": " + tolerance_name(c); }

std::string characteristics(const RunReport& r) {
  if (r.characteristics.empty()) return html_paragraphs("No characteristic was evaluated.");
  std::vector<std::string> titles{"line", "characteristic", "unit",  "value",   "u", "LCL",
                                  "UCL",  "lower",          "upper", "conforms"};
  const std::vector<std::string> contributors = contributor_names(r);
  titles.insert(titles.end(), contributors.begin(), contributors.end());
  std::string rows = html_row(titles, "th");
  for (const CharacteristicReport& c : r.characteristics) {
    const int decimals = decimals_for(c);
    std::vector<std::string> cells{std::to_string(c.line),
                                   name_of(c),
                                   c.unit,
                                   decimal(c.reference, decimals),
                                   decimal(known(c, c.summary.u), decimals),
                                   decimal(known(c, c.lcl), decimals, true),
                                   decimal(known(c, c.ucl), decimals, true),
                                   decimal(c.lower, decimals_of(c.lower)),
                                   decimal(c.upper, decimals_of(c.upper)),
                                   conforms(c)};
    for (std::size_t k = 0; k < contributors.size(); ++k) cells.push_back(share_of(c, k));
    rows += html_row(cells);
  }
  return html_table(rows) + fmt::format("<p class=\"note\">{}</p>\n", escaped(report_legend(r)));
}

std::string decisions(const RunReport& r) {
  const std::string titles = html_row({"line", "characteristic", "unit", "value", "accepted", "verdict", "T/U"}, "th");
  std::string rows;
  for (const CharacteristicReport& c : r.characteristics)
    if (c.decision)
      rows += html_row({std::to_string(c.line), name_of(c), c.unit, decimal(c.reference, decimals_for(c)),
                        accepted(c, *c.decision), std::string(name(c.decision->verdict)),
                        tolerance_to_uncertainty(*c.decision)});
  return rows.empty() ? ""
                      : "<h2>Decisions</h2>\n" + html_table(titles + rows) +
          fmt::format("<p class=\"note\">{}</p>\n", escaped(decision_legend()));
}

/// Deviations from the value of the error-free machine, or from the mean where it has none, in um or seconds of arc.
std::string distribution(const CharacteristicReport& c) {
  const bool length = c.unit == "mm";
  const double factor = length ? 1e3 : 3600;
  const auto deviation = [&](double value) { return factor * (value - c.reference.value_or(c.summary.mean)); };
  const std::string title =
      fmt::format("value on a machine minus {}, {}", c.reference ? "value" : "mean", length ? "um" : "arcsec");
  HistogramPlot d{
      name_of(c), title, c.histogram, {deviation(c.summary.symmetric.low), deviation(c.summary.symmetric.high)}, {}};
  d.histogram.low = deviation(c.histogram.low), d.histogram.high = deviation(c.histogram.high);
  for (const std::optional<double>& limit : {c.lower, c.upper})
    if (limit) d.limits.push_back(deviation(*limit));
  return svg(d);
}

std::string distributions(const RunReport& r) {
  const std::size_t count = std::min(r.characteristics.size(), kMostPlots);
  if (count == 0) return "";
  std::string out = fmt::format(
      "<h2>Distributions</h2>\n<p class=\"note\">What {} machines of this specification report. Dark: the 95 % between LCL and UCL; dashed: tolerance limits, "
      "where they are near.{}</p>\n<div class=\"pair\">",
      r.machines.used, count < r.characteristics.size() ? fmt::format(" Only the first {} are drawn.", count) : "");
  for (std::size_t k = 0; k < count; ++k)
    if (!r.characteristics[k].histogram.counts.empty()) out += distribution(r.characteristics[k]);
  return out + "</div>\n";
}

std::string budget(const CharacteristicReport& c) {
  std::string rows = html_row({"source", "u, " + c.unit, "share"}, "th");
  for (const auto& line : budget_lines(c))
    rows += html_row({line.name, decimal(line.u, decimals_for(line.u)), decimal(100 * line.share, 1) + " %"});
  return "<h3>" + escaped(name_of(c)) + "</h3>\n" + html_table(rows);
}

std::string budgets(const RunReport& r) {
  std::string out;
  for (const CharacteristicReport& c : r.characteristics)
    if (!budget_lines(c).empty()) out += budget(c);
  return out.empty() ? "" : "<h2>Budget</h2>\n<p class=\"note\">" + escaped(budget_legend()) + "</p>\n" + out;
}

std::string intervals(const RunReport& r) {
  if (r.characteristics.empty() || !r.characteristics.front().interval) return "";
  std::string rows = html_row({"characteristic", "unit", "symmetric", "shortest"}, "th");
  for (const CharacteristicReport& c : r.characteristics)
    rows += html_row(
        {name_of(c), c.unit, from_reference(c, c.interval->symmetric), from_reference(c, c.interval->shortest)});
  return fmt::format("<h2>{:g} % intervals</h2>\n<p class=\"note\">Limits minus value.</p>\n",
                     100 * r.characteristics.front().interval->coverage) +
      html_table(rows);
}

std::string influences(const RunReport& r) {
  std::string rows = html_row({"influence", "status"}, "th");
  for (const Influence& i : r.influences)
    rows += html_row({i.name,
                      i.status == InfluenceStatus::bounded
                          ? fmt::format("bounded, not in u: at most {:g} um at a touch ({})", i.at_most_um, i.source)
                          : std::string(name(i.status))});
  return "<h2>Influences</h2>\n" + html_table(rows);
}

/// As on stderr, but without the line and the mark under it: those need letters of one width.
std::string all_messages(const RunReport& r) {
  std::string out;
  for (Diagnostic d : r.messages) {
    if (d.span) d.file += fmt::format(":{}:{}", d.place.line, d.place.column);
    d.span.reset();
    out += render(d);
  }
  return out;
}

std::string write_html(const RunReport& r) {
  const std::string remarks = report_remarks(r) + all_messages(r);
  return html_page("Uncertainty of " + r.program,
                   "<h1>Measurement uncertainty</h1>\n" + html_paragraphs(report_header(r)) +
                       "<h2>Characteristics</h2>\n" + characteristics(r) + decisions(r) + distributions(r) +
                       intervals(r) + budgets(r) +
                       (remarks.empty() ? "" : "<h2>Remarks</h2>\n" + html_paragraphs(remarks)) + influences(r) +
                       fmt::format("<p class=\"note\">abbe {}; GUM, JCGM 101 and 106.</p>\n", escaped(r.version)));
}

}  // namespace

extern const ReportWriter html_writer{"html", write_html};

}  // namespace abbe
