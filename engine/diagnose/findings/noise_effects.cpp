// Effects that change no mean but the scatter: judged by the likelihood of a model of the variance, on
// residuals that are each predicted from all other touches (so they are nearly independent, with a variance
// of 1 when the noise is what was fitted).
#include "engine/diagnose/findings/noise_effects.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/findings/scatter.hpp"
#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/effects/noise/noise.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

/// Half the variance of the squared residuals: 1 for normal ones, more for heavy tails, which would pass for
/// unequal scatter.
double tails_of(const Vector& standardised) {
  const double square = standardised.squaredNorm() / double(standardised.size());
  const double fourth = standardised.array().pow(4).sum() / double(standardised.size());
  return std::max(1.0, (fourth / (square * square) - 1) / 2);
}

Residuals residuals(const Case& c, const SearchResult& result) {
  const LinearModel m = with_one_noise(with_free(likelier_ensemble(c, c.model), signatures_of(c, result.findings)));
  const Hyperparameters h = estimate(m);
  Residuals r{leave_one_out(m, h), m.noise_um.mean() * h.noise(0), 1, squared_correlation(m, h)};
  r.tails = tails_of(r.standardised);
  return r;
}

/// Whether what scatters more, in these rows and by this share of their variance, is other each time: repeats
/// of one touch, with the same stylus at the same place, have less than half of it in common. Without repeats
/// nobody knows.
bool other_each_time(const Case& c, const Residuals& r, const Vector& in, double share) {
  const auto pairs = repeats_in(c, in);
  double common = 0, squares = 0;
  for (const auto& [first, again] : pairs) {
    const double a = r.standardised(first), b = r.standardised(again);
    common += a * b, squares += (a * a + b * b) / 2;
  }
  return pairs.size() >= kEnoughRepeats && common < kInCommon * share * squares;
}

/// The interval ends at 0: none of these changes its sign.
DiagnosedParameter figure(const char* name, const char* unit, double value, double u) {
  const double low = value - kNormal95 * u, high = value + kNormal95 * u;
  return {.name = name,
          .unit = unit,
          .value = value,
          .u = u,
          .low = value < 0 ? low : std::max(0.0, low),
          .high = value < 0 ? std::min(0.0, high) : high};
}

/// Touches of one kind that scatter more than the others; `in`: which they are.
struct Unequal {
  NoiseFinding finding;
  Vector in;
};
std::optional<Unequal> unequal(const Case& c, const Residuals& r) {
  std::optional<Unequal> best;
  for (const Split& s : splits_of(c)) {
    if (!parts(s)) continue;
    const Excess e = excess_along(r, s.in);
    const double p = s.of_its_kind * chance_of_excess(e.chi2), ratio = std::sqrt(1 + e.size), u = ratio * relative_u(s);
    if (p > kNoiseAlarm || ratio - 2 * u < kLeastRatio || (best && best->finding.p < p)) continue;
    NoiseFinding f{find_effect("noise.unequal"), p, {figure("ratio", "1", ratio, u)}, {}};
    const double others =
        std::sqrt((r.standardised.array().square() / (1 + e.size * s.in.array())).mean()) * r.noise_um;
    f.parameters.push_back(figure("sd_um", "um", others, others / std::sqrt(2 * (double(s.in.size()) - s.in.sum()))));
    f.parameters.push_back({.name = "group", .unit = "", .word = s.group});
    f.parameters.insert(f.parameters.end(), s.which.begin(), s.which.end());
    f.certain = other_each_time(c, r, s.in, e.size / (1 + e.size));
    f.factor = s.factor, f.where = {s.where};
    f.sentence = fmt::format("T{} scatter {:.1f} times as much as the others.", s.touches.substr(1), ratio);
    best = Unequal{std::move(f), s.in};
  }
  return best;
}

/// What the machine file says already; nothing where it does not have the effect.
std::optional<EffectSetting::Value> in_file(const Case& c, std::string_view effect, const std::string& parameter) {
  for (const EffectSetting& s : c.machine->effects)
    if (const auto found = s.parameters.find(parameter); s.name == effect && found != s.parameters.end())
      return found->second;
  return std::nullopt;
}

std::optional<NoiseFinding> resolution(const Case& c) {
  constexpr double kStored_um = 1e-4;
  constexpr double kSame = 1e-3;
  if (c.rounding_um == 0) return std::nullopt;
  const auto known = in_file(c, "noise.resolution", "resolution_um");
  if (known && std::abs(known->value - c.step_um) <= kSame * c.step_um) return std::nullopt;
  // That every one of so many numbers has this divisor by chance is out of the question.
  NoiseFinding f{find_effect("noise.resolution"), 1e-12, {figure("resolution_um", "um", c.step_um, kStored_um)}, {}};
  f.sentence = fmt::format("All recorded positions are multiples of {:g} um: the readings were rounded.", c.step_um);
  return f;
}

/// Whether touches along one axis scatter much as those along another do; nothing where those of fewer than two tell.
std::optional<bool> alike_along_all_axes(const Case& c, const Residuals& r) {
  constexpr double kAlong = 0.8, kAlike = 1.6;
  constexpr int kEnough = 8;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double square = 0;
    int count = 0;
    for (std::size_t k = 0; k < c.rows.size(); ++k) {
      const TouchScene& s = c.touches.touches[c.rows[k]].scene;
      if (std::abs(s.normal[axis]) < kAlong) continue;
      square += std::pow(r.standardised(static_cast<Eigen::Index>(k)), 2), ++count;
    }
    if (count < kEnough) continue;
    ++axes;
    const double rms = std::sqrt(square / count);
    least = std::min(least, rms), most = std::max(most, rms);
  }
  return axes < 2 ? std::nullopt : std::optional(most <= kAlike * least);
}

/// Scatter that depends on the direction of the normal, or that is far above the machine's in touches that do
/// not scatter more than others.
std::optional<NoiseFinding> vibration(const Case& c, const Residuals& r, const Vector& quiet) {
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
    NoiseFinding f{find_effect("noise.vibration"), p, {figure("sd_um", "um", sd, u)}, {}};
    f.parameters.push_back({.name = "direction", .unit = "", .word = std::string(1, "xyz"[axis])});
    f.certain = other_each_time(c, r, along, e.size / (1 + e.size));
    f.factor = Factor::direction, f.where = {{"normal", std::string("along ") + "xyz"[axis]}};
    f.sentence = fmt::format("Touches along {} scatter by {:.2g} um more than the others: the machine shakes that way.",
                             "xyz"[axis], sd);
    best = std::move(f);
  }
  if (best) return best;
  const double n = quiet.sum(), noise = r.noise_um * std::sqrt(r.standardised.array().square().matrix().dot(quiet) / n);
  const double spec = c.model.noise_um.mean(), excess = noise / spec,
               relative_u = std::sqrt(std::max(1.0, inflation(r.tails, r.coupling, quiet)) / (2 * n)),
               u = excess * relative_u, p = chance_of_ratio(excess, relative_u);
  if (excess < kLeastExcess || p > kNoiseAlarm) return std::nullopt;
  const double sd = spec * std::sqrt(excess * excess - 1), u_sd = spec * excess * u / std::sqrt(excess * excess - 1);
  NoiseFinding f{find_effect("noise.vibration"), p, {figure("sd_um", "um", sd, u_sd)}, {}};
  f.certain = other_each_time(c, r, quiet, 1 - 1 / (excess * excess));
  const std::optional<bool> alike = alike_along_all_axes(c, r);
  f.sentence = fmt::format("Touches scatter {:.1f} times as much as the probe's specification says{}.", excess,
                           !alike       ? ""
                               : *alike ? ", in every direction"
                                        : ", not alike in all directions");
  return f;
}

/// How far each touch that was left out is from what the others predict, um, once the effects that were found are known:
/// what happened at a moment strikes its first touches alone.
Vector beyond_found(const Case& c, const SearchResult& result) {
  std::vector<int> all(c.masked.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Matrix> found;
  for (const Finding& f : result.findings) {
    const Variant& b = c.explanations.variants[f.variant];
    const Effect& effect = *c.explanations.list[f.explanation].effect;
    found.push_back(variant_like(b, effect, c.touches, all).signature);
  }
  if (found.empty()) return c.off_um;
  std::vector<const Matrix*> signatures;
  for (const Matrix& m : found) signatures.push_back(&m);
  return beyond_prediction(with_free(compact(c.baseline.model), signatures), result.hyper, c.masked);
}

/// More touches beyond the limit of gross outliers than normal noise and the machine file put there, and far beyond it.
std::optional<NoiseFinding> outliers(const Case& c, const SearchResult& result) {
  if (c.off_um.size() == 0) return std::nullopt;
  const Vector beyond = beyond_found(c, result);
  std::vector<std::size_t> out;
  double sum = 0, outwards = 0, log_sum = 0, limit = 0;
  std::map<int, int> by_feature;
  for (std::size_t i = 0; i < c.masked.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double off = beyond(row),
                 own = kOutlier * c.baseline.model.noise_um(row) * c.hyper.noise(c.baseline.model.noise_group[i]);
    if (!c.masked[i] || std::abs(off) < own) continue;
    out.push_back(i);
    ++by_feature[c.touches.touches[i].scene.feature];
    sum += std::abs(off), outwards += off, log_sum += std::log(std::abs(off)), limit += own;
  }
  const auto n = static_cast<double>(out.size());
  const double all = static_cast<double>(c.masked.size()), share = n / all;
  const double p = poisson_tail(n, expected_outliers(c));
  if (n < 2 || p > kNoiseAlarm || sum < kFarOut * limit) return std::nullopt;
  const double median = std::copysign(std::exp(log_sum / n), outwards);
  NoiseFinding f{find_effect("noise.outliers"),
                 p,
                 {figure("share", "1", share, std::sqrt(share / all)),
                  figure("size_um", "um", median, kOutlierLogSpread * std::abs(median) / std::sqrt(n))},
                 {}};
  // Dirt lies anywhere in the sequence. What lies so close together by chance in one recording of twenty may
  // be something that happened then.
  constexpr double kByChance = 0.05;
  f.certain = n * std::pow(double(out.back() + 1 - out.front()) / all, n - 1) > kByChance;
  const auto most = std::max_element(by_feature.begin(), by_feature.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  f.factor = Factor::feature, f.where = {{"feature", c.touches.features[most->first]}};
  f.sentence = fmt::format("{:.0f} of {} touches are outliers: dirt, burrs or early triggers.", n, c.masked.size());
  return f;
}

/// Scatter in which neighbours are alike goes on from touch to touch: it is something that has not been found.
void doubt_what_goes_on(double correlation, NoiseFinding& f) {
  constexpr double kAlike = 0.4;
  if (correlation < kAlike) return;
  f.certain = false;
  f.sentence +=
      fmt::format(" But neighbouring touches scatter alike (correlated by {:.2f}): that goes on.", correlation);
}

}  // namespace

double expected_outliers(const Case& c) {
  const auto in_machine = in_file(c, "noise.outliers", "share");
  const double share = 2 * normal_below(-kOutlier) + (in_machine ? in_machine->value + 2 * in_machine->u : 0);
  return static_cast<double>(c.masked.size()) * share;
}

std::vector<NoiseFinding> judge_noise(const Case& c, const SearchResult& result) {
  constexpr int kOfTouches = 2;  // resolution and outliers are told by touches themselves, the others by scatter
  std::vector<std::optional<NoiseFinding>> judged{resolution(c), outliers(c, result)};
  // What an imperfect explanation leaves is no scatter.
  if (!result.other && result.adequacy >= kInadequate) {
    const Residuals r = residuals(c, result);
    Vector quiet = Vector::Ones(r.standardised.size());
    if (std::optional<Unequal> u = unequal(c, r)) quiet -= u->in, judged.push_back(std::move(u->finding));
    judged.push_back(vibration(c, r, quiet));
    for (auto f = judged.begin() + kOfTouches; f != judged.end(); ++f)
      if (*f) doubt_what_goes_on(result.hyper.correlation, **f);
  }
  std::vector<NoiseFinding> out;
  for (std::optional<NoiseFinding>& f : judged)
    if (f) out.push_back(std::move(*f));
  constexpr double kLeastP = 1e-12;  // further out the laws of the tails are not known so well
  for (NoiseFinding& f : out) f.p = std::clamp(kLooks * f.p, kLeastP, 1.0);
  std::stable_sort(out.begin(), out.end(), [](const NoiseFinding& a, const NoiseFinding& b) { return a.p < b.p; });
  return out;
}

}  // namespace abbe::diagnose
