#include "engine/diagnose/values/value_signature.hpp"

#include <map>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/findings/carried.hpp"
#include "engine/effects/effect.hpp"
#include "engine/run/run.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kSameValue_um = 1e-6;

/// What a file of values does not tell: when, at which readings and loads, and what is drawn anew each time.
constexpr unsigned kNotInValues =
    Covariate::time | Covariate::raw_reading | Covariate::acceleration | Covariate::visit | Covariate::qualification;
/// What a workpiece file may tell.
unsigned unknown_of_part(const Workpiece* w) {
  unsigned unknown = 0;
  if (!w || !w->knows.part) unknown = unknown | Covariate::part_temperature;
  if (!w || !w->knows.scale[0] || !w->knows.scale[1] || !w->knows.scale[2])
    unknown = unknown | Covariate::scale_temperature;
  if (!w || !w->knows.air) unknown = unknown | Covariate::air_temperature;
  if (!w || !w->knows.load) unknown = unknown | Covariate::load;
  return unknown;
}

/// One program run with one effect of one setting.
struct Planting {
  const Effect* effect = nullptr;
  std::vector<double> theta;
};

class Plantation {
 public:
  Plantation(const std::vector<RecordedValue>& values, const std::vector<ValueProgram>& programs,
             const Machine& machine, const VirtualMachines& machines, const DiagnoseOptions& options)
      : values_(one_repeat(values)),  // nothing is drawn: one tells them all
        programs_(programs),
        machine_(machine),
        options_(options),
        one_(first_of(machines, 1)) {
    options_.threads = 1;  // plantings are on threads
    contributors_.effects = true;
  }

  /// The deviations of all values; NaN where the planted machine does not get.
  Vector signature(const Planting& planting) const {
    Machine planted = machine_;
    planted.effects = {setting_at(*planting.effect, planting.theta)};
    return simulated_values(values_, programs_, planted, one_, options_, contributors_).row(0);
  }

 private:
  std::vector<RecordedValue> values_;
  const std::vector<ValueProgram>& programs_;
  const Machine& machine_;
  DiagnoseOptions options_;
  Contributors contributors_ = Contributors::none();
  VirtualMachines one_;
};

/// Every combination of the choices; sizes at zero, everything else at its usual value.
std::vector<std::vector<double>> settings_of(const Effect& effect) {
  std::vector<std::vector<double>> list{{}};
  for (const EffectParameter& p : effect.parameters) {
    std::vector<double> values{p.linear ? 0.0 : p.standard != 0 ? p.standard : p.typical};
    if (!p.choices.empty()) {
      values.clear();
      for (std::size_t k = 0; k < p.choices.size(); ++k)
        if (p.choices[k] != "oblique") values.push_back(p.low + double(k));  // a direction is spanned by the axes
    }
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& prefix : list)
      for (const double v : values) longer.push_back(prefix), longer.back().push_back(v);
    list = std::move(longer);
  }
  return list;
}

/// A variant without its columns and the plantings that give them.
struct Draft {
  Variant variant;
  std::vector<Planting> plantings;
  std::vector<int> parameter;
  double sign = 1;  ///< of the sizes that are planted: a position or a form is no linear function of them
};

/// Typical sizes are those of what is watched: a part whose temperature nobody told is off by more than its sensor errs,
/// about as much as a scale.
double usual_size(const Effect& effect, std::size_t p, unsigned unknown) {
  constexpr double kUnwatched = 5;
  return ((effect.needs & unknown) != 0 ? kUnwatched : 1) * effect.parameters[p].typical;
}

std::vector<Draft> drafts_of(const Effect& effect, unsigned unknown) {
  std::vector<Draft> list;
  for (const std::vector<double>& theta : settings_of(effect)) {
    for (const double sign : {1.0, -1.0}) {
      Draft d;
      d.variant.theta = theta;
      d.sign = sign;
      for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
        const EffectParameter& parameter = effect.parameters[p];
        const double size = sign * usual_size(effect, p, unknown);
        if (!parameter.linear || size < parameter.low || size > parameter.high) continue;
        Planting planting{&effect, theta};
        planting.theta[p] = size;
        d.plantings.push_back(std::move(planting));
        d.parameter.push_back(static_cast<int>(p));
      }
      if (!d.plantings.empty()) list.push_back(std::move(d));
    }
  }
  return list;
}

/// The signatures of all plantings, on all threads.
std::vector<Vector> grow(const Plantation& plantation, const std::vector<Planting>& plantings, int threads) {
  std::vector<Vector> out(plantings.size());
  on_threads(static_cast<int>(plantings.size()), threads, [&](int k) { out[k] = plantation.signature(plantings[k]); });
  return out;
}

bool repeats_values(const Variant& variant, const Explanation& of, const std::vector<Variant>& variants) {
  return std::any_of(of.variants.begin(), of.variants.end(),
                     [&](int k) { return same_columns(variants[k].signature, variant.signature, kSameValue_um); });
}

void add(const Effect& effect, std::vector<Draft>& drafts, const std::vector<Vector>& grown, std::size_t& at,
         unsigned unknown, Explanations& out) {
  Explanation e;
  e.name = std::string(effect.name);
  e.effect = &effect;
  for (Draft& d : drafts) {
    for (const int p : d.parameter) {
      const Vector& values = grown[at++];
      if (!values.allFinite() || values.cwiseAbs().maxCoeff() < kSameValue_um) continue;
      d.variant.columns.push_back({p, 0, usual_size(effect, static_cast<std::size_t>(p), unknown)});
      d.variant.signature.conservativeResize(values.size(), d.variant.signature.cols() + 1);
      d.variant.signature.rightCols(1) = d.sign * values;
    }
    if (d.variant.columns.empty() || repeats_values(d.variant, e, out.variants)) continue;
    d.variant.explanation = static_cast<int>(out.list.size());
    e.variants.push_back(static_cast<int>(out.variants.size()));
    out.variants.push_back(std::move(d.variant));
  }
  share_belief(e, out.variants);
  e.missing = effect.needs & unknown;
  if (e.missing || e.variants.empty()) out.unjudged.push_back({&effect, e.missing, 0});
  if (!e.variants.empty()) out.list.push_back(std::move(e));
}

}  // namespace

Explanations value_explanations(const std::vector<RecordedValue>& values, const std::vector<ValueProgram>& programs,
                                const Machine& machine, const VirtualMachines& machines,
                                const DiagnoseOptions& options) {
  const unsigned unknown = unknown_of_part(options.workpiece);
  Explanations out;
  std::vector<const Effect*> judged;
  std::vector<std::vector<Draft>> drafts;
  std::vector<Planting> plantings;
  for (const Effect* effect : effects()) {
    // What is drawn by chance has no signature in values, whatever is told with them. Of a part at an unknown temperature
    // what does not ask for it stays an explanation, though one that cannot be judged: an error of its sensor.
    if ((effect->needs & kNotInValues) != 0 || effect->draws > 0) {
      out.unjudged.push_back({effect, effect->needs & (kNotInValues | unknown), 0});
      continue;
    }
    judged.push_back(effect);
    drafts.push_back(drafts_of(*effect, unknown));
    for (const Draft& d : drafts.back()) plantings.insert(plantings.end(), d.plantings.begin(), d.plantings.end());
  }
  const std::vector<Vector> grown =
      grow(Plantation(values, programs, machine, machines, options), plantings, options.threads);
  std::size_t at = 0;
  for (std::size_t k = 0; k < judged.size(); ++k) add(*judged[k], drafts[k], grown, at, unknown, out);
  return out;
}

}  // namespace abbe::diagnose
