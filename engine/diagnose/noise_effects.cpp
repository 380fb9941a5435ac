// Effects that change no mean but the scatter: judged by the likelihood of a model of the variance, on residuals that are each
// predicted from all other touches (so they are nearly independent, with a variance of 1 when the noise is what was fitted).
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

namespace {

/// Three looks at the variance may not cost more false alarms than a tenth of what the search allows itself.
constexpr double kNoiseAlarm = 3e-4;

/// The probability that a chi-squared variable of one degree of freedom exceeds x.
double chi2_above_1(double x) { return std::erfc(std::sqrt(std::max(0.0, x) / 2)); }

struct Residuals {
  Vector standardised;              ///< variance 1 under the fitted noise
  Vector um;
};

Residuals residuals(const Case& c, const SearchResult& result) {
  std::vector<const Matrix*> named;
  for (const Finding& f : result.findings) named.push_back(&c.explanations.blocks[f.block].signature);
  if (result.other) named.push_back(&c.explanations.blocks[result.other->block].signature);
  // One noise for all rows, so that a difference between groups shows.
  LinearModel m = with_free(c.model, named);
  m.noise_group.assign(m.noise_group.size(), 0);
  m.noise_groups = 1;
  const Hyperparameters h = estimate(m);
  Residuals r{leave_one_out(m, h), {}};
  r.um = r.standardised.array() * m.noise_um.array() * h.noise(0);
  return r;
}

DiagnosedParameter figure(const char* name, const char* unit, double value, double u) {
  return {.name = name, .unit = unit, .value = value, .u = u, .low = std::max(0.0, value - 1.96 * u), .high = value + 1.96 * u};
}

/// Two groups of touches with different scatter: the likelihood ratio of two variances against one.
std::optional<NoiseFinding> unequal(const Case& c, const Residuals& r) {
  constexpr double kLeastRatio = 1.5;
  struct Split {
    const char* what;
    const char* word;
    std::vector<char> in;
  };
  std::vector<Split> splits{{"long styli", "long stylus", {}}, {"tilted head", "tilted head", {}}, {"fast probing", "fast probing", {}}};
  std::vector<double> length, speed;
  for (const int i : c.rows) length.push_back(c.touches.touches[i].scene.stylus.length_mm), speed.push_back(c.touches.touches[i].scene.speed_mm_s);
  const auto middle = [](const std::vector<double>& v) { return (*std::min_element(v.begin(), v.end()) + *std::max_element(v.begin(), v.end())) / 2; };
  const double length_limit = middle(length), speed_limit = middle(speed);
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    splits[0].in.push_back(length[k] > length_limit + 1);
    splits[1].in.push_back(std::abs(c.touches.touches[c.rows[k]].scene.stylus.head_a_rad) > 0.02);
    splits[2].in.push_back(speed[k] > speed_limit + 1e-6);
  }
  std::optional<NoiseFinding> best;
  for (std::size_t s = 0; s < splits.size(); ++s) {
    double square[2] = {}, n[2] = {};
    for (std::size_t k = 0; k < splits[s].in.size(); ++k) {
      const int g = splits[s].in[k] ? 1 : 0;
      square[g] += std::pow(r.standardised(static_cast<Eigen::Index>(k)), 2);
      n[g] += 1;
    }
    if (n[0] < 20 || n[1] < 20) continue;
    const double v[2] = {square[0] / n[0], square[1] / n[1]}, pooled = (square[0] + square[1]) / (n[0] + n[1]);
    const double ratio = std::sqrt(v[1] / v[0]), u = ratio * std::sqrt(1 / (2 * n[0]) + 1 / (2 * n[1]));
    const double p = chi2_above_1((n[0] + n[1]) * std::log(pooled) - n[0] * std::log(v[0]) - n[1] * std::log(v[1]));
    if (p > kNoiseAlarm || ratio - 2 * u < kLeastRatio || (best && best->p < p)) continue;
    NoiseFinding f{find_effect("noise.unequal"), p, {figure("ratio", "1", ratio, u)}, {}};
    f.parameters.push_back({.name = "group", .unit = "", .word = splits[s].word});
    f.sentence = fmt::format("Touches with {} scatter {:.1f} times as much as the others.", splits[s].what, ratio);
    best = std::move(f);
  }
  return best;
}

/// Positions that are all multiples of one step.
std::optional<NoiseFinding> resolution(const Case& c) {
  constexpr double kLeastOfNoise = 0.3, kCoherent = 0.98, kStored_um = 1e-4;
  for (const double step_um : {10.0, 5.0, 2.0, 1.0, 0.5, 0.25, 0.2, 0.1}) {
    double sum = 0, n = 0;
    for (const int i : c.rows) {
      const RecordingRow& row = c.recording->rows[c.touches.touches[i].row];
      for (int k = 0; k < 3; ++k) {
        if (std::abs((*row.normal)[k]) < 0.3) continue;
        sum += std::cos(2 * kPi * std::remainder(1e3 * row.position_mm[k], step_um) / step_um);
        n += 1;
      }
    }
    if (n < 20 || sum / n < kCoherent) continue;
    if (step_um / std::sqrt(12.0) < kLeastOfNoise * c.model.noise_um.mean()) return std::nullopt;
    NoiseFinding f{find_effect("noise.resolution"), std::exp(-n), {figure("resolution_um", "um", step_um, kStored_um)}, {}};
    f.sentence = fmt::format("All recorded positions are multiples of {:g} um: the readings were rounded.", step_um);
    return f;
  }
  return std::nullopt;
}

/// Scatter that depends on the direction of the normal, or that is far above the machine's.
std::optional<NoiseFinding> vibration(const Case& c, const Residuals& r) {
  constexpr double kLeastExcess = 1.6;
  std::optional<NoiseFinding> best;
  const double n = static_cast<double>(c.rows.size());
  for (int axis = 0; axis < 3; ++axis) {
    // Var = 1 + a (n_axis^2 - mean): a by least squares of the squared residuals, whose variance is 2.
    double mean = 0, sxx = 0, sxy = 0;
    for (const int i : c.rows) mean += std::pow(c.touches.touches[i].scene.normal[axis], 2) / n;
    for (std::size_t k = 0; k < c.rows.size(); ++k) {
      const double x = std::pow(c.touches.touches[c.rows[k]].scene.normal[axis], 2) - mean;
      sxx += x * x;
      sxy += x * (std::pow(r.standardised(static_cast<Eigen::Index>(k)), 2) - 1);
    }
    if (sxx < 1) continue;
    const double a = sxy / sxx, statistic = a * a * sxx / 2, p = chi2_above_1(statistic);
    const double along = std::max(0.0, 1 + a * (1 - mean)), across = std::max(0.05, 1 - a * mean);
    if (a <= 0 || p > kNoiseAlarm / 3 || std::sqrt(along / across) < kLeastExcess || (best && best->p < p)) continue;
    const double noise = c.model.noise_um.mean() * c.hyper.noise.mean();
    const double sd = noise * std::sqrt(std::max(0.0, along - across));
    NoiseFinding f{find_effect("noise.vibration"), p, {figure("sd_um", "um", sd, sd * std::sqrt(1 / (2 * n * mean)))}, {}};
    f.parameters.push_back({.name = "direction", .unit = "", .word = std::string(1, "xyz"[axis])});
    f.sentence = fmt::format("Touches along {} scatter by {:.2g} um more than the others: the machine shakes that way.", "xyz"[axis], sd);
    best = std::move(f);
  }
  if (best) return best;
  const double excess = c.hyper.noise.minCoeff();
  const double u = 1 / std::sqrt(2 * n);
  if (excess - 3 * u < kLeastExcess) return std::nullopt;
  const double spec = c.model.noise_um.mean(), sd = spec * std::sqrt(excess * excess - 1);
  NoiseFinding f{find_effect("noise.vibration"), std::erfc((excess - kLeastExcess) / u), {figure("sd_um", "um", sd, sd * u)}, {}};
  f.sentence = fmt::format("Touches scatter {:.1f} times as much as the probe's specification says, in every direction.", excess);
  return f;
}

std::optional<NoiseFinding> outliers(const Case& c) {
  constexpr double kLeastShare = 0.015;
  double n = 0, sum = 0;
  for (std::size_t i = 0; i < c.masked.size(); ++i)
    if (c.masked[i]) n += 1, sum += 1e3 * std::abs(c.touches.touches[i].residual_mm);
  const double all = static_cast<double>(c.masked.size()), share = n / all;
  if (n < 4 || share < kLeastShare) return std::nullopt;
  NoiseFinding f{find_effect("noise.outliers"), std::exp(-n), {figure("share", "1", share, std::sqrt(share / all)), figure("size_um", "um", sum / n, sum / n / std::sqrt(n))}, {}};
  f.sentence = fmt::format("{:.0f} of {} touches are outliers: dirt, burrs or early triggers.", n, c.masked.size());
  return f;
}

}  // namespace

std::vector<NoiseFinding> judge_noise(const Case& c, const SearchResult& result) {
  const Residuals r = residuals(c, result);
  std::vector<NoiseFinding> out;
  for (std::optional<NoiseFinding> f : {resolution(c), unequal(c, r), vibration(c, r), outliers(c)})
    if (f) out.push_back(std::move(*f));
  std::stable_sort(out.begin(), out.end(), [](const NoiseFinding& a, const NoiseFinding& b) { return a.p < b.p; });
  return out;
}

}  // namespace abbe::diagnose
