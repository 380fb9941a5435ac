#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/diagnose/words.hpp"
#include "engine/report/diagnosis/diagnosis_report.hpp"
#include "engine/report/html_page.hpp"
#include "engine/report/plot.hpp"

namespace abbe {

namespace {

std::string_view title(const Diagnosis& d) {
  switch (headline(d)) {
    case Headline::plan: return "What such a recording can tell";
    case Headline::nothing_judged: return "Nothing can be judged";
    case Headline::beyond_specification: return "Beyond the specification of the machine";
    case Headline::another_machine: return "Not the machine that its file knows";
    case Headline::verdict: break;
  }
  switch (d.verdict) {
    case Verdict::no_mismatch: return "No mismatch found";
    case Verdict::named: return "A mismatch, and what makes it";
    case Verdict::one_of: return "A mismatch, and what may make it";
    case Verdict::unexplained: return "A mismatch without a name";
    case Verdict::cannot_judge: return "A mismatch that cannot be judged from what was logged";
  }
  return "";
}

std::string explanations(const Diagnosis& d) {
  if (d.effects.empty() && !d.unexplained) return "";
  std::string rows = html_row({"effect", "probability", "size (95 % interval)"}, "th");
  for (const DiagnosedEffect& e : d.effects) {
    const std::vector<std::string> names = in_words(e);
    if (e.by_member.empty())
      rows += html_row({fmt::format("{}", fmt::join(names, " or ")), fmt::format("{:.2f}", e.probability),
                        sizes_in_words(e.parameters, e.largest_um)});
    else
      rows += html_row({"one of these", fmt::format("{:.2f}", e.probability), ""});
    for (std::size_t m = 0; m < e.by_member.size(); ++m)
      rows += html_row({"– " + names[m], fmt::format("{:.2f}", e.by_member[m].probability),
                        sizes_in_words(e.by_member[m].parameters, e.by_member[m].largest_um)});
  }
  if (d.unexplained)
    rows += html_row({fmt::format("pattern over {}, {}", d.unexplained->factor, d.unexplained->shape), "",
                      amplitude_in_words(*d.unexplained)});
  std::string out = "<h2>Explanation</h2>\n" + html_table(rows);
  if (!d.location.empty()) out += "<p>" + escaped(capitalised(located_in_words(d))) + ".</p>\n";
  return out;
}

std::string improvement(const Diagnosis& d) {
  if (!d.improvement) return "";
  const Improvement& i = *d.improvement;
  const auto line = [](const char* what, double before, double after) {
    return html_row({what, fmt::format("{:.3g}", before), fmt::format("{:.3g}", after)});
  };
  std::string out = fmt::format(
      "<h2>What the explanation improves</h2>\n<p>On {} that the model had not seen ({}), the log score gains {:.1f} nats (standard error {:.1f})",
      d.values.empty() ? "touches" : "values", escaped(i.scheme), i.log_score_gain, i.se);
  if (d.runner_up)
    out +=
        fmt::format("; with the runner-up{}, {}, {:.1f}", d.effects.size() > 1 ? " alone in the place of all" : "",
                    escaped(fmt::format("{}", fmt::join(d.runner_up->members, " or "))), d.runner_up->log_score_gain);
  return out + ".</p>\n" +
      html_table(html_row({"there", "before", "after"}, "th") +
                 line("rms of what is left, um", i.rms_before_um, i.rms_after_um) +
                 line("bias where it acts, um", i.bias_before_um, i.bias_after_um) +
                 line("chi-squared per degree of freedom", i.chi2_per_dof_before, i.chi2_per_dof_after));
}

/// What a residual is drawn over.
struct Factor {
  const char* title;
  double (*of)(const ResidualRow&);
};
constexpr Factor kFactors[] = {{"time, min", [](const ResidualRow& r) { return r.time_s / 60; }},
                               {"x, mm", [](const ResidualRow& r) { return r.x_mm; }},
                               {"y, mm", [](const ResidualRow& r) { return r.y_mm; }},
                               {"z, mm", [](const ResidualRow& r) { return r.z_mm; }}};

std::string residual_plots(const Diagnosis& d) {
  if (d.residuals.empty()) return "";
  double largest = 0;
  for (const ResidualRow& r : d.residuals) largest = std::max({largest, std::abs(r.before_um), std::abs(r.after_um)});
  std::string out =
      "<h2>Residuals</h2>\n<p class=\"note\">How far each surface point seems too far out, free of the placement of the part.";
  if (d.improvement) out += " After: the model with the explanation in it predicts touches that it has not seen.";
  out += "</p>\n";
  for (const Factor& f : kFactors) {
    Scatter before{
        d.improvement ? "before" : "of this recording", f.title, "residual, um", {}, {}, {-largest, largest}},
        after = before;
    after.title = "after, held out", after.second_colour = true;
    for (const ResidualRow& r : d.residuals) {
      before.x.push_back(f.of(r)), before.y.push_back(r.before_um);
      after.x.push_back(f.of(r)), after.y.push_back(r.after_um);
    }
    const auto [low, high] = std::minmax_element(before.x.begin(), before.x.end());
    if (*low == *high) continue;
    out += "<div class=\"pair\">" + svg(before) + (d.improvement ? svg(after) : "") + "</div>\n";
  }
  return out;
}

std::string values(const Diagnosis& d) {
  if (d.values.empty()) return "";
  std::string out =
      "<h2>Values</h2>\n<p class=\"note\">Dot: deviation from the reference. Bar: where 95 % of machines of this specification lie.</p>\n";
  for (const char* unit : {"mm", "deg"}) {
    const double factor = std::string_view(unit) == "mm" ? 1e3 : 3600;
    Intervals plot{factor == 1e3 ? "deviation, um" : "deviation, arcsec", {}};
    for (const JudgedValue& v : d.values)
      if (v.unit == unit)
        plot.lines.push_back(
            {fmt::format("{} {}{}", label(v), v.program, v.run > 1 ? fmt::format(" run {}", v.run) : ""),
             factor * v.low, factor * v.high, factor * v.deviation});
    if (!plot.lines.empty()) out += svg(plot) + "\n";
  }
  std::string rows = html_row({"characteristic", "program", "run", "value", "deviation", "u", "z", "p"}, "th");
  for (const JudgedValue& v : d.values)
    rows += html_row({label(v), v.program, std::to_string(v.run), fmt::format("{:.5f} {}", v.value, v.unit),
                      fmt::format("{:.5f}", v.deviation), fmt::format("{:.5f}", v.u), fmt::format("{:.2f}", v.z),
                      p_in_words(v)});
  return out + html_table(rows);
}

std::string next_steps(const Diagnosis& d) {
  std::string steps;
  for (const std::string& step : further_steps(d)) steps += "<p>" + escaped(step) + "</p>\n";
  if (d.next_measurement.empty()) return steps.empty() ? "" : "<h2>What to do next</h2>\n" + steps;
  std::string rows =
      html_row({"change", "what to do", "tells apart", "probability of the truth after it", "minutes"}, "th");
  for (const NextMeasurement& n : d.next_measurement)
    rows += html_row({n.change, n.instruction, fmt::format("{}", fmt::join(n.separates, ", ")),
                      fmt::format("{:.2f}", n.expected_probability), fmt::format("{:.0f}", std::ceil(n.minutes))});
  std::string out = "<h2>What to measure next</h2>\n" + html_table(rows) + steps;
  if (!d.next_measurement.front().program.empty())
    out += "<details><summary>DMIS program of the first</summary><pre>" + escaped(d.next_measurement.front().program) +
        "</pre></details>\n";
  return out;
}

std::string baseline(const Diagnosis& d) {
  const std::string words = d.judged == Judged::yes ? baseline_in_words(d) : "";
  return words.empty() ? "" : "<h2>The machine beside it</h2>\n<p>" + escaped(capitalised(words)) + ".</p>\n";
}

std::string detectable_effects(const Diagnosis& d) {
  if (d.smallest_detectable.empty()) return "";
  std::string rows = html_row({"effect", "detected from, um", "named from, um", "as", "looks like"}, "th");
  for (const Detectable& s : d.smallest_detectable)
    rows += html_row({in_words(s), two_digits(s.detect_um), s.name_um ? two_digits(*s.name_um) : "never",
                      form_in_words(s), looks_like(s)});
  return std::string("<h2>") + (d.judged != Judged::plan ? "What could have been seen" : "What can be seen") +
      "</h2>\n" + html_table(rows);
}

std::string not_judged(const Diagnosis& d) {
  const std::vector<CannotJudge> open = open_questions(d);
  if (open.empty()) return "";
  std::string rows = html_row({"effect", "why"}, "th");
  for (const CannotJudge& c : open) rows += html_row({c.effect, why_not_judged(c, d.touches > 0)});
  return "<h2>What cannot be judged</h2>\n" + html_table(rows);
}

/// As the sentences tell it: further out simulations say nothing.
std::string p_in_words(double p) { return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.2g}", p); }

std::string messages(const Diagnosis& d) {
  if (d.messages.empty()) return "";
  std::string out = "<h2>Messages</h2>\n<ul>";
  for (const Diagnostic& m : d.messages)
    out += fmt::format("<li>{}: {}. {}</li>\n", info(m.code).name, escaped(m.message), escaped(m.help));
  return out + "</ul>\n";
}

}  // namespace

std::string diagnosis_html(const Diagnosis& d, const std::string& recording, const std::string& machine) {
  std::string body =
      fmt::format("<h1>{}</h1>\n<p class=\"note\">Recording {}; machine {}{}</p>\n", title(d), escaped(recording),
                  escaped(machine), d.judged == Judged::yes ? "; " + escaped(p_in_words(d.p_value)) : "");
  for (const std::string& sentence : diagnosis_sentences(d)) body += html_paragraphs(sentence);
  return html_page("Diagnosis of " + recording,
                   body + explanations(d) + improvement(d) + values(d) + residual_plots(d) + next_steps(d) +
                       baseline(d) + detectable_effects(d) + not_judged(d) + messages(d));
}

}  // namespace abbe
