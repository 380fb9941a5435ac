// Effects that change no mean but the scatter: judged by the likelihood of a model of the variance, on
// residuals that are each predicted from all other touches (so they are nearly independent, with a variance
// of 1 when the noise is what was fitted).
#include "engine/diagnose/findings/noise/judge_noise.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/diagnose/baseline/outliers.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"

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

/// Scatter in which neighbours are alike goes on from touch to touch: it is something that has not been found.
void doubt_what_goes_on(double correlation, NoiseFinding& f) {
  constexpr double kAlike = 0.4;
  if (correlation < kAlike) return;
  f.certain = false;
  f.sentence +=
      fmt::format(" But neighbouring touches scatter alike (correlated by {:.2f}): that goes on.", correlation);
}

}  // namespace

std::vector<NoiseFinding> judge_noise(const Case& c, const SearchResult& result) {
  Scatter scatter{c, result, {}, {}};
  const bool explained = !result.other && result.adequacy >= kInadequate;
  if (explained) {
    scatter.residuals = residuals(c, result);
    scatter.quiet = Vector::Ones(scatter.residuals.standardised.size());
  }
  std::vector<NoiseFinding> out;
  for (const NoiseProperty* property : noise_properties()) {
    if (property->of_scatter && !explained) continue;
    std::optional<NoiseFinding> found = property->judge(scatter);
    if (!found) continue;
    if (property->of_scatter) doubt_what_goes_on(result.hyper.correlation, *found);
    out.push_back(std::move(*found));
  }
  constexpr double kLeastP = 1e-12;  // further out the laws of the tails are not known so well
  for (NoiseFinding& f : out) f.p = std::clamp(kLooks * f.p, kLeastP, 1.0);
  std::stable_sort(out.begin(), out.end(), [](const NoiseFinding& a, const NoiseFinding& b) { return a.p < b.p; });
  return out;
}

namespace {

/// Touches of a group have a noise of their own.
void part_noise(const TouchGroup& group, LinearModel& m, auto&& touch_of_row) {
  for (std::size_t k = 0; k < m.noise_group.size(); ++k)
    if (group.in(touch_of_row(k)) == 1) m.noise_group[k] = m.noise_groups;
  ++m.noise_groups;
  for (std::size_t k = 1; k < m.follows.size(); ++k) m.follows[k] &= m.noise_group[k] == m.noise_group[k - 1];
}

/// How much likelier the recording is, without any explanation, where these touches have a noise of their own: nats.
double gain_of_own_noise(const TouchGroup& group, const Case& c) {
  const auto log_likelihood = [](const LinearModel& m) {
    return EvidenceSearch(m, estimate(m), {}).evidence().log_null;
  };
  LinearModel parted = c.model;
  part_noise(group, parted, [&](std::size_t k) { return static_cast<Eigen::Index>(c.rows[k]); });
  return log_likelihood(parted) - log_likelihood(c.model);
}

/// What repeats alike is none.
std::optional<NoisyGroup> noisiest_unlike(const Case& c) {
  const Residuals r = residuals(c, {});
  std::optional<NoisyGroup> noisy = noisiest(c, r);
  if (!noisy) return noisy;
  const double share = noisy->excess.size / (1 + noisy->excess.size);
  return repeats_of(c, r, among_rows(c, noisy->group.in), share) == Repeats::agree ? std::nullopt : std::move(noisy);
}

}  // namespace

std::optional<NoisyGroup> noisy_touches(const Case& c) {
  const std::optional<TouchGroup> struck = struck_most(c);
  if (struck) {
    Case with_all = c;
    part(*struck, with_all);
    std::optional<NoisyGroup> noisy = noisiest_unlike(with_all);
    if (noisy && noisy->group.in == struck->in) return noisy;
  }
  return noisiest_unlike(c);
}

bool explains_more(const NoisyGroup& noisy, const Case& c, const Evidence& first) {
  std::map<int, std::set<bool>> of_noise;  // by group of the noise: of touches in `noisy`, and of others
  for (std::size_t i = 0; i < c.touches.touches.size(); ++i)
    of_noise[c.baseline.model.noise_group[i]].insert(noisy.group.in(static_cast<Eigen::Index>(i)) == 1);
  const bool parted = std::all_of(of_noise.begin(), of_noise.end(), [](const auto& g) { return g.second.size() == 1; });
  return !parted && gain_of_own_noise(noisy.group, c) - std::log(noisy.group.of_its_kind) > first.statistic;
}

void part(const TouchGroup& group, Case& c) {
  part_noise(group, c.baseline.model, [](std::size_t touch) { return static_cast<Eigen::Index>(touch); });
  c.baseline.noise_names.push_back(group.touches);
  mask_outliers(c);
}

}  // namespace abbe::diagnose
