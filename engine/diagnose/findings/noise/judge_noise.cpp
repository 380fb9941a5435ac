// Effects that change no mean but the scatter: judged by the likelihood of a model of the variance, on
// residuals that are each predicted from all other touches (so they are nearly independent, with a variance
// of 1 when the noise is what was fitted).
#include "engine/diagnose/findings/noise/judge_noise.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "engine/diagnose/explanations/catalogue.hpp"
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

}  // namespace abbe::diagnose
