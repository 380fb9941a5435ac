#include "engine/diagnose/findings/tell.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/explanations/same_phase.hpp"
#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/carried.hpp"
#include "engine/diagnose/findings/caveats.hpp"
#include "engine/diagnose/findings/displacements.hpp"
#include "engine/diagnose/findings/empirical.hpp"
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/findings/parameters.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/run/effect_settings.hpp"

namespace abbe::diagnose {

namespace {

/// One recording in so many has a change of the scatter.
constexpr double kPriorScatter = 0.01;

/// Whether a tip that showed what is gone touched anything since. A head that stands elsewhere shows nothing of it.
bool was_looked_for(const Case& c, const Variant& gone) {
  std::set<int> before, since;
  for (Eigen::Index k = 0; k < gone.signature.rows(); ++k) {
    const TouchScene& s = c.scene(k);
    if (!gone.change.acts_in(s.run))
      since.insert(s.stylus.tip_ordinal);
    else if (gone.signature.row(k).squaredNorm() > 0)
      before.insert(s.stylus.tip_ordinal);
  }
  return std::any_of(since.begin(), since.end(), [&](int tip) { return before.contains(tip); });
}

/// Whether it is the period of a scale, of which this recording shows one phase in each direction.
bool is_same_phase(const Case& c, const Finding& f) {
  const Effect* effect = c.explanations.list[f.explanation].effect;
  return effect && needs_raw_reading(*effect) &&
      SameDirection(c.touches, c.rows).is_alike(c.explanations.variants[f.variant].signature);
}

/// Whether it swings so slowly that the recording holds fewer than two periods: what came once and went looks the same.
bool seen_less_than_twice(const Case& c, const Effect& effect, const std::vector<DiagnosedParameter>& told) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(), [&](const EffectParameter& p) {
    return p.sought == Sought::period && std::any_of(told.begin(), told.end(), [&](const DiagnosedParameter& t) {
             return t.name == p.name && 2 * t.value > lasts_s(c.touches);
           });
  });
}

/// Why a name is believed by half at most.
struct Doubts {
  bool rounding = false, same_phase = false, cancelled = false, large_errors = false, none_sure = false,
       lasting = false, once = false;
  bool others = false;  ///< that have no sentence of their own here, or one that stands elsewhere

  bool any() const {
    return rounding || same_phase || cancelled || large_errors || none_sure || lasting || once || others;
  }
};

/// `moved`: what each finding does (displacements.hpp). `e`: what is told of finding `k` so far.
Doubts doubts_of(const Case& c, const SearchResult& result, std::size_t k, const std::vector<Vector>& moved,
                 const DiagnosedEffect& e, const BaselineSummary& baseline) {
  const Finding& f = result.findings[k];
  Doubts d;
  d.rounding = may_be_rounding(c, e.largest_um);
  d.same_phase = is_same_phase(c, f);
  d.cancelled = nearly_cancelled(moved, k);
  d.large_errors = !baseline.known && baseline.geometry_scale >= kLargeErrors;
  const Effect& effect = *c.explanations.list[f.explanation].effect;
  d.none_sure = none_is_sure(effect, e.parameters);
  d.lasting = effect.lasting && e.change.front().any() && begins_within_a_setup(c, e.change.front());
  d.once = seen_less_than_twice(c, effect, e.parameters);
  const bool something_else = result.other || result.adequacy < kInadequate;
  d.others = something_else || of_several_sizes(f.sizes) || !judged(c, f) || !all_plausible(e.parameters) ||
      effect.only_spread;
  return d;
}

/// How long after the first file the file began that has the first touch since an effect began.
double begun_s(const Case& c, const Effect& effect, const std::vector<DiagnosedParameter>& size) {
  const double at_s = begins_at_s(setting_from(effect, size));
  std::map<int, double> start_s;
  double first_s = std::numeric_limits<double>::infinity(), next_s = first_s;
  int file_of_next = -1;
  for (const int row : c.rows) {
    const RecordedTouch& touch = c.touches.touches[row];
    const double time_s = touch.scene.time_s;
    double& start = start_s.try_emplace(touch.file, time_s).first->second;
    start = std::min(start, time_s), first_s = std::min(first_s, time_s);
    if (time_s >= at_s && time_s < next_s) next_s = time_s, file_of_next = touch.file;
  }
  return at_s > 0 && file_of_next >= 0 ? start_s.at(file_of_next) - first_s : 0;
}

/// Gives the machine file what it gets of a name, judges its sizes by that (carried.hpp), and says what is to be said of it.
std::string give_file(const Case& c, const Finding& f, bool looked_for, DiagnosedEffect& e, Diagnosis& out) {
  const Effect& effect = *c.explanations.list[f.explanation].effect;
  if (e.change.front().gone() && looked_for) return " It is gone: the machine file needs nothing of it.";
  const bool told_elsewhere = !whose_clock(c, effect).empty() ||
      !whose_surroundings(c, effect, c.explanations.variants[f.variant], e.parameters).empty();
  if (told_elsewhere) return "";
  if (may_be_rounding(c, e.largest_um))
    return fmt::format(
        " It may come from the rounding of the positions to {:g} um, and no machine file carries it: record the digits that the machine has.",
        c.step_um);
  return belief_in_first(c.explanations, f) < kCarried
      ? kNotCarried
      : carry(*c.machine, effect, e.parameters, out, begun_s(c, effect, e.parameters));
}

}  // namespace

void tell_findings(const Case& c, const SearchResult& result, Diagnosis& out) {
  const std::vector<Vector> moved = displacements(c, signatures_of(c, result));
  for (std::size_t k = 0; k < result.findings.size(); ++k) {
    const Finding& f = result.findings[k];
    const Effect& effect = *c.explanations.list[f.explanation].effect;
    const Variant& variant = c.explanations.variants[f.variant];
    DiagnosedEffect e;
    std::vector<std::string_view> titles;
    for (const int m : f.set) {
      const Explanation& member = c.explanations.list[m];
      e.members.push_back(member.name), titles.push_back(member.effect->title);
      e.change.push_back(change_of(c.explanations.variants[f.variant_of(m)], variant));
    }
    FoundSize size = estimate_size(c, result, k);
    e.parameters = std::move(size.parameters);
    e.largest_um = size.largest_um;
    const RunChange change = e.change.front();
    const bool looked_for = !change.gone() || was_looked_for(c, variant);
    const std::string in_file = give_file(c, f, looked_for, e, out);
    const Doubts doubts = doubts_of(c, result, k, moved, e, out.baseline);
    const bool unproven = !predicts_better(out.improvement);
    e.probability = believed(f.probability, doubts.any() || unproven);
    if (f.set.size() > 1) e.by_member = members_of(c, result, k, e);
    const bool unsure = e.probability < kTold;
    e.sentence = explanation_sentence(titles, e.parameters, "this recording", change, unsure, /*beside=*/k > 0) +
        pattern_beside(c, f) + not_of_one_size(f) +
        (doubts.large_errors ? beside_large_errors(out.baseline.geometry_scale) : "") +
        (doubts.same_phase ? kSamePhase : "") + (doubts.cancelled ? kNearlyCancelled : "") +
        (doubts.none_sure ? kNoneIsSure : "") + (doubts.lasting ? kSeldomNew : "") + (doubts.once ? kSeenOnce : "") +
        much_like_it(effect) + what_does_nearly_the_same(effect, variant, e.parameters);
    if (unproven && !doubts.any() && f.probability > kDoubted) e.sentence += unless_said(out.effects, kUnproven);
    for (const std::string& note :
         {whose_coordinates(c, effect), whose_direction(effect), whose_clock(c, effect),
          whose_coefficient(effect, e.parameters), whose_surroundings(c, effect, variant, e.parameters),
          warmer_in_one_placement(c, effect, variant)})
      e.sentence += unless_said(out.effects, note);
    if (change.in_each_file)
      e.sentence +=
          change.any() ? " Its clock begins with the file of that run." : " Its clock begins anew in each file.";
    if (!looked_for)
      e.sentence +=
          " That it is gone nobody has seen: no orientation in which it was there was touched since. Touch one of them again.";
    e.sentence += in_file;
    if (change.any() && begins_within_a_setup(c, change))
      e.sentence +=
          " That takes for granted that the part did not move between the runs; if it may have, give them different setups.";
    out.effects.push_back(std::move(e));
  }
}

void tell_unexplained(const Case& c, const SearchResult& result, Diagnosis& out) {
  const bool as_well =
      out.improvement && out.runner_up && out.runner_up->log_score_gain >= out.improvement->log_score_gain;
  out.unexplained = describe_unexplained(
      c, result, as_well ? fmt::format("{}", fmt::join(out.runner_up->members, " or ")) : std::string());
  EmpiricalModel model = empirical_model(c, result);
  if (model.follows) out.unexplained->model_follows = name(*model.follows);
  if (!model.settings.empty()) out.unexplained->model = model.settings.front().name;
  const auto over_time = [](const EffectSetting& s) {
    const auto along = s.parameters.find("along");
    return along != s.parameters.end() && along->second.word == "time";
  };
  if (std::any_of(model.settings.begin(), model.settings.end(), over_time))
    out.unexplained->sentence +=
        " In the machine file it goes on from the start of a program as it did from that of this recording: how the machine is by now it does not say.";
  for (EffectSetting& setting : model.settings) out.model_effects.push_back(std::move(setting));
}

namespace {

/// Whether it is noise, which only repeats of the same touches show. `sure`: it is believed as much as what is certain.
std::string what_repeats_say(const NoiseFinding& n, bool sure) {
  if (n.repeats == Repeats::agree)
    return " But repeats of the same touches agree: it is no scatter, but something that is the same each time and too fine for these touches. More touches between them would show it; no machine file carries it.";
  const bool repeated = n.repeats == Repeats::differ;
  if (!n.certain)
    return repeated
        ? " Repeats of the same touches differ, so that it belongs to no place: touch one again and again for some minutes, and see when it changes."
        : fmt::format(
              " Repeats of the same touches{} would tell whether it is noise, or a pattern too fine for this recording.",
              n.factor == Factor::run ? " within that run" : "");
  return sure
      ? ""
      : fmt::format(" It may still be chance: {}repeats of the same touches would tell.", repeated ? "more " : "");
}

}  // namespace

void tell_noise(const Case& c, std::vector<NoiseFinding> noise, Diagnosis& out) {
  for (NoiseFinding& n : noise) {
    const std::string in_file = n.repeats == Repeats::agree ? "" : carry(*c.machine, *n.effect, n.parameters, out);
    if (n.factor && out.effects.empty() && !out.unexplained)
      out.location.push_back({std::string(name(*n.factor)), n.where, 1, n.p});
    const double probability =
        believed(most_believed(n.p, kPriorScatter), out.unexplained || !n.certain || !all_plausible(n.parameters));
    out.effects.push_back({{std::string(n.effect->name)}, probability, n.parameters, n.sentence});
    out.effects.back().sentence += what_repeats_say(n, probability >= kTold) + in_file;
    out.p_value = std::min(out.p_value, n.p);
  }
}

Verdict verdict_of(const Case& c, const SearchResult& result, const Diagnosis& d) {
  if (result.other) return Verdict::unexplained;
  if (result.findings.empty()) return d.effects.empty() ? Verdict::no_mismatch : Verdict::named;
  bool open = false, several = false;
  for (const Finding& f : result.findings) {
    open = open || !judged(c, f);
    several = several || f.set.size() > 1;
  }
  return open ? Verdict::cannot_judge : several ? Verdict::one_of : Verdict::named;
}

}  // namespace abbe::diagnose
