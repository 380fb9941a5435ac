// noise.vibration: touches along one axis, or all of them, scatter more than the probe.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/diagnose/explanations/value_called.hpp"
#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

/// From where on more scatter along an axis is worth telling, as a ratio of standard deviations.
constexpr double kLeastAlong = 1.2;

/// Whether touches along one axis scatter much as those along another do; nothing where those of fewer than two tell.
std::optional<bool> alike_along_all_axes(const Case& c, const Residuals& r) {
  constexpr double kAlong = 0.8, kAlike = 1.6;
  constexpr int kEnough = 8;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double square = 0;
    int count = 0;
    for (Eigen::Index k = 0; k < r.standardised.size(); ++k)
      if (std::abs(c.scene(k).normal[axis]) >= kAlong) square += std::pow(r.standardised(k), 2), ++count;
    if (count < kEnough) continue;
    ++axes;
    const double rms = std::sqrt(square / count);
    least = std::min(least, rms), most = std::max(most, rms);
  }
  return axes < 2 ? std::nullopt : std::optional(most <= kAlike * least);
}

/// Scatter that depends on the direction of the normal, or that is far above the machine's in touches that do
/// not scatter more than others.
std::optional<NoiseFinding> judge_vibration(Scatter& scatter) {
  const Case& c = scatter.c;
  const Residuals& r = scatter.residuals;
  const Vector& quiet = scatter.quiet;
  std::optional<NoiseFinding> best;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<Vector> share = share_along(c, axis);
    if (!share) continue;
    const Vector& along = *share;
    const Excess e = excess_along(r, along);
    const double p = chance_of_excess(e.chi2);
    if (p > kNoiseAlarm || std::sqrt(1 + e.size) < kLeastAlong || (best && best->p < p)) continue;
    // The fitted noise is that of all touches together; what is left of it across the axis is the probe's own.
    const double probe =
        r.noise_um * std::sqrt((r.standardised.array().square() / (1 + e.size * along.array())).mean());
    const double sd = probe * std::sqrt(e.size), u = sd * (1 + 1 / e.size) / std::sqrt(2 * along.sum());
    NoiseFinding f{&kVibration, p, {figure("sd_um", "um", sd, u)}, {}};
    f.parameters.push_back({.name = "direction", .word = std::string(1, "xyz"[axis])});
    ask_repeats(scatter, along, e.size / (1 + e.size), f);
    f.factor = Factor::direction, f.where = {{"normal", std::string("along ") + "xyz"[axis]}};
    f.sentence = fmt::format("Touches along {} scatter by {:.2g} um more than the others{}.", "xyz"[axis], sd,
                             f.certain                           ? ": the machine shakes that way"
                                 : f.repeats == Repeats::too_few ? ", as if the machine shook that way"
                                                                 : "");
    best = std::move(f);
  }
  if (best) return best;
  const double n = quiet.sum(), noise = r.noise_um * std::sqrt(r.standardised.array().square().matrix().dot(quiet) / n);
  const double spec = c.model.noise_um.mean(), excess = noise / spec,
               relative_u = std::sqrt(std::max(1.0, inflation(r.tails, r.coupling, quiet)) / (2 * n)),
               u = excess * relative_u, p = chance_of_ratio(excess, relative_u);
  if (excess < kLeastExcess || p > kNoiseAlarm) return std::nullopt;
  const double sd = spec * std::sqrt(excess * excess - 1), u_sd = spec * excess * u / std::sqrt(excess * excess - 1);
  NoiseFinding f{&kVibration, p, {figure("sd_um", "um", sd, u_sd)}, {}};
  ask_repeats(scatter, quiet, 1 - 1 / (excess * excess), f);
  const std::optional<bool> alike = alike_along_all_axes(c, r);
  f.sentence = fmt::format("Touches scatter {:.1f} times as much as the probe's specification says{}.", excess,
                           !alike       ? ""
                               : *alike ? ", in every direction"
                                        : ", not alike in all directions");
  return f;
}

void plan_vibration(const ScatterDesign& design, Diagnosis& out) {
  constexpr int kEveryWay = 3;  // among the directions of the effect
  std::vector<ScatterForm> forms{design.everywhere()};
  std::vector<int> directions{kEveryWay};
  for (int axis = 0; axis < 3; ++axis)
    if (const std::optional<Vector> share = share_along(design.planned(), axis)) {
      forms.push_back(design.along(*share, [](double excess) { return std::sqrt(1 + excess) >= kLeastAlong; }));
      directions.push_back(axis);
    }
  const bool named = median_excess(forms, &ScatterForm::named) < kAtNoSize;
  double ScatterForm::*const by = named ? &ScatterForm::named : &ScatterForm::detected;
  double size = median_excess(forms, by);
  if (size == kAtNoSize)  // along one axis few touches show nothing; in every direction they may
    for (const ScatterForm& form : forms) size = std::min(size, form.detected);
  if (size == kAtNoSize) return;
  const auto told = std::find_if(forms.begin(), forms.end(), [&](const ScatterForm& f) { return f.*by == size; });
  Detectable d = smallest_of(kVibration, "sd_um", "um");
  d.detect = d.detect_um = design.noise_um() * std::sqrt(told->detected);
  if (named) d.name = d.name_um = design.noise_um() * std::sqrt(told->named);
  const auto& direction = *std::find_if(kVibration.parameters.begin(), kVibration.parameters.end(),
                                        [](const EffectParameter& p) { return p.name == "direction"; });
  const int code = directions[static_cast<std::size_t>(told - forms.begin())];
  d.form.push_back({.name = std::string(direction.name), .word = word_of(direction, code, design.planned().touches)});
  out.smallest_detectable.push_back(std::move(d));
}

}  // namespace

const NoiseProperty kJudgedVibration{&kVibration, true, judge_vibration, plan_vibration};

}  // namespace abbe::diagnose
