#include "engine/diagnose/findings/noise/scatter_design.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/rotated.hpp"

namespace abbe::diagnose {

double least(double most, const std::function<bool(double)>& holds) {
  constexpr int kHalvings = 12;
  double low = 1e-3, high = most;
  if (!holds(high)) return kAtNoSize;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

double median_excess(std::vector<ScatterForm> forms, double ScatterForm::*seen) {
  std::stable_sort(forms.begin(), forms.end(),
                   [&](const ScatterForm& a, const ScatterForm& b) { return a.*seen < b.*seen; });
  return forms[(forms.size() - 1) / 2].*seen;
}

ScatterDesign::ScatterDesign(const Case& c) : c_(c) {
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

ScatterForm ScatterDesign::along(const Vector& share, const std::function<bool(double)>& told, int of_its_kind) const {
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

ScatterForm ScatterDesign::everywhere() const {
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

/// Residuals as large as they are expected to be. Each is a touch less what the others predict, whose scatter is in it
/// too.
Excess ScatterDesign::expected(const Vector& share, double excess) const {
  const Vector variance = 1 + excess * (coupling_ * (own_.array() * share.array()).matrix()).array();
  const double tails = (3 * variance.squaredNorm() / double(variance.size()) / std::pow(variance.mean(), 2) - 1) / 2;
  return excess_along({variance.cwiseSqrt(), noise_um_, tails, coupling_}, share);
}

/// The excess from which on what repeats have in common by chance is little beside what is new.
double ScatterDesign::repeats_tell_from(const Vector& share) const {
  const auto pairs = repeats_in(c_, share).size();
  if (pairs < kEnoughRepeats) return kAtNoSize;
  const double new_share = kPowerDeviations / std::sqrt(double(pairs)) / kInCommon;
  return new_share < 1 ? new_share / (1 - new_share) : kAtNoSize;
}

Detectable smallest_of(const Effect& effect, const char* parameter, const char* unit) {
  Detectable d;
  d.effect = effect.name, d.parameter = parameter, d.unit = unit, d.scatter = true;
  return d;
}

}  // namespace abbe::diagnose
