#include "engine/diagnose/baseline/machine_effects.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

void append(LinearModel& m, const Vector& column) {
  if (column.squaredNorm() > 0) m = with_random(std::move(m), column);
}

}  // namespace

void remove_estimates(const EffectSet& effects, RecordedTouches& t) {
  for (RecordedTouch& touch : t.touches) touch.residual_mm -= dot(touch.scene.normal, effects.estimate(touch));
}

void add_uncertainties(const EffectSet& effects, const RecordedTouches& t, Baseline& baseline) {
  LinearModel& m = baseline.model;
  for (const EffectSet::Uncertainty& of : effects.uncertainties()) {
    // Outliers are found one by one (outliers.hpp): they make no other touch less certain.
    if (of.draw >= 0 && effects.effect(of.effect).name == kOutliers.name) continue;
    Vector column(m.y.size());
    for (Eigen::Index i = 0; i < column.size(); ++i) {
      const RecordedTouch& touch = t.touches[i];
      column(i) = kUmPerMm * dot(touch.scene.normal, effects.one_sd(of, touch));
    }
    if (of.per == DrawsPer::touch) {
      m.noise_um = (m.noise_um.array().square() + column.array().square()).sqrt();
    } else if (of.per == DrawsPer::visit) {
      std::map<int, Vector> visits;
      for (Eigen::Index i = 0; i < column.size(); ++i)
        visits.try_emplace(t.touches[i].scene.visit, Vector::Zero(column.size())).first->second(i) = column(i);
      for (const auto& [visit, part] : visits) append(m, part);
    } else {
      append(m, column);
    }
  }
}

void add_rounding(const Machine& machine, double rounding_um, LinearModel& m) {
  const auto& in_file = machine.effects;
  if (std::any_of(in_file.begin(), in_file.end(), [](const EffectSetting& s) { return s.name == kResolution.name; }))
    return;
  m.noise_um = (m.noise_um.array().square() + rounding_um * rounding_um).sqrt();
  m.quietest = std::max(m.quietest, rounding_um / m.noise_um.mean());
}

}  // namespace abbe::diagnose
