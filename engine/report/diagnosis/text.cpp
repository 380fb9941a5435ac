#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "engine/diagnose/findings/carried.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/effects/noise/noise.hpp"
#include "engine/math/units.hpp"
#include "engine/report/diagnosis/diagnosis_report.hpp"

namespace abbe {

namespace {

std::string chance(double p) {
  const double step = std::pow(10, std::floor(std::log10(1 / p)) - 1);  // two digits: it comes from simulations
  return p < 1e-4 ? "less than 1 in 10 000"
      : p < 0.01  ? fmt::format("1 in {:.0f}", step * std::round(1 / p / step))
      : p < 0.1   ? fmt::format("{:.2g} %", 100 * p)
      : p > 0.95  ? "nearly all"
                  : fmt::format("{:.0f} %", 100 * p);
}

std::string what(const Diagnosis& d) {
  if (d.values.empty()) return fmt::format("{} touches are", d.touches);
  return d.values.size() == 1 ? "value is" : fmt::format("{} values are", d.values.size());
}

/// A machine with which the recording agrees.
std::string machine_that_agrees(const Diagnosis& d) {
  const BaselineSummary& b = d.baseline;
  const std::string scatter = b.noisier
      ? fmt::format(" if its touches scatter {:.1f} times as much as its file says", b.noise_um / b.stated_noise_um)
      : "";
  if (b.known) return "this machine reports as its file knows it" + scatter;
  const std::string uneven = b.uneven
      ? fmt::format("{} if one of its error functions, guides or rails is more uneven than the rest",
                    scatter.empty() ? "" : ", and")
      : "";
  if (b.geometry_scale < kLargeErrors) return "a machine of this specification reports" + scatter + uneven;
  return fmt::format(
      "a machine reports whose geometric errors are {:.1f} times those of its specification, or rougher{}{}",
      b.geometry_scale, scatter, uneven);
}

std::string agreement(const Diagnosis& d) {
  if (d.verdict == Verdict::no_mismatch)
    return fmt::format("The {} what {}: a difference as large as this one comes by chance in {} of such recordings.",
                       what(d), machine_that_agrees(d), chance(d.p_value));
  const char* const machine =
      d.baseline.known ? "this machine reports as its file knows it" : "a machine of this specification reports";
  return fmt::format("The {} not what {}: by chance it would look so in {} of such recordings.", what(d), machine,
                     chance(d.p_value));
}

/// Do they agree?
std::string first_sentence(const Diagnosis& d) {
  switch (headline(d)) {
    case Headline::plan:
      return fmt::format("No value was looked at: this is what a recording of {} could tell.",
                         d.touches > 0 ? fmt::format("these {} touches", d.touches) : "these values");
    case Headline::nothing_judged:
      if (d.judged == Judged::targets_only)
        return d.values.empty()
            ? fmt::format("Nothing can be judged: all {} touches are exactly where an error-free machine has them.",
                          d.touches)
            : fmt::format("Nothing can be judged: the {} exactly what an error-free machine reports.", what(d));
      if (d.judged == Judged::styli_unlogged)
        return fmt::format(
            "Whether this is a mismatch cannot be judged: these {} touches were made with several styli or orientations of the head, no row says which, and what these differ by may be all of it.",
            d.touches);
      return fmt::format("Nothing can be judged: what is unknown of the part takes up all that these {} touches tell.",
                         d.touches);
    case Headline::beyond_specification:
      return fmt::format(
          "Lengths between the touches are wrong by {:.3g} um, where the specification allows {:.3g} um: such a machine fails its acceptance test, or the part is not as calibrated.",
          kUmPerMm * std::abs(d.beyond->error_mm), kUmPerMm * d.beyond->mpe_mm);
    case Headline::another_machine:
      return fmt::format(
          "This is not the machine that its file knows, or it has changed as a whole: {}it differs by {:.1f} times what was uncertain of it.",
          d.verdict == Verdict::no_mismatch ? "" : "beside what is told here, ", *d.beyond_known);
    case Headline::verdict: return agreement(d);
  }
  return "";
}

/// Whether it is a name of something that was found.
bool is_found(const Diagnosis& d, const CannotJudge& c) {
  return std::any_of(d.effects.begin(), d.effects.end(), [&](const DiagnosedEffect& e) {
    return std::find(e.members.begin(), e.members.end(), c.effect) != e.members.end();
  });
}

/// Of what was found, the columns: these effects are told, and so do not stand among those that cannot be judged.
std::string what_would_tell(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const CannotJudge& c : d.cannot_judge)
    if (!c.missing.empty() && is_found(d, c))
      list.push_back(fmt::format("{} ({})", c.effect, why_not_judged(c, d.touches > 0)));
  return list.empty() ? "" : fmt::format(": {}", fmt::join(list, ", "));
}

/// What is it?
std::string second_sentence(const Diagnosis& d) {
  std::vector<std::string> parts;
  for (const DiagnosedEffect& e : d.effects) parts.push_back(e.sentence);
  if (d.unexplained) parts.push_back(d.unexplained->sentence);
  if (parts.empty()) {
    if (d.smallest_detectable.empty()) return "";
    const auto best = std::min_element(d.smallest_detectable.begin(), d.smallest_detectable.end(),
                                       [](const Detectable& a, const Detectable& b) {
                                         return std::pair(a.scatter, a.detect_um) < std::pair(b.scatter, b.detect_um);
                                       });
    const char* const but = d.judged != Judged::yes ? "The table says"
        : d.beyond || d.beyond_known ? "No effect of the catalogue was found that makes it: the table says"
                                     : "That does not mean that nothing is there: the table says";
    return fmt::format("{} how large each effect would have to be to be seen, at the least {} um ({}).", but,
                       two_digits(best->detect_um), in_words(*best));
  }
  constexpr double kHardlyChance = 0.01;
  if (doubtful(d))
    parts.push_back(fmt::format(
        "But what it leaves would come by chance in {} of recordings: something else {} at work, beside it or instead.",
        chance(*d.adequacy_p), *d.adequacy_p < kHardlyChance ? "is" : "may be"));
  if (d.verdict == Verdict::cannot_judge)
    parts.push_back(
        fmt::format("Whether it is this cannot be judged, because what would tell was not logged or did not change{}.",
                    what_would_tell(d)));
  return fmt::format("{}", fmt::join(parts, " "));
}

/// What could have been seen: of the effects that move touches, the middle one and the one that shows last.
std::string what_would_show(const Diagnosis& d) {
  std::vector<const Detectable*> shown;
  for (const Detectable& s : d.smallest_detectable)
    if (!s.scatter) shown.push_back(&s);
  if (shown.empty()) return "";
  std::sort(shown.begin(), shown.end(), [](const auto* a, const auto* b) { return a->detect_um < b->detect_um; });
  const std::vector<CannotJudge> open = open_questions(d);
  const auto others = std::count_if(open.begin(), open.end(), [](const CannotJudge& c) { return !is_noise(c.effect); });
  return fmt::format(
      "Of the {} that {} can show, half would be seen from {} um on at the latest, and the last one ({}) from {} um on{}.",
      shown.size() == 1 ? "one effect" : fmt::format("{} effects", shown.size()),
      d.touches > 0 ? "such touches" : "such values", two_digits(shown[(shown.size() - 1) / 2]->detect_um),
      in_words(*shown.back()), two_digits(shown.back()->detect_um),
      others == 0 ? "" : fmt::format("; {} more cannot be judged", others));
}

/// Is it better? Where nothing was found: what would have been?
std::string third_sentence(const Diagnosis& d) {
  if (d.effects.empty() && !d.unexplained) return what_would_show(d);
  const bool scatter = !d.unexplained && std::all_of(d.effects.begin(), d.effects.end(), [](const DiagnosedEffect& e) {
    return is_noise(e.members.front());
  });
  if (scatter && !d.improvement)
    return fmt::format("Scatter moves hardly any mean: no touch is predicted better with it{}.",
                       d.model_effects.empty() ? "" : ", but results are less certain than without");
  if (!d.improvement) return "";
  const Improvement& i = *d.improvement;
  constexpr double kClear = 3;  // nats
  const bool clear = std::abs(i.log_score_gain) > std::max(kClear, 2 * i.se), gains = i.log_score_gain > 0,
             closer = i.rms_after_um <= i.rms_before_um;
  const std::string says = clear && gains
      ? (closer ? "it predicts better" : "something is there too, but not of the size that it has on the others")
      : clear && closer ? "it comes closer, but errs by more than it says that it may"
      : clear           ? "it predicts worse"
      : gains && closer ? "it predicts better, though part of that may be chance"
      : closer          ? "it cannot be told whether it predicts better"
                        : "it does not predict better";
  const auto shown = [](double um) { return fmt::format("{:.2f}", um); };
  if (gains && shown(i.rms_before_um) == shown(i.rms_after_um) && shown(i.bias_before_um) == shown(i.bias_after_um))
    return fmt::format(
        "Of {} that the model had not seen it says better how far they stray{}, and moves none: rms of what is left {:.2f} um.",
        d.values.empty() ? "touches" : "values", clear ? "" : ", though part of that may be chance", i.rms_after_um);
  return fmt::format(
      "On {} that the model had not seen {}: rms of what is left {:.2f} to {:.2f} um, bias where it acts {:.2f} to {:.2f} um.",
      d.values.empty() ? "touches" : "values", says, i.rms_before_um, i.rms_after_um, i.bias_before_um,
      i.bias_after_um);
}

std::string table_row(const std::string& what, double probability, const std::string& sizes) {
  return fmt::format("{:<38} {:>6.2f}  {}\n", what, probability, sizes);
}

std::string mismatch_table(const Diagnosis& d) {
  std::string out = fmt::format("{:<38} {:>6}  {}\n", "explanation", "prob.", "size (95 % interval)");
  for (const DiagnosedEffect& e : d.effects) {
    const std::vector<std::string> names = in_words(e);
    if (e.by_member.empty()) {
      out += table_row(fmt::format("{}", fmt::join(names, " or ")), e.probability,
                       sizes_in_words(e.parameters, e.largest_um));
      continue;
    }
    out += table_row("one of these", e.probability, "");
    for (std::size_t m = 0; m < names.size(); ++m) {
      const DiagnosedMember& member = e.by_member[m];
      out += table_row("  " + names[m], member.probability, sizes_in_words(member.parameters, member.largest_um));
    }
  }
  if (d.unexplained)
    out += fmt::format("{:<38} {:>6}  {}\n", "pattern over " + d.unexplained->factor + ", " + d.unexplained->shape, "",
                       amplitude_in_words(*d.unexplained));
  if (!d.location.empty()) out += "  " + located_in_words(d) + "\n";
  return out;
}

std::string design_table(const Diagnosis& d) {
  std::size_t width = 2;  // of its heading
  for (const Detectable& s : d.smallest_detectable) width = std::max(width, form_in_words(s).size());
  std::string out = fmt::format("{:<38} {:>11} {:>11}  {:<{}}  {}\n", "largest displacement, um, that would be",
                                "detected", "named", "as", width, "looks like");
  bool scatter = false;
  for (const Detectable& s : d.smallest_detectable) {
    if (s.scatter && !std::exchange(scatter, true)) out += "scatter, standard deviation, um\n";
    out += fmt::format("{:<38} {:>11} {:>11}  {:<{}}  {}\n", in_words(s), two_digits(s.detect_um),
                       s.name_um ? two_digits(*s.name_um) : "never", form_in_words(s), width, looks_like(s));
  }
  return out;
}

std::string cannot_judge(const Diagnosis& d) {
  std::string out;
  for (const CannotJudge& c : open_questions(d))
    out += fmt::format("  {:<36} {}\n", c.effect, why_not_judged(c, d.touches > 0));
  return out.empty() ? "" : "cannot be judged from this recording:\n" + out;
}

/// What a change tells apart: of a plan, one change may be the best for several questions.
std::string what_tells(const std::vector<NextMeasurement>& list, const std::string& change) {
  std::vector<std::string> told;
  for (const NextMeasurement& n : list)
    if (n.change == change)
      told.push_back(
          fmt::format("{} apart with probability {:.2f}", fmt::join(n.separates, " / "), n.expected_probability));
  return fmt::format("tells {}", fmt::join(told, ", and "));
}

std::string what_next(const Diagnosis& d) {
  std::string out;
  std::set<std::string> shown;
  for (const NextMeasurement& n : d.next_measurement)
    if (shown.insert(n.change).second)
      out += fmt::format("  {} ({:.0f} min): {}\n    {}\n", n.change, std::ceil(n.minutes),
                         what_tells(d.next_measurement, n.change), n.instruction);
  if (!d.next_measurement.empty())
    out +=
        "  The first as a DMIS program: on the page of --report, and in next_measurement of --format json. Its paths are not checked for collision.\n";
  for (const std::string& step : further_steps(d)) out += "  " + step + "\n";
  return out.empty() ? "" : "what to do next:\n" + out;
}

std::string value_table(const Diagnosis& d) {
  if (d.values.empty()) return "";
  std::string out = fmt::format("{:<28} {:<22} {:>3} {:>13} {:>12} {:>24} {:>6} {:>6}\n", "characteristic", "program",
                                "run", "value", "deviation", "95 % of such machines", "z", "p");
  for (const JudgedValue& v : d.values)
    out += fmt::format("{:<28} {:<22} {:>3} {:>13.5f} {:>12.5f} {:>11.5f} to {:>9.5f} {:>6.2f} {:>6}  {}\n", label(v),
                       v.program, v.run, v.value, v.deviation, v.low, v.high, v.z, p_in_words(v), v.unit);
  return out + "\n";
}

/// For those who know statistics.
std::string held_out_line(const Diagnosis& d) {
  if (!d.improvement) return "";
  const std::string beside = d.runner_up
      ? fmt::format("; with the runner-up{}, {}, {:+.1f}", d.effects.size() > 1 ? " alone in the place of all" : "",
                    fmt::join(d.runner_up->members, " or "), d.runner_up->log_score_gain)
      : "";
  return fmt::format("held out ({}): log score {:+.1f} nats, standard error {:.1f}{}\n", d.improvement->scheme,
                     d.improvement->log_score_gain, d.improvement->se, beside);
}

}  // namespace

std::vector<CannotJudge> open_questions(const Diagnosis& d) {
  if (d.judged == Judged::styli_unlogged) return {{"every effect", {"sensor", "head_A_deg", "head_B_deg"}, {}}};
  std::vector<CannotJudge> out = d.cannot_judge;
  std::erase_if(out, [&](const CannotJudge& c) { return is_found(d, c); });
  return out;
}

std::vector<std::string> diagnosis_sentences(const Diagnosis& d) {
  std::vector<std::string> out;
  for (const std::string& sentence : {first_sentence(d), second_sentence(d), third_sentence(d)})
    if (!sentence.empty()) out.push_back(sentence);
  return out;
}

std::string baseline_in_words(const Diagnosis& d) {
  if (!d.values.empty()) return "";
  const BaselineSummary& b = d.baseline;
  const std::string shape = std::string(b.rougher ? ", rougher than harmonics" : "") +
      (b.uneven ? ", in part more uneven than the rest" : "");
  std::string out =
      fmt::format("baseline: {:.2f} times {}{}, noise {:.2f} um ({:.2f} in the machine file)", b.geometry_scale,
                  b.known ? "what is uncertain of the known machine" : "the machine's errors of its specification",
                  shape, b.noise_um, b.stated_noise_um);
  if (b.correlation > 0) out += fmt::format(", neighbours correlated by {:.2f}", b.correlation);
  if (!b.outliers.empty())
    out += fmt::format("; {} left out, far from where the others predict {}: {}",
                       b.outliers.size() == 1 ? "1 touch" : fmt::format("{} touches", b.outliers.size()),
                       b.outliers.size() == 1 ? "it" : "them", fmt::join(b.outliers, ", "));
  if (const auto& worst = d.worst_length)
    out += fmt::format("; of lengths the third worst is off by {:.2f} um over {:.0f} mm, where the MPE is {:.2f} um",
                       kUmPerMm * std::abs(worst->error_mm), worst->length_mm, kUmPerMm * worst->mpe_mm);
  return out;
}

namespace {

/// What to look at where touches of one group scatter more; "" where that is the stylus, the head or the speed.
std::string_view where_it_scatters(const DiagnosedEffect& e) {
  const auto group = std::find_if(e.parameters.begin(), e.parameters.end(),
                                  [](const DiagnosedParameter& p) { return p.name == "group"; });
  if (group == e.parameters.end()) return "";
  if (group->word == "one feature")
    return "Look at the surface that scatters: a rough or dirty one does, and one that gives way. More touches on it make its results as certain as others.";
  if (group->word == "one setup")
    return "See how the part was held in that setup: what is loose gives way differently each time.";
  if (group->word == "one run" || group->word == "a stretch of time")
    return "Find out what was different then (a stylus that was loose, traffic, a compressor, people at the machine, draught), and measure again what was touched then.";
  return "";
}

}  // namespace

std::vector<std::string> further_steps(const Diagnosis& d) {
  std::vector<std::string> out;
  if (!d.otherwise.empty()) out.push_back(d.otherwise);
  if (d.judged == Judged::yes && d.verdict == Verdict::no_mismatch) {
    constexpr Code kDoubts[] = {Code::W0716, Code::W0720, Code::W0723, Code::W0730};
    for (const Diagnostic& m : d.messages)
      if (std::find(std::begin(kDoubts), std::end(kDoubts), m.code) != std::end(kDoubts))
        out.push_back(capitalised(m.help) + ".");
    if (out.empty()) out.push_back("Nothing needs mending: use the machine file as it is.");
    out.push_back(
        "Smaller effects, and those that cannot be judged, need another measurement: 'abbe diagnose --design-only' says what a plan could show.");
    if (d.values.empty() && !d.baseline.known)
      out.push_back(
          "What depends on the place alone, and is no larger than the specification allows, counts as an error of this machine: that it is new shows only beside what was known of it before (--known, with the file that --model-out wrote).");
  }
  const auto of_outliers = [](const DiagnosedEffect& e) { return e.members.front() == kOutliers.name; };
  if (!d.baseline.outliers.empty() && std::any_of(d.effects.begin(), d.effects.end(), of_outliers))
    out.push_back(
        "Look at the surfaces where the touches were made that are left out (the last line), clean them and the tip, and touch them again: what does not come back is no property of the machine.");
  for (const DiagnosedEffect& e : d.effects)
    if (e.members.front() == kUnequalNoise.name)
      if (const std::string_view step = where_it_scatters(e); !step.empty()) out.emplace_back(step);
  const bool pattern = d.values.empty() && d.unexplained, carried = pattern && !d.unexplained->model.empty();
  if (pattern && !carried)
    out.push_back(
        "No machine file can carry this pattern: it belongs to the part or the occasion, depends on more than one thing, or is too rough for a curve or a map.");
  if (d.model_effects.empty() && !d.superseded.empty())
    out.push_back("What is gone is in the machine file still: --model-out writes it without.");
  if (!std::all_of(d.model_effects.begin(), d.model_effects.end(), diagnose::is_of_one_run)) {
    const bool open =
        std::any_of(d.effects.begin(), d.effects.end(), [](const DiagnosedEffect& e) { return e.members.size() > 1; });
    out.push_back(fmt::format(
        "To reckon with {0} until it is mended: --model-out writes the machine file with it{1}, and 'abbe run' on that machine gives uncertainties with it.",
        carried && !d.unexplained->model_follows.empty()
            ? "what of it follows " + d.unexplained->model_follows + " alone"
            : pattern && !carried ? "what has a name"
                                  : "it",
        open ? " (of several names, with the first)" : ""));
  }
  return out;
}

std::string label(const JudgedValue& v) {
  return v.occurrence > 1 ? fmt::format("{} ({})", v.characteristic, v.occurrence) : v.characteristic;
}

std::string diagnosis_text(const Diagnosis& d) {
  std::string out;
  for (const std::string& sentence : diagnosis_sentences(d)) out += sentence + "\n";
  out += "\n";
  const bool found = !d.effects.empty() || d.unexplained;
  if (found || !d.smallest_detectable.empty() || !d.values.empty())
    out += value_table(d) + (found ? mismatch_table(d) : design_table(d)) + "\n";
  out += what_next(d);
  out += cannot_judge(d);
  out += held_out_line(d);
  if (!d.effects.empty() && d.values.empty()) out += "± is two standard uncertainties (95 %).\n";
  const std::string baseline = baseline_in_words(d);
  return baseline.empty() ? out : out + baseline + "\n";
}

}  // namespace abbe
