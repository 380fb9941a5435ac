#include "engine/diagnose/findings/caveats.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/effects/direction.hpp"
#include "engine/run/recorded/from_program.hpp"
#include "engine/run/recorded/logged.hpp"

namespace abbe::diagnose {

std::string pattern_beside(const Case& c, const Finding& f) {
  const CredibleSet pattern = credible_set(c.explanations, f.evidence, false);
  if (pattern.explanation < 0 || kAsWell * pattern.probability < f.probability) return "";
  const Explanation& e = c.explanations.list[pattern.explanation];
  return fmt::format(" A pattern over {} ({}) that no single effect of the catalogue makes would explain it as well.",
                     name(e.factor), e.shape);
}

std::string not_of_one_size(const Finding& f) {
  if (!of_several_sizes(f.sizes)) return "";
  return fmt::format(" But its size {}. Such an effect has one size: it may be something else that looks like it.",
                     in_words(*f.sizes));
}

std::string beside_large_errors(double times) {
  return fmt::format(
      " But beside it the machine's errors would have to be {:.1f} times those of its specification: something else hides in them, or made both.",
      times);
}

std::string whose_coordinates(const Case& c, const Effect& effect) {
  if (c.recording->in_part_frame || lies_as_planned(*c.recording) ||
      (effect.needs & static_cast<unsigned>(Covariate::part_frame)) == 0)
    return "";
  return " Places on the part are counted from the centre of its targets; for its own coordinates, in which a program would simulate it, give --program.";
}

std::string warmer_in_one_placement(const Case& c) {
  if (c.touches.known & static_cast<unsigned>(Covariate::part_temperature)) return "";
  return " A part that was warmer or colder in one placement looks like this, too: log temp_part_C.";
}

std::string warmer_in_one_placement(const Case& c, const Effect& effect, const Variant& variant) {
  return effect.stage == Stage::part && in_one_placement(effect, variant) ? warmer_in_one_placement(c) : "";
}

std::string much_like_it(const Effect& effect) {
  if (!effect.only_spread) return "";
  return fmt::format(" It has no law but a spread, and much else looks like that. What would tell: {}.",
                     effect.separate);
}

std::string whose_direction(const Effect& effect) {
  const bool has_direction = std::any_of(effect.parameters.begin(), effect.parameters.end(),
                                         [](const EffectParameter& p) { return is_direction(p); });
  if (effect.stage != Stage::probe || !has_direction) return "";
  return " Its direction is that of the probe body, which turns with the head: z is along the body, towards the head.";
}

std::string whose_coefficient(const Effect& effect, const std::vector<DiagnosedParameter>& told) {
  const auto& all = effect.parameters;
  const auto coefficient = std::find_if(all.begin(), all.end(), [](const EffectParameter& p) {
    return p.unit == "ppm/K" && !p.linear && p.standard != 0;
  });
  const auto reckoned = [](const DiagnosedParameter& p) { return p.unit == "K"; };
  if (coefficient == all.end() || std::none_of(told.begin(), told.end(), reckoned)) return "";
  return fmt::format(" Kelvins are reckoned with {:g} ppm/K: of what expands less there are as many more.",
                     coefficient->standard);
}

std::string what_does_nearly_the_same(const Effect& effect, const Variant& variant,
                                      const std::vector<DiagnosedParameter>& told) {
  constexpr double kNearly = 0.2;  // of the column
  const auto told_of = [&](const Column& column) {
    return std::find_if(told.begin(), told.end(), [&](const DiagnosedParameter& p) {
      return column.parameter >= 0 && p.name == effect.parameters[column.parameter].name;
    });
  };
  const auto is_told = [&](const Column& column) { return told_of(column) != told.end(); };
  if (variant.joined || std::count_if(variant.columns.begin(), variant.columns.end(), is_told) != 1) return "";
  const auto own = std::find_if(variant.columns.begin(), variant.columns.end(), is_told);
  const Vector does = variant.signature.col(own - variant.columns.begin());
  std::vector<std::string> others;
  for (std::size_t k = 0; k < variant.columns.size(); ++k) {
    const Vector other = variant.signature.col(static_cast<Eigen::Index>(k));
    const double times = does.dot(other) / other.squaredNorm();
    if (is_told(variant.columns[k]) || variant.columns[k].assumed ||
        (does - times * other).norm() > kNearly * does.norm())
      continue;
    const EffectParameter& p = effect.parameters[variant.columns[k].parameter];
    DiagnosedParameter instead = *told_of(*own);
    const double unit = times * variant.columns[k].unit / own->unit;
    instead.name = p.name, instead.unit = p.unit;
    instead.value *= unit, instead.u *= std::abs(unit);
    const auto [low, high] = std::minmax({instead.low * unit, instead.high * unit});
    instead.low = low, instead.high = high;
    if (instead.high < p.low || instead.low > p.high) continue;  // no such effect has such a size
    others.push_back(with_uncertainty(instead));
  }
  return others.empty() ? "" : fmt::format(" Here {} would do nearly the same.", fmt::join(others, " or "));
}

std::string whose_surroundings(const Case& c, const Effect& effect, const Variant& variant,
                               const std::vector<DiagnosedParameter>& told) {
  const auto told_by_assumption = [&](const Column& column) {
    return column.assumed && std::any_of(told.begin(), told.end(), [&](const DiagnosedParameter& p) {
             return p.name == effect.parameters[column.parameter].name;
           });
  };
  if (std::none_of(variant.columns.begin(), variant.columns.end(), told_by_assumption)) return "";
  const std::vector<std::string> absent = columns_of(effect.needs & kMayBeAssumed & ~c.touches.known);
  const std::string why = absent.empty()
      ? fmt::format("In the recording {} is the same throughout, whatever the placement",
                    fmt::join(columns_of(effect.needs & kMayBeAssumed & ~c.touches.varying), ", "))
      : fmt::format("The recording has no {}", fmt::join(absent, ", "));
  return fmt::format(
      " {}, and this size goes by a value that was assumed: log it. Until then no machine file carries it.", why);
}

std::string whose_clock(const Case& c, const Effect& effect) {
  const auto time = static_cast<unsigned>(Covariate::time);
  if ((effect.needs & time) == 0 || (c.touches.known & time) != 0) return "";
  return fmt::format(
      " The recording has no time_s: seconds are those of a touch every {:g} seconds; log time_s. Until then no machine file carries it.",
      kUsualInterval_s);
}

std::string unless_said(const std::vector<DiagnosedEffect>& effects, const std::string& note) {
  const bool said = std::any_of(effects.begin(), effects.end(),
                                [&](const DiagnosedEffect& e) { return e.sentence.find(note) != std::string::npos; });
  return said ? "" : note;
}

bool may_be_rounding(const Case& c, const std::optional<double>& largest_um) {
  const Vec3& probe = c.machine->probe.sd_mm;
  return largest_um && *largest_um < c.step_um &&
      c.step_um / std::sqrt(12.0) > kUmPerMm * std::max({probe.x, probe.y, probe.z});
}

}  // namespace abbe::diagnose
