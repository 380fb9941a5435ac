#include "engine/diagnose/planning/advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/caveats.hpp"
#include "engine/diagnose/findings/displacements.hpp"
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/planning/question.hpp"
#include "engine/effects/noise/noise.hpp"
#include "engine/math/units.hpp"
#include "engine/run/effect_set.hpp"
#include "engine/run/effect_settings.hpp"
#include "engine/run/recorded/logged.hpp"

namespace abbe::diagnose {

namespace {

/// The share of what can be gained over guessing below which what tells more is to be done first: of two, a probability of
/// 0.6.
constexpr double kWorthARound = 0.2;

/// Whether every feature was measured at one stretch: what differs between them may be the time then.
bool one_after_the_other(const Case& c) {
  std::set<int> done;
  int now = -1;
  for (const int row : c.rows) {
    const int feature = c.touches.touches[row].scene.feature;
    if (feature == now) continue;
    if (!done.insert(feature).second) return false;
    now = feature;
  }
  return done.size() > 1;
}

/// Whether a touch came again in another placement that is unlike its first.
template <class Unlike>
bool placed_again(const Case& c, const Unlike& unlike) {
  std::map<std::pair<int, int>, const TouchScene*> first;  // by feature and number of the touch
  return std::any_of(c.rows.begin(), c.rows.end(), [&](int row) {
    const RecordedTouch& t = c.touches.touches[row];
    const TouchScene& s = t.scene;
    const TouchScene& before = *first.try_emplace({s.feature, c.recording->rows[t.row].touch}, &s).first->second;
    return s.setup != before.setup && unlike(s, before);
  });
}
bool turned(const TouchScene& a, const TouchScene& b) { return dot(a.normal, b.normal) < std::cos(20 * kDegree); }
/// In places of the machine that are far from one another, or turned.
bool elsewhere(const TouchScene& a, const TouchScene& b) {
  constexpr double kFar_mm = 50;
  return norm(a.point - b.point) > kFar_mm || turned(a, b);
}

bool has_three_speeds(const Case& c) { return speeds_in(c.touches).size() >= 3; }

/// A wrong figure of a certificate makes its feature stray by itself.
std::string to_check_certificate(const Case& c, Factor factor) {
  if (factor != Factor::feature || c.baseline.surfaces != Surfaces::calibrated) return "";
  return "Check what is given of these features first, which costs no measurement: a wrong figure of a certificate looks like this. ";
}

/// What goes with the time on one feature, and on no other, may be scatter that this pattern fits. A wrong figure is the same at all times.
constexpr const char* kMayScatter =
    "The touches of one feature may only scatter, on a surface that is rough, dirty or not held fast: make each of them three times. What comes back each time is no scatter. ";

constexpr const char* kClampAnew =
    "Clamp the part anew in the same place and repeat: what comes back is the part, what does not is its clamping. Give it a new setup.";

/// What makes a pattern without a name is narrowed down by changing what it may belong to.
std::string to_follow_a_pattern(const Case& c, Factor factor) {
  if (factor == Factor::feature && one_after_the_other(c))
    return "One feature was measured after the other, so that it may be the time: measure them in another order. What comes back on the same features is the part or its clamping, what does not goes with the clock.";
  switch (factor) {
    case Factor::time:
      return "Repeat the same touches in another order: what follows the clock comes at the same time, what follows the place moves with it.";
    case Factor::position:
      return placed_again(c, elsewhere)
          ? "The part stood in several places, and they do not tell whether this is the machine's or the part's: repeat at another height, and with the part in another orientation, each in a setup of its own."
          : "Repeat with the part moved: what stays where it was in the machine is the machine's, what moves with the part is the part's. Give each placement a setup of its own.";
    case Factor::direction:
      if (placed_again(c, turned))
        return "The part stood turned in one of its placements, which does not tell yet: repeat with another stylus ball, too. What goes with the ball is the tip's, what stays is the probe's or the machine's.";
      return "Repeat with the part turned and with another stylus ball: what turns with the part is its form, what goes with the ball is the tip's, what stays is the probe's or the machine's. Give each placement a setup of its own.";
    case Factor::head:
      return "Repeat every orientation after a visit elsewhere: what comes back is the head's geometry, what does not is its indexing. Qualify anew for what is left.";
    case Factor::sensor:
      return "Qualify the stylus anew and repeat: what vanishes was its qualification or a loose joint, what stays is its bending or its form.";
    case Factor::setup: return kClampAnew + warmer_in_one_placement(c);
    case Factor::feature: return kClampAnew;
    case Factor::run:
      return "Repeat the run unchanged: what comes back goes with the sequence, what does not was of that occasion.";
    case Factor::temperature:
      return "Repeat at another temperature, the part soaked: what follows the temperature grows in proportion to it.";
    case Factor::speed:
      if (has_three_speeds(c))
        return "Repeat at another acceleration: a delay grows in proportion to the speed and does not care for it, vibration does.";
      return "Repeat at a third speed and at another acceleration: a delay grows in proportion to the speed, vibration with the acceleration.";
  }
  return "";
}

/// "log a, and let it vary"; "let b vary" of what was logged and is the same throughout; "log a, and let it and b vary".
std::string to_let_vary(const Case& c, unsigned missing, std::string_view first_word_log,
                        std::string_view first_word_let) {
  const std::vector<std::string> absent = columns_of(missing & ~c.touches.known),
                                 constant = columns_of(missing & c.touches.known);
  if (absent.empty()) return fmt::format("{} {} vary", first_word_let, fmt::join(constant, ", "));
  return fmt::format("{} {}, and let {}{}{} vary", first_word_log, fmt::join(absent, ", "),
                     absent.size() == 1 ? "it" : "them", constant.empty() ? "" : " and ", fmt::join(constant, ", "));
}

/// The pattern of one feature that was touched in other runs, too, and did not stray in them: it is no property of the part.
std::string to_look_at_the_feature(const Case& c, const SearchResult& result) {
  constexpr double kStrays = 3;  // times as far as in the other runs
  if (c.explanations.list[result.other->explanation].factor != Factor::feature) return "";
  const Vector moved = displacements(c, signatures_of(c, result)).back();
  struct Strays {
    double squares = 0, touches = 0;
    double rms() const { return std::sqrt(squares / touches); }
  };
  std::map<int, std::map<int, Strays>> of;  // by feature and run
  for (Eigen::Index k = 0; k < moved.size(); ++k) {
    Strays& at = of[c.scene(k).feature][c.scene(k).run];
    at.squares += moved(k) * moved(k), at.touches += 1;
  }
  const auto in_all = [](const auto& feature) {
    double squares = 0;
    for (const auto& [run, at] : feature.second) squares += at.squares;
    return squares;
  };
  const auto& [feature, runs] =
      *std::max_element(of.begin(), of.end(), [&](const auto& a, const auto& b) { return in_all(a) < in_all(b); });
  double most = 0;
  for (const auto& [run, at] : runs) most = std::max(most, at.rms());
  std::vector<int> strays;
  for (const auto& [run, at] : runs)
    if (kStrays * at.rms() > most) strays.push_back(run);
  if (strays.size() == runs.size()) return "";
  return fmt::format(
      "{} strays in run {} alone, so that it is no property of the part: look for dirt on it, and for a stylus that was loose then.",
      c.touches.features[feature], fmt::join(strays, ", "));
}

/// What makes the pattern that was found beside the names, or without any.
std::string to_follow_the_pattern(const Case& c, const SearchResult& result) {
  const Explanation& pattern = c.explanations.list[result.other->explanation];
  if (std::string look = to_look_at_the_feature(c, result); !look.empty()) return look;
  const std::string first =
      pattern.shape == "one of them in time" ? kMayScatter : to_check_certificate(c, pattern.factor);
  return first + to_follow_a_pattern(c, pattern.factor);
}

/// What the names that were found miss before they can be judged.
unsigned missed_by_names(const Case& c, const SearchResult& result) {
  unsigned missing = 0;
  for (const Finding& f : result.findings)
    for (const int k : f.set) missing |= c.explanations.list[k].missing;
  return missing;
}

/// Of what the other effects miss, beside what is asked for already, as much as one can act on: three columns at most, of
/// an effect all or none. What was not logged comes before what did not change, for logging takes no measurement of its
/// own; and the catalogue begins with temperatures, which make the largest errors in most rooms.
unsigned missed_first(const Case& c, unsigned asked) {
  constexpr std::size_t kMostColumns = 3;
  unsigned out = 0;
  for (const bool logged : {false, true}) {
    for (const Explanations::Unjudged& u : c.explanations.unjudged) {
      const unsigned missing = u.missing & ~asked;
      if (((missing & ~c.touches.known) == 0) == logged && columns_of(out | missing).size() <= kMostColumns)
        out |= missing;
    }
  }
  return out;
}

/// What must be logged, and vary, before the names that were found can be judged.
std::vector<std::string> to_log(const Case& c, const SearchResult& result) {
  std::map<unsigned, std::vector<std::string>> names;  // by what they miss
  for (const Finding& f : result.findings) {
    for (const int k : f.set) {
      const Explanation& e = c.explanations.list[k];
      if (e.missing) names[e.missing].push_back(e.name);
    }
  }
  std::vector<std::string> out;
  for (const auto& [missing, list] : names) {
    if (!columns_of(missing).empty())
      out.push_back(fmt::format("{}: what {} does depends on it.", to_let_vary(c, missing, "Log", "Let"),
                                fmt::join(list, " or ")));
  }
  return out;
}

/// What would show what it is that the names leave. `asked`: what is to be logged anyway.
std::string to_follow_what_is_left(const Case& c, const SearchResult& result, unsigned asked) {
  if (result.findings.empty() || result.other || result.adequacy >= kInadequate) return "";
  const unsigned missing = missed_first(c, asked);
  if (columns_of(missing).empty())
    return "What is left follows something: repeat in another order, and with the part moved into a new setup, and see with what it goes.";
  return fmt::format("What is left may belong to what was not logged or did not change: first of all, {}.",
                     to_let_vary(c, missing, "log", "let"));
}

/// What would show whether a name that stands alone is right, where it is not told for certain.
std::string to_check_a_name(const Case& c, const SearchResult& result, const Diagnosis& told) {
  for (std::size_t k = 0; k < result.findings.size(); ++k) {
    const Finding& f = result.findings[k];
    if (of_several_sizes(f.sizes)) return to_follow_a_pattern(c, f.sizes->factor);
    if (f.set.size() == 1 && told.effects.at(k).probability < kTold)
      return to_follow_a_pattern(c,
                                 shown_in(c, c.explanations.list[f.explanation], c.explanations.variants[f.variant]));
  }
  return "";
}

/// Whether a measurement of the menu tells the rivals apart clearly better than guessing.
bool worth_a_round(const std::vector<NextMeasurement>& next) {
  return std::any_of(next.begin(), next.end(), [](const NextMeasurement& n) {
    const double guess = 1 / double(n.separates.size());
    return n.expected_probability > guess + kWorthARound * (1 - guess);
  });
}

/// What to do beside a measurement of the menu, or where there is none that is worth its time.
std::string besides_sizes(const Case& c, const SearchResult& result, const Diagnosis& told) {
  if (worth_a_round(told.next_measurement)) return to_follow_what_is_left(c, result, 0);
  if (result.other) return to_follow_the_pattern(c, result);
  std::vector<std::string> sentences = to_log(c, result);
  if (std::string left = to_follow_what_is_left(c, result, missed_by_names(c, result)); !left.empty())
    sentences.push_back(std::move(left));
  if (std::string check = to_check_a_name(c, result, told); !check.empty()) sentences.push_back(std::move(check));
  const std::vector<int> rivals = question_of(result).rivals;
  if (rivals.size() >= 2)
    sentences.emplace_back(
        told.next_measurement.empty()
            ? "No other run of these touches would tell them apart much better than guessing. What would:"
            : "What is proposed here tells them apart only a little better than guessing. Do first what tells more:");
  for (std::size_t k = 0; rivals.size() >= 2 && k < rivals.size(); ++k) {
    const Explanation& e = c.explanations.list[rivals[k]];
    sentences.push_back(fmt::format("{}: {}.", e.name, e.effect->separate));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

/// Between files a head that was knocked and a new qualification look alike: the offset of every tip is another one.
std::string to_know_qualifications(const Case& c, const SearchResult& result) {
  if (!result.findings.empty() || result.other) return "";
  std::map<int, const RecordedTouch*> first;  // by tip
  const bool anew = std::any_of(c.rows.begin(), c.rows.end(), [&](int row) {
    const RecordedTouch& t = c.touches.touches[row];
    const RecordedTouch& before = *first.try_emplace(t.scene.stylus.tip_ordinal, &t).first->second;
    return t.file != before.file && t.scene.qualification != before.scene.qualification;
  });
  return anew
      ? "Between the files the styli count as qualified anew. If they were not, give each file the column qualification with one number: what a knock did to the head shows only then."
      : "";
}

/// A part that is not at 20 degrees C expands as a workpiece file says, and not at all where none does.
std::string to_know_the_material(const Case& c, const SearchResult& result) {
  constexpr double kWarm_K = 0.5;
  const std::optional<double>& part_C = c.recording->rows.front().temp_part_C;
  const bool corrected = said(c.recording->metadata, "temperature_compensation") == "on";
  if (c.options.workpiece || corrected || !part_C || std::abs(*part_C - kReferenceTemperature_C) < kWarm_K) return "";
  const bool expands = std::any_of(result.findings.begin(), result.findings.end(), [&](const Finding& f) {
    return std::any_of(f.set.begin(), f.set.end(), [&](int k) {
      return (c.explanations.list[k].effect->needs & static_cast<unsigned>(Covariate::part_temperature)) != 0;
    });
  });
  if (!expands) return "";
  return fmt::format(
      "The part was at {:.1f} degrees C, and no workpiece file tells what it is made of: give one with --workpiece, which costs no measurement.",
      *part_C);
}

/// Rounding is of the file, and not of the machine: nothing is to be mended.
std::string to_record_digits(const Case& c, const Diagnosis& told) {
  const bool rounded = std::any_of(told.effects.begin(), told.effects.end(),
                                   [](const DiagnosedEffect& e) { return e.members.front() == kResolution.name; });
  return rounded
      ? fmt::format("Record the digits that the machine has: x, y and z come in steps of {:g} um.", c.step_um)
      : "";
}

/// Sizes that nobody gave hide the radius of the tip and all that acts like it. A certificate costs no measurement.
std::string to_know_sizes(const Case& c, const SearchResult& result) {
  const bool mismatch = !result.findings.empty() || result.other;
  if (!mismatch || c.options.workpiece || c.baseline.surfaces == Surfaces::calibrated) return "";
  return "The sizes of the part are not known: give those of its certificate with --workpiece, which costs no measurement.";
}

/// A part that was moved between runs of one setup makes what begins with a run, or goes on in time. Of names that are new in a
/// run their sentence says it (findings/tell.cpp).
std::string to_part_runs(const Case& c, const SearchResult& result) {
  const Explanations& all = c.explanations;
  const auto new_in_run = [&](const Finding& f) { return all.variants[f.variant].change.any(); };
  if (!runs_share_a_setup(c) || std::any_of(result.findings.begin(), result.findings.end(), new_in_run)) return "";
  const auto over_runs = [&](const Finding& f) {
    if (f.probability >= kTold && !result.other) return false;
    const Factor factor = shown_in(c, all.list[f.explanation], all.variants[f.variant]);
    return factor == Factor::time || factor == Factor::run;
  };
  if (!std::any_of(result.findings.begin(), result.findings.end(), over_runs) &&
      !(result.other && over_runs(*result.other)))
    return "";
  return "A part that was moved between runs of one setup, by micrometres, looks like this too: if it may have been, give such runs or files different setups.";
}

/// What is new in a file is looked for from run to run: files of one run hide it.
std::string to_number_runs(const Case& c, const SearchResult& result, const Diagnosis& told) {
  std::set<int> files, runs;
  for (const int row : c.rows) files.insert(c.touches.touches[row].file), runs.insert(c.touches.touches[row].scene.run);
  const auto sure = [](const DiagnosedEffect& e) { return e.probability >= kTold; };
  const bool certain = !result.other && std::all_of(told.effects.begin(), told.effects.end(), sure);
  if (files.size() < 2 || runs.size() > 1 || certain) return "";
  return "All files have the same run, and what is new in a file, or gone, is looked for from run to run: give each file a run of its own in the column run, which costs no measurement.";
}

/// What effects of the machine file do along the normal of each row, um.
Vector done_by(const Case& c, const std::vector<EffectSetting>& effects) {
  const EffectSet they(effects, EffectUse::left_in, c.machine->name);
  Vector out(static_cast<Eigen::Index>(c.rows.size()));
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const RecordedTouch& touch = c.touches.touches[c.rows[k]];
    out(static_cast<Eigen::Index>(k)) = kUmPerMm * dot(touch.scene.normal, they.estimate(touch));
  }
  return out;
}

/// No recording is searched for the patterns of the machine file that no effect makes: of one that was mended its opposite
/// is found, and some name looks like that. It explains as well where it leaves no more than the sizes that are free in what was
/// found take up by chance: chi-squared, and two of its standard deviations.
std::string to_take_out_patterns(const Case& c, const SearchResult& result) {
  std::vector<EffectSetting> patterns;
  std::set<std::string> names;
  for (const EffectSetting& of_file : c.machine->effects)
    if (of_file.name.starts_with("empirical.")) patterns.push_back(of_file), names.insert(of_file.name);
  const std::vector<const Matrix*> found = signatures_of(c, result);
  if (patterns.empty() || found.empty()) return "";
  LinearModel without = c.model;
  without.y += done_by(c, patterns);
  const LinearModel beside_found = with_free(c.model, found);
  const auto left = [&](const LinearModel& m) {
    const Precision::Seen y = Precision(m, result.hyper).y();
    return inner(y, y)(0, 0);
  };
  const auto sizes = double(beside_found.free.cols() - c.model.free.cols());
  if (left(without) > left(beside_found) + sizes + 2 * std::sqrt(2 * sizes)) return "";
  return fmt::format(
      "A machine that has no longer what its file has of {} explains the touches as well: if it was mended, take that out of the machine file and diagnose again, which costs no measurement.",
      fmt::join(names, " and "));
}

/// What came suddenly in an earlier recording was there from the start of a later one.
std::string to_begin_at_the_start(const Case& c, const SearchResult& result) {
  if (result.findings.empty() && !result.other) return "";
  for (const EffectSetting& of_file : c.machine->effects)
    if (begins_at_s(of_file) > 0 && find_effect(of_file.name)->stage == Stage::probe)
      return fmt::format(
          "The machine file has {} from {:.0f} s after the start on: if it was there from the start this time, set its t0_s to 0 and diagnose again, which costs no measurement.",
          of_file.name, begins_at_s(of_file));
  return "";
}

/// What the machine file has and these touches do not show may be gone or not: a step in front of all of them, which moves them
/// alike. That nothing was found says nothing of it.
std::string to_see_what_the_file_has(const Case& c, const SearchResult& result) {
  constexpr double kShows = 3;  // signal-to-noise
  if (!result.findings.empty() || result.other) return "";
  std::set<std::string> hidden;
  for (const EffectSetting& of_file : c.machine->effects) {
    if (find_effect(of_file.name)->draws > 0) continue;
    const Vector shows = beside_free(c.model, done_by(c, {of_file}));
    if (shows.cwiseQuotient(c.model.noise_um).norm() < kShows) hidden.insert(of_file.name);
  }
  if (hidden.empty()) return "";
  return fmt::format(
      "These touches cannot tell whether {} of the machine file {} still there: the placement of the part, its size or the qualification takes up what that does.",
      fmt::join(hidden, " and "), hidden.size() == 1 ? "is" : "are");
}

}  // namespace

std::string otherwise(const Case& c, const SearchResult& result, const Diagnosis& told) {
  std::vector<std::string> sentences = {
      to_know_qualifications(c, result), to_number_runs(c, result, told),     to_take_out_patterns(c, result),
      to_begin_at_the_start(c, result),  to_see_what_the_file_has(c, result), to_part_runs(c, result),
      to_know_sizes(c, result),          to_know_the_material(c, result),     besides_sizes(c, result, told),
      to_record_digits(c, told)};
  std::erase(sentences, "");
  return fmt::format("{}", fmt::join(sentences, " "));
}

}  // namespace abbe::diagnose
