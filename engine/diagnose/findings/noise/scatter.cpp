#include "engine/diagnose/findings/noise/scatter.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/diagnose/place.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

// The gain of independent normal residuals has half a chi-squared law; that of others is larger by the variance of the
// score, sum of share times square, over what it would be for those.
Excess excess_along(const Residuals& r, const Vector& share) {
  const Vector square = r.standardised.array().square(), centred = share.array() - share.mean();
  const double inflated = inflation(r.tails, r.coupling, centred);
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
  out.chi2 = 2 * best / std::max(1.0, inflated);
  return out;
}

std::optional<Vector> share_along(const Case& c, int axis) {
  Vector along(static_cast<Eigen::Index>(c.rows.size()));
  for (Eigen::Index k = 0; k < along.size(); ++k) along(k) = std::pow(c.scene(k).normal[axis], 2);
  if ((along.array() - along.mean()).square().sum() < 1) return std::nullopt;
  return along;
}

double inflation(double tails, const Matrix& coupling, const Vector& rows) {
  return tails - 1 + rows.dot(coupling * rows) / rows.squaredNorm();
}

double chance_of_excess(double chi2) { return normal_below(-std::sqrt(std::max(0.0, chi2))); }

double chance_of_ratio(double ratio, double relative_u) {
  const double spread = 4.0 / 9 * relative_u * relative_u;  // of the cube root; 2 / (9 nu), where nu = 1 / (2 u^2)
  const double z = (std::pow(ratio / kLeastExcess, 2.0 / 3) - (1 - spread)) / std::sqrt(spread);
  return normal_below(-z);
}

std::vector<std::pair<Eigen::Index, Eigen::Index>> repeats_in(const Case& c, const Vector& in) {
  std::map<Place, Eigen::Index> first;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> out;
  for (Eigen::Index k = 0; k < in.size(); ++k) {
    if (in(k) < 0.5) continue;
    const auto [at, is_first] = first.try_emplace(place_of(c.scene(k)), k);
    if (!is_first) out.emplace_back(at->second, k);
  }
  return out;
}

}  // namespace abbe::diagnose
