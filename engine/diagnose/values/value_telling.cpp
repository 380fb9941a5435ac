#include "engine/diagnose/values/value_telling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/carried.hpp"
#include "engine/diagnose/findings/caveats.hpp"
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/values/value_patterns.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/math/normal.hpp"
#include "engine/run/recorded/logged.hpp"

namespace abbe::diagnose {

namespace {

Sizes found_sizes(const ValueCase& c, const Closer& closer, const Finding& f) {
  const auto found = closer.sizes.find(f.variant);
  return found != closer.sizes.end() ? found->second : sizes_of(closer.search, f.variant, c.deviation);
}

}  // namespace

std::vector<DiagnosedParameter> parameters_of(const ValueCase& c, const Closer& closer, const Finding& f) {
  const Variant& b = closer.variant(f);
  const Effect& effect = *closer.explanation(f).effect;
  const Sizes s = found_sizes(c, closer, f);
  std::vector<DiagnosedParameter> out;
  for (std::size_t k = 0; k < b.columns.size(); ++k) {
    const EffectParameter& p = effect.parameters[b.columns[k].parameter];
    const auto at = static_cast<Eigen::Index>(k);
    const double value = s.mean(at) * b.columns[k].unit, u = std::sqrt(s.covariance(at, at)) * b.columns[k].unit;
    const double low = value - kNormal95 * u, high = value + kNormal95 * u;
    out.push_back({std::string(p.name), std::string(p.unit), value, u, low, high, {}, high >= p.low && low <= p.high});
  }
  for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
    const EffectParameter& parameter = effect.parameters[p];
    if (parameter.choices.empty()) continue;
    DiagnosedParameter choice{.name = std::string(parameter.name)};
    choice.word = parameter.choices[std::lround(b.theta[p] - parameter.low)];
    out.push_back(std::move(choice));
  }
  return out;
}

namespace {

/// The members of a set, the first as it was told, some others with sizes of their own.
std::vector<DiagnosedMember> members_of(const ValueCase& c, const Closer& closer, const Finding& f,
                                        const DiagnosedEffect& told) {
  std::vector<DiagnosedMember> out;
  for (const int k : f.set) {
    out.push_back({told.probability * share_of(closer.search.explanations(), f, k), {}, {}});
    Finding alone = f;
    alone.explanation = k, alone.variant = f.variant_of(k);
    if (out.size() <= kSized)
      out.back().parameters = k == f.explanation ? told.parameters : parameters_of(c, closer, alone);
  }
  return out;
}

/// As predicts_better() of touches; but rms is that of the long lengths, so values lie closer beside their own scatter.
bool predicts_values_better(const std::optional<Improvement>& i) {
  return i && i->log_score_gain > i->se && i->chi2_per_dof_after <= i->chi2_per_dof_before;
}

/// What would tell the members of a set apart, where values do not.
std::string to_tell_apart(const Explanations& all, const Finding& f) {
  std::string out = "These values do not tell them apart. What would:";
  for (std::size_t k = 0; k < std::min(f.set.size(), kSized); ++k) {
    const Explanation& e = all.list[f.set[k]];
    out += fmt::format(" {}: {}.", e.name, e.effect->separate);
  }
  return out;
}

/// The characteristics beside one that stray in all their repeats by more than chance lets any of so many: the largest p
/// of the repeats counts.
std::vector<std::string> others_that_stray(const ValueCase& c, const std::string& which,
                                           const std::vector<JudgedValue>& values) {
  constexpr double kByChance = 0.05;
  const std::vector<std::string> labels = labels_of(c);
  std::map<std::string, double> largest_p;
  for (std::size_t k = 0; k < labels.size(); ++k) largest_p[labels[k]] = std::max(largest_p[labels[k]], values[k].p);
  std::vector<std::string> out;
  for (const auto& [label, p] : largest_p)
    if (label != which && p * double(largest_p.size()) < kByChance) out.push_back(label);
  return out;
}

/// The characteristic of which a name explains the values and hardly any others, as what each would be without; "" where there
/// is none.
std::string only_one_explained(const ValueCase& c, const Closer& closer, const Finding& f) {
  constexpr double kNearlyAll = 0.9;
  const Vector does = (closer.variant(f).signature * found_sizes(c, closer, f).mean).array() /
      c.judges.covariance.diagonal().array().sqrt();
  const std::vector<std::string> labels = labels_of(c);
  std::map<std::string, double> squares;
  for (std::size_t k = 0; k < labels.size(); ++k) squares[labels[k]] += std::pow(does(static_cast<Eigen::Index>(k)), 2);
  for (const auto& [label, of_it] : squares)
    if (of_it > kNearlyAll * does.squaredNorm()) return label;
  return "";
}

/// "A strays", "A and B stray"
std::string stray_in_words(const std::vector<std::string>& labels) {
  return fmt::format("{} {}", fmt::join(labels, " and "), labels.size() == 1 ? "strays" : "stray");
}

}  // namespace

void tell_name(const ValueCase& c, const Closer& closer, const Finding& f, double adequacy, Diagnosis& out) {
  const Explanations& all = closer.search.explanations();
  DiagnosedEffect e;
  std::vector<std::string_view> titles;
  for (const int k : f.set) {
    e.members.push_back(all.list[k].name);
    titles.push_back(all.list[k].effect->title);
  }
  const Effect& effect = *closer.explanation(f).effect;
  e.parameters = parameters_of(c, closer, f);
  const unsigned untold = std::accumulate(f.set.begin(), f.set.end(), 0u,
                                          [&](unsigned missing, int k) { return missing | all.list[k].missing; });
  const bool only_untold = closer.explanation(f).missing != 0;
  const std::string only = only_one_explained(c, closer, f);
  const std::string in_file =
      belief_in_first(all, f) < kCarried ? kNotCarried : carry(*c.machine, effect, e.parameters, out);
  e.probability = believed(f.probability,
                           adequacy < kInadequate || !all_plausible(e.parameters) || only_untold || !only.empty() ||
                               !predicts_values_better(out.improvement));
  e.sentence = explanation_sentence(titles, e.parameters, "a file of values", {}, e.probability < kTold);
  e.sentence += whose_coefficient(effect, e.parameters);
  if (untold != 0) {
    const std::string columns = fmt::format("{}", fmt::join(columns_of(untold), ", "));
    e.sentence += fmt::format(" Whether it is that depends on {}: a workpiece file tells them (--workpiece).", columns);
    out.otherwise =
        fmt::format("Tell {} in a workpiece file, and diagnose the same values with it (--workpiece).", columns);
  }
  if (!only.empty()) {
    e.sentence += fmt::format(
        " But it explains {} and hardly anything else: a wrong reference, or another size of the part, looks like it.",
        only);
    out.otherwise +=
        fmt::format("{}Check reference and U of {}, and the surfaces there.", out.otherwise.empty() ? "" : " ", only);
  }
  if (f.set.size() > 1) {
    e.by_member = members_of(c, closer, f, e);
    out.otherwise += (out.otherwise.empty() ? "" : " ") + to_tell_apart(all, f);
  }
  e.sentence += in_file;
  out.adequacy_p = adequacy;
  out.verdict = f.set.size() > 1 ? Verdict::one_of : Verdict::named;
  out.effects.push_back(std::move(e));
}

void tell_pattern(const ValueCase& c, const Closer& closer, const Finding& f, Diagnosis& out) {
  const Explanation& e = closer.explanation(f);
  const Vector sizes = sizes_of(closer.search, f.variant, c.deviation).mean, all = closer.variant(f).signature * sizes,
               pattern = all(of_figures(c.ensemble.values));
  out.unexplained = pattern_of_size(is_over_runs(e) ? Factor::run : Factor::feature, e.shape,
                                    std::sqrt(pattern.squaredNorm() / double(pattern.size())),
                                    closer.search.information(f.variant, c.deviation).u.dot(sizes));
  out.verdict = Verdict::unexplained;
  if (is_over_runs(e)) {
    const InWords words = over_runs(c, e, closer.variant(f), all);
    out.unexplained->sentence = fmt::format("No effect of the catalogue explains it: {}.", words.what);
    out.otherwise = words.otherwise;
    Location where{std::string(name(e.factor)), {}};
    if (words.run) where.where.emplace_back(where.factor, std::to_string(*words.run));
    where.share =
        1 - closer.search.white(c.deviation - all).squaredNorm() / closer.search.white(c.deviation).squaredNorm();
    where.p = out.p_value;
    out.location.push_back(std::move(where));
    return;
  }
  if (e.shape == kOneReference) {
    Eigen::Index at = 0;
    const double most = all.cwiseAbs().maxCoeff(&at);
    const auto row = static_cast<std::size_t>(at);
    out.unexplained->sentence = fmt::format(
        "No effect of the catalogue explains it: {}, by {} {}, and what the other values say of the machine does not explain it.",
        closer.variant(f).told, two_digits(most), c.ensemble.values[row].angle ? "urad" : "um");
    out.otherwise = fmt::format(
        "Check reference and U of {}, and the surfaces of the artefact there: they are the same in all places, and the machine is not.",
        abbe::labels_of(c.recording->rows[row].characteristic).back());
    return;
  }
  if (e.shape == kOneCharacteristic) {
    const std::string& which = closer.variant(f).told;
    std::vector<std::string> stray = others_that_stray(c, which, out.values);
    Eigen::Index at = 0;
    const double most = all.cwiseAbs().maxCoeff(&at);
    out.unexplained->sentence = fmt::format(
        "No effect of the catalogue explains it: {} strays{}, by {} {}, and what the other values say of the machine does not explain it.{}",
        which, stray.empty() ? " by itself" : "", two_digits(most),
        c.ensemble.values[static_cast<std::size_t>(at)].angle ? "urad" : "um",
        stray.empty() ? "" : fmt::format(" {} too.", stray_in_words(stray)));
    stray.insert(stray.begin(), which);
    out.otherwise = fmt::format("Check reference, U and program of {}, and measure {} again.",
                                fmt::join(stray, " and of "), stray.size() == 1 ? "it" : "them");
    return;
  }
  out.unexplained->sentence = e.shape == "single values"
      ? "No effect of the catalogue explains it: single values stray (the table says which)."
      : "No effect of the catalogue explains it: the values deviate as those of a machine with larger errors than specified.";
  out.otherwise =
      "Values hold too little to tell an effect on all lengths from a machine out of its specification: measure calibrated lengths along each axis, or give the touches themselves, with x, y, z of each.";
}

}  // namespace abbe::diagnose
