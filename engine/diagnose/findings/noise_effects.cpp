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

#include "engine/diagnose/model/noise_law.hpp"
#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

/// The looks at the scatter: three groups, three axes, all touches, outliers.
constexpr int kLooks = 8;
/// Together they may not cost more false alarms than a tenth of what the search allows itself.
constexpr double kNoiseAlarm = kAlarm / 10 / kLooks;

/// The probability that a chi-squared variable of one degree of freedom exceeds x.
double chi2_above_1(double x) { return std::erfc(std::sqrt(std::max(0.0, x) / 2)); }

struct Residuals {
  Vector standardised;  ///< variance 1 under the fitted noise
  double noise_um = 1;  ///< that noise
  double tails = 1;     ///< by how much squares scatter more than those of normal residuals
  Matrix coupling;      ///< squares of their correlations: what is common to many rows counts less
};

/// Half the variance of the squared residuals: 1 for normal ones, more for heavy tails, which would pass for
/// unequal scatter.
double tails_of(const Vector& standardised) {
  const double square = standardised.squaredNorm() / double(standardised.size());
  const double fourth = standardised.array().pow(4).sum() / double(standardised.size());
  return std::max(1.0, (fourth / (square * square) - 1) / 2);
}

Residuals residuals(const Case& c, const SearchResult& result) {
  // One noise for all rows, so that a difference between groups shows.
  LinearModel m = with_free(likelier_ensemble(c, c.model), signatures_of(c, result.findings));
  m.noise_group.assign(m.noise_group.size(), 0);
  m.noise_groups = 1;
  const Hyperparameters h = estimate(m);
  Residuals r{leave_one_out(m, h), m.noise_um.mean() * h.noise(0), 1, squared_correlation(m, h)};
  r.tails = tails_of(r.standardised);
  return r;
}

/// Variances 1 + excess * share, times a common factor: what they gain over equal ones. The gain of
/// independent normal residuals has half a chi-squared law; that of others is larger by the variance of the
/// score, sum of share times square, over what it would be for those.
struct Excess {
  double size = 0, p = 1;
};
Excess excess_along(const Residuals& r, const Vector& share) {
  const Vector square = r.standardised.array().square(), centred = share.array() - share.mean();
  const double inflation = r.tails - 1 + centred.dot(r.coupling * centred) / centred.squaredNorm();
  const auto n = static_cast<double>(square.size());
  const auto log_likelihood = [&](double excess) {
    const Vector v = 1 + excess * share.array();
    return -0.5 * (v.array().log().sum() + n * std::log((square.array() / v.array()).mean()));
  };
  Excess out;
  double best = 0;
  for (double excess = 0.05; excess < 300; excess *= 1.15) {
    const double gain = log_likelihood(excess) - log_likelihood(0);
    if (gain > best) best = gain, out.size = excess;
  }
  out.p = chi2_above_1(2 * best / std::max(1.0, inflation)) / 2;
  return out;
}

/// Whether what scatters more, in these rows and by this share of their variance, is other each time: repeats
/// of one touch, with the same stylus at the same place, have less than half of it in common. Without repeats
/// nobody knows.
bool other_each_time(const Case& c, const Residuals& r, const Vector& in, double share) {
  constexpr int kEnough = 20;
  constexpr double kPerMm = 1e3, kPerUnit = 1e4;  // the same to a micrometre, and to a tenth of a milliradian
  std::map<std::array<long, 8>, Eigen::Index> first;
  double common = 0, squares = 0;
  int pairs = 0;
  for (Eigen::Index k = 0; k < in.size(); ++k) {
    if (in(k) < 0.5) continue;
    const TouchScene& s = c.touches.touches[static_cast<std::size_t>(c.rows[static_cast<std::size_t>(k)])].scene;
    std::array<long, 8> key{s.setup, s.stylus.tip_ordinal};
    for (int a = 0; a < 3; ++a)
      key[2 + a] = std::lround(kPerMm * s.point[a]), key[5 + a] = std::lround(kPerUnit * s.normal[a]);
    const auto [at, is_first] = first.try_emplace(key, k);
    if (is_first) continue;
    const double a = r.standardised(at->second), b = r.standardised(k);
    common += a * b, squares += (a * a + b * b) / 2;
    ++pairs;
  }
  return pairs >= kEnough && common < 0.5 * share * squares;
}

DiagnosedParameter figure(const char* name, const char* unit, double value, double u) {
  return {.name = name,
          .unit = unit,
          .value = value,
          .u = u,
          .low = std::max(0.0, value - 1.96 * u),
          .high = value + 1.96 * u};
}

/// Touches of one kind that scatter more than the others; `in`: which they are.
struct Unequal {
  NoiseFinding finding;
  Vector in;
};
std::optional<Unequal> unequal(const Case& c, const Residuals& r) {
  constexpr double kLeastRatio = 1.1;
  constexpr int kEnough = 20;
  const auto rows = static_cast<Eigen::Index>(c.rows.size());
  const auto scene = [&](Eigen::Index k) -> const TouchScene& {
    return c.touches.touches[static_cast<std::size_t>(c.rows[static_cast<std::size_t>(k)])].scene;
  };
  Vector length(rows), speed(rows);
  for (Eigen::Index k = 0; k < rows; ++k) length(k) = scene(k).stylus.length_mm, speed(k) = scene(k).speed_mm_s;
  const double long_mm = (length.minCoeff() + length.maxCoeff()) / 2 + 1,
               fast_mm_s = (speed.minCoeff() + speed.maxCoeff()) / 2 + 1e-6;
  /// A group of the effect, by its name there, and the limit that parts it from the others.
  struct Split {
    const char* group;
    Factor factor;
    std::optional<DiagnosedParameter> limit;
    Vector in;
  };
  std::vector<Split> splits{
      {"long styli", Factor::sensor, figure("longer_than_mm", "mm", long_mm, 0), Vector(rows)},
      {"tilted head", Factor::head, std::nullopt, Vector(rows)},
      {"fast probing", Factor::speed, figure("faster_than_mm_s", "mm/s", fast_mm_s, 0), Vector(rows)}};
  for (Eigen::Index k = 0; k < rows; ++k) {
    splits[0].in(k) = length(k) > long_mm;
    splits[1].in(k) = std::abs(scene(k).stylus.head_a_rad) > kUpright_rad;
    splits[2].in(k) = speed(k) > fast_mm_s;
  }
  std::optional<Unequal> best;
  for (const Split& s : splits) {
    const double in = s.in.sum(), out = double(rows) - in;
    if (in < kEnough || out < kEnough) continue;
    const Excess e = excess_along(r, s.in);
    const double ratio = std::sqrt(1 + e.size), u = ratio * std::sqrt(1 / (2 * in) + 1 / (2 * out));
    if (e.p > kNoiseAlarm || ratio - 2 * u < kLeastRatio || (best && best->finding.p < e.p)) continue;
    NoiseFinding f{find_effect("noise.unequal"), e.p, {figure("ratio", "1", ratio, u)}, {}};
    const double others =
        std::sqrt((r.standardised.array().square() / (1 + e.size * s.in.array())).mean()) * r.noise_um;
    f.parameters.push_back(figure("sd_um", "um", others, others / std::sqrt(2 * out)));
    f.parameters.push_back({.name = "group", .unit = "", .word = s.group});
    if (s.limit) f.parameters.push_back(*s.limit);
    f.certain = other_each_time(c, r, s.in, e.size / (1 + e.size));
    f.factor = s.factor, f.where = {{"group", s.group}};
    f.sentence = fmt::format("Touches with {} scatter {:.1f} times as much as the others.", s.group, ratio);
    best = Unequal{std::move(f), s.in};
  }
  return best;
}

std::optional<NoiseFinding> resolution(const Case& c) {
  constexpr double kStored_um = 1e-4;
  if (c.rounding_um == 0) return std::nullopt;
  // That every one of so many numbers has this divisor by chance is out of the question.
  NoiseFinding f{find_effect("noise.resolution"), 1e-12, {figure("resolution_um", "um", c.step_um, kStored_um)}, {}};
  f.sentence = fmt::format("All recorded positions are multiples of {:g} um: the readings were rounded.", c.step_um);
  return f;
}

/// Whether touches along one axis scatter much as those along another do.
bool alike_along_all_axes(const Case& c, const Residuals& r) {
  constexpr double kAlong = 0.8, kAlike = 1.6;
  constexpr int kEnough = 8;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double square = 0;
    int count = 0;
    for (std::size_t k = 0; k < c.rows.size(); ++k) {
      const TouchScene& s = c.touches.touches[static_cast<std::size_t>(c.rows[k])].scene;
      if (std::abs(s.normal[axis]) < kAlong) continue;
      square += std::pow(r.standardised(static_cast<Eigen::Index>(k)), 2), ++count;
    }
    if (count < kEnough) continue;
    const double rms = std::sqrt(square / count);
    least = std::min(least, rms), most = std::max(most, rms);
  }
  return most <= kAlike * least;
}

/// Scatter that depends on the direction of the normal, or that is far above the machine's in touches that do
/// not scatter more than others.
std::optional<NoiseFinding> vibration(const Case& c, const Residuals& r, const Vector& quiet) {
  constexpr double kLeastExcess = 1.6, kLeastAlong = 1.2;
  std::optional<NoiseFinding> best;
  for (int axis = 0; axis < 3; ++axis) {
    Vector along(r.standardised.size());
    for (std::size_t k = 0; k < c.rows.size(); ++k)
      along(static_cast<Eigen::Index>(k)) =
          std::pow(c.touches.touches[static_cast<std::size_t>(c.rows[k])].scene.normal[axis], 2);
    if ((along.array() - along.mean()).square().sum() < 1) continue;
    const Excess e = excess_along(r, along);
    if (e.p > kNoiseAlarm || std::sqrt(1 + e.size) < kLeastAlong || (best && best->p < e.p)) continue;
    // The fitted noise is that of all touches together; what is left of it across the axis is the probe's own.
    const double probe =
        r.noise_um * std::sqrt((r.standardised.array().square() / (1 + e.size * along.array())).mean());
    const double sd = probe * std::sqrt(e.size), u = sd * (1 + 1 / e.size) / std::sqrt(2 * along.sum());
    NoiseFinding f{find_effect("noise.vibration"), e.p, {figure("sd_um", "um", sd, u)}, {}};
    f.parameters.push_back({.name = "direction", .unit = "", .word = std::string(1, "xyz"[axis])});
    f.certain = other_each_time(c, r, along, e.size / (1 + e.size));
    f.factor = Factor::direction, f.where = {{"normal", std::string("along ") + "xyz"[axis]}};
    f.sentence = fmt::format("Touches along {} scatter by {:.2g} um more than the others: the machine shakes that way.",
                             "xyz"[axis], sd);
    best = std::move(f);
  }
  if (best) return best;
  const double n = quiet.sum(), noise = r.noise_um * std::sqrt(r.standardised.array().square().matrix().dot(quiet) / n);
  const double spec = c.model.noise_um.mean(), excess = noise / spec, u = excess / std::sqrt(2 * n);
  const double p = std::erfc((excess - kLeastExcess) / u / std::sqrt(2.0)) / 2;
  if (excess < kLeastExcess || p > kNoiseAlarm) return std::nullopt;
  const double sd = spec * std::sqrt(excess * excess - 1), u_sd = spec * excess * u / std::sqrt(excess * excess - 1);
  NoiseFinding f{find_effect("noise.vibration"), p, {figure("sd_um", "um", sd, u_sd)}, {}};
  f.certain = other_each_time(c, r, quiet, 1 - 1 / (excess * excess));
  f.sentence = fmt::format("Touches scatter {:.1f} times as much as the probe's specification says{}.", excess,
                           alike_along_all_axes(c, r) ? ", in every direction" : ", not alike in all directions");
  return f;
}

/// More touches beyond the limit of gross outliers than normal noise puts there, by the tail of a Poisson
/// law, and far beyond it: the ends of a pattern that the search has missed are just beyond.
std::optional<NoiseFinding> outliers(const Case& c) {
  constexpr double kFar = 1.5;
  double n = 0, sum = 0, limit = 0;
  std::map<int, int> by_feature;
  for (std::size_t i = 0; i < c.masked.size(); ++i) {
    if (!c.masked[i]) continue;
    ++by_feature[c.touches.touches[i].scene.feature];
    const auto row = static_cast<Eigen::Index>(i);
    n += 1, sum += std::abs(c.off_um(row));
    limit += kOutlier * c.baseline.model.noise_um(row) * c.hyper.noise(c.baseline.model.noise_group[i]);
  }
  const double all = static_cast<double>(c.masked.size()), share = n / all,
               expected = all * std::erfc(kOutlier / std::sqrt(2.0));
  const double p = std::exp(n * std::log(expected) - std::lgamma(n + 1));
  if (n < 2 || p > kNoiseAlarm || sum < kFar * limit) return std::nullopt;
  NoiseFinding f{
      find_effect("noise.outliers"),
      p,
      {figure("share", "1", share, std::sqrt(share / all)), figure("size_um", "um", sum / n, sum / n / std::sqrt(n))},
      {}};
  // Dirt lies anywhere in the sequence. What lies so close together by chance in one recording of twenty may
  // be something that happened then.
  constexpr double kByChance = 0.05;
  const auto first = std::find(c.masked.begin(), c.masked.end(), 1) - c.masked.begin(),
             last = c.masked.rend() - std::find(c.masked.rbegin(), c.masked.rend(), 1);
  f.certain = n * std::pow(double(last - first) / all, n - 1) > kByChance;
  const auto most = std::max_element(by_feature.begin(), by_feature.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  f.factor = Factor::feature, f.where = {{"feature", c.touches.features[static_cast<std::size_t>(most->first)]}};
  f.sentence = fmt::format("{:.0f} of {} touches are outliers: dirt, burrs or early triggers.", n, c.masked.size());
  return f;
}

}  // namespace

std::vector<NoiseFinding> judge_noise(const Case& c, const SearchResult& result) {
  std::vector<std::optional<NoiseFinding>> judged{resolution(c), outliers(c)};
  // What an imperfect explanation leaves is no scatter.
  if (!result.other && result.adequacy >= kInadequate) {
    const Residuals r = residuals(c, result);
    Vector quiet = Vector::Ones(r.standardised.size());
    if (std::optional<Unequal> u = unequal(c, r)) quiet -= u->in, judged.push_back(std::move(u->finding));
    judged.push_back(vibration(c, r, quiet));
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
