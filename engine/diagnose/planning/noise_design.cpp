// Scatter of a size goes through the judgement of a recording (findings/scatter.hpp) as its squared residuals are
// expected to be; it is seen where it would be with a power of 80 %. It is named where repeats would show that it is
// other each time: without them it may be a pattern too fine for the recording.
#include "engine/diagnose/planning/noise_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "engine/diagnose/findings/noise_effects.hpp"
#include "engine/diagnose/findings/scatter.hpp"
#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/rotated.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kAtNoSize = std::numeric_limits<double>::infinity();

/// The least number above 0 at which something that stays true becomes true; kAtNoSize: nowhere up to `most`.
template <class True>
double least(double most, True holds) {
  constexpr int kHalvings = 12;
  double low = 1e-3, high = most;
  if (!holds(high)) return kAtNoSize;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

/// Sizes as excess of variance over that of the probe.
struct ScatterForm {
  double detected = kAtNoSize, named = kAtNoSize;
};

/// Of an even number the better one; by the excess from which on it is `seen`.
double median_excess(std::vector<ScatterForm> forms, double ScatterForm::*seen) {
  std::stable_sort(forms.begin(), forms.end(),
                   [&](const ScatterForm& a, const ScatterForm& b) { return a.*seen < b.*seen; });
  return forms[(forms.size() - 1) / 2].*seen;
}

class ScatterDesign {
 public:
  explicit ScatterDesign(const Case& c) : c_(c) {
    const LinearModel m = with_one_noise(c.model);  // as where scatter is judged
    Hyperparameters h = c.hyper;
    double factor = 0;
    for (const int group : c.model.noise_group) factor += c.hyper.noise(group) / double(c.model.noise_group.size());
    h.noise = Vector::Constant(1, factor);
    noise_um_ = m.noise_um.mean() * factor;
    const Matrix precision = Rotated(m, h).precision();
    own_ = precision.diagonal().cwiseMax(1e-9);
    coupling_ = squared_correlation(precision);
  }

  double noise_um() const { return noise_um_; }

  /// Of variances 1 + excess * share; `told`: what must hold of the excess that is read from the residuals, with the
  /// power.
  template <class Told>
  ScatterForm along(const Vector& share, Told told, int of_its_kind = 1) const {
    constexpr double kMost = 200;
    ScatterForm out;
    out.detected = least(kMost, [&](double excess) {
      const Excess e = expected(share, excess);
      const double z = std::sqrt(e.chi2) - kPowerDeviations;
      return z > 0 && of_its_kind * chance_of_excess(z * z) <= kNoiseAlarm && told(e.size);
    });
    out.named = std::max(out.detected, repeats_tell_from(share));
    return out;
  }

  /// Of all touches alike, over the specification of the probe.
  ScatterForm everywhere() const {
    const Vector all = Vector::Ones(static_cast<Eigen::Index>(c_.rows.size()));
    const double relative = std::sqrt(std::max(1.0, inflation(1, coupling_, all)) / (2 * double(all.size())));
    ScatterForm out;
    out.detected = least(200, [&](double excess) {
      const double read = std::sqrt(1 + excess) * (1 - kPowerDeviations * relative);
      return read > kLeastExcess && chance_of_ratio(read, relative) <= kNoiseAlarm;
    });
    out.named = std::max(out.detected, repeats_tell_from(all));
    return out;
  }

 private:
  /// Residuals as large as they are expected to be. Each is a touch less what the others predict, whose scatter is in it
  /// too.
  Excess expected(const Vector& share, double excess) const {
    const Vector variance = 1 + excess * (coupling_ * (own_.array() * share.array()).matrix()).array();
    const double tails = (3 * variance.squaredNorm() / double(variance.size()) / std::pow(variance.mean(), 2) - 1) / 2;
    return excess_along({variance.cwiseSqrt(), noise_um_, tails, coupling_}, share);
  }

  /// The excess from which on what repeats have in common by chance is little beside what is new.
  double repeats_tell_from(const Vector& share) const {
    const auto pairs = repeats_in(c_, share).size();
    if (pairs < kEnoughRepeats) return kAtNoSize;
    const double new_share = kPowerDeviations / std::sqrt(double(pairs)) / kInCommon;
    return new_share < 1 ? new_share / (1 - new_share) : kAtNoSize;
  }

  const Case& c_;
  double noise_um_ = 1;
  Vector own_;  ///< by row: inverse variance of the residual, in units of the touch's noise
  Matrix coupling_;
};

Detectable smallest(const char* effect, const char* parameter, const char* unit) {
  Detectable d;
  d.effect = effect, d.parameter = parameter, d.unit = unit, d.scatter = true;
  return d;
}

void add_vibration(const Case& c, const ScatterDesign& design, std::vector<Detectable>& out) {
  std::vector<ScatterForm> forms{design.everywhere()};
  for (int axis = 0; axis < 3; ++axis)
    if (const std::optional<Vector> share = share_along(c, axis))
      forms.push_back(design.along(*share, [](double excess) { return std::sqrt(1 + excess) >= kLeastAlong; }));
  double seen = median_excess(forms, &ScatterForm::detected);
  const double named = median_excess(forms, &ScatterForm::named);
  if (seen == kAtNoSize)  // along one axis few touches show nothing; in every direction they may
    for (const ScatterForm& form : forms) seen = std::min(seen, form.detected);
  if (seen == kAtNoSize) return;
  Detectable d = smallest("noise.vibration", "sd_um", "um");
  d.detect = d.detect_um = design.noise_um() * std::sqrt(seen);
  if (named < kAtNoSize) d.name = d.name_um = design.noise_um() * std::sqrt(named);
  out.push_back(std::move(d));
}

/// False: these touches do not part any of its groups.
bool add_unequal(const Case& c, const ScatterDesign& design, std::vector<Detectable>& out) {
  std::map<std::string_view, std::vector<ScatterForm>> of_kind;
  for (const Split& s : splits_of(c)) {
    if (!parts(s)) continue;
    const auto told = [&](double excess) {
      return std::sqrt(1 + excess) * (1 - (2 + kPowerDeviations) * relative_u(s)) >= kLeastRatio;
    };
    of_kind[s.group].push_back(design.along(s.in, told, s.of_its_kind));
  }
  if (of_kind.empty()) return false;
  std::vector<ScatterForm> forms;
  for (const auto& [kind, form] : of_kind)
    forms.push_back({median_excess(form, &ScatterForm::detected), median_excess(form, &ScatterForm::named)});
  const double seen = median_excess(forms, &ScatterForm::detected), named = median_excess(forms, &ScatterForm::named);
  if (seen == kAtNoSize) return true;
  Detectable d = smallest("noise.unequal", "ratio", "1");
  d.detect = std::sqrt(1 + seen), d.detect_um = design.noise_um() * std::sqrt(seen);
  if (named < kAtNoSize) d.name = std::sqrt(1 + named), d.name_um = design.noise_um() * std::sqrt(named);
  out.push_back(std::move(d));
  return true;
}

void add_outliers(const Case& c, const ScatterDesign& design, std::vector<Detectable>& out) {
  const double touches = double(c.masked.size()), expected = expected_outliers(c);
  double count = std::max(2.0, std::ceil(expected));
  while (count < touches && poisson_tail(count, expected) > kNoiseAlarm) ++count;
  // Of so many in the mean, that many or more are there in 80 % of recordings.
  const double mean = least(10 * count, [&](double m) { return poisson_tail(count, m) >= 0.8; });
  if (mean > touches) return;
  Detectable d = smallest("noise.outliers", "share", "1");
  d.detect = mean / touches, d.name = d.detect;
  // Of the usual size, or of that from which on they are far enough out.
  const auto& parameters = find_effect("noise.outliers")->parameters;
  const auto size =
      std::find_if(parameters.begin(), parameters.end(), [](const auto& p) { return p.name == "size_um"; });
  d.detect_um = std::max(size->typical, kFarOut * kOutlier * design.noise_um()), d.name_um = d.detect_um;
  out.push_back(std::move(d));
}

/// That all positions have a divisor is seen as soon as it counts beside the noise.
void add_resolution(const ScatterDesign& design, std::vector<Detectable>& out) {
  Detectable d = smallest("noise.resolution", "resolution_um", "um");
  d.detect_um = kLeastRounding * design.noise_um(), d.name_um = d.detect_um;
  d.detect = d.detect_um * std::sqrt(12.0), d.name = d.detect;
  out.push_back(std::move(d));
}

}  // namespace

void add_smallest_scatter(const Case& c, Diagnosis& out) {
  const ScatterDesign design(c);
  add_vibration(c, design, out.smallest_detectable);
  add_outliers(c, design, out.smallest_detectable);
  add_resolution(design, out.smallest_detectable);
  if (!add_unequal(c, design, out.smallest_detectable)) {
    const std::vector<std::string> columns{"head_A_deg", "sensor", "speed_mm_s"};
    out.cannot_judge.push_back({"noise.unequal", columns, columns});
  }
  for (const Effect* effect : effects())
    if (is_noise(*effect) && !tells_of(out, effect->name))
      out.cannot_judge.push_back({std::string(effect->name), {}, {}});
}

}  // namespace abbe::diagnose
