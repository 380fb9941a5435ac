#include "engine/diagnose/findings/scatter.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/diagnose/place.hpp"
#include "engine/effects/noise/noise.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

const TouchScene& scene_of_row(const Case& c, Eigen::Index row) {
  return c.touches.touches[c.rows[static_cast<std::size_t>(row)]].scene;
}

}  // namespace

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

double inflation(double tails, const Matrix& coupling, const Vector& rows) {
  return tails - 1 + rows.dot(coupling * rows) / rows.squaredNorm();
}

double chance_of_excess(double chi2) { return normal_below(-std::sqrt(std::max(0.0, chi2))); }

double chance_of_ratio(double ratio, double relative_u) {
  const double spread = 4.0 / 9 * relative_u * relative_u;  // of the cube root; 2 / (9 nu), where nu = 1 / (2 u^2)
  const double z = (std::pow(ratio / kLeastExcess, 2.0 / 3) - (1 - spread)) / std::sqrt(spread);
  return normal_below(-z);
}

namespace {

DiagnosedParameter limit(const char* name, const char* unit, double value) {
  return {.name = name, .unit = unit, .value = value, .low = value, .high = value};
}

/// One orientation of the head against all others; none where that is a group already.
std::vector<Split> orientations(const Case& c, const std::vector<Split>& others) {
  std::vector<Split> out;
  for (Eigen::Index first = 0; first < static_cast<Eigen::Index>(c.rows.size()); ++first) {
    if (std::any_of(out.begin(), out.end(), [&](const Split& s) { return s.in(first) == 1; })) continue;
    const StylusScene& head = scene_of_row(c, first).stylus;
    Vector in(static_cast<Eigen::Index>(c.rows.size()));
    for (Eigen::Index k = 0; k < in.size(); ++k)
      in(k) = same_orientation(scene_of_row(c, k).stylus, head.head_a_rad, head.head_b_rad);
    const double a = in_degrees(head.head_a_rad), b = in_degrees(head.head_b_rad);
    const std::string orientation = fmt::format("A {:.1f} B {:.1f}", a, b);
    out.push_back({"one orientation",
                   "touches with the head at " + orientation,
                   {"head", orientation},
                   Factor::head,
                   std::move(in),
                   {limit("head_a_deg", "deg", a), limit("head_b_deg", "deg", b)}});
  }
  const auto known = [&](const Split& s) {
    return !parts(s) || std::any_of(others.begin(), others.end(), [&](const Split& other) { return other.in == s.in; });
  };
  out.erase(std::remove_if(out.begin(), out.end(), known), out.end());
  for (Split& s : out) s.of_its_kind = static_cast<int>(out.size());
  return out;
}

}  // namespace

std::vector<Split> splits_of(const Case& c) {
  const auto rows = static_cast<Eigen::Index>(c.rows.size());
  Vector length(rows), speed(rows), tilt(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const TouchScene& s = scene_of_row(c, k);
    length(k) = s.stylus.length_mm, speed(k) = s.speed_mm_s, tilt(k) = std::abs(s.stylus.head_a_rad);
  }
  const double long_mm = (length.minCoeff() + length.maxCoeff()) / 2 + 1,
               fast_mm_s = (speed.minCoeff() + speed.maxCoeff()) / 2 + 1e-6;
  const auto above = [](const Vector& v, double least) { return Vector((v.array() > least).cast<double>()); };
  const auto group = [](const char* name, Factor factor, Vector in, std::vector<DiagnosedParameter> which) {
    return Split{name, fmt::format("touches with {}", name), {"group", name}, factor, std::move(in), std::move(which)};
  };
  std::vector<Split> out{
      group("long styli", Factor::sensor, above(length, long_mm), {limit("longer_than_mm", "mm", long_mm)}),
      group("tilted head", Factor::head, above(tilt, kUpright_rad), {}),
      group("fast probing", Factor::speed, above(speed, fast_mm_s), {limit("faster_than_mm_s", "mm/s", fast_mm_s)})};
  for (Split& s : orientations(c, out)) out.push_back(std::move(s));
  return out;
}

double relative_u(const Split& s) {
  const double in = s.in.sum(), out = double(s.in.size()) - in;
  return std::sqrt(1 / (2 * in) + 1 / (2 * out));
}

std::optional<Vector> share_along(const Case& c, int axis) {
  Vector along(static_cast<Eigen::Index>(c.rows.size()));
  for (Eigen::Index k = 0; k < along.size(); ++k) along(k) = std::pow(scene_of_row(c, k).normal[axis], 2);
  if ((along.array() - along.mean()).square().sum() < 1) return std::nullopt;
  return along;
}

std::vector<std::pair<Eigen::Index, Eigen::Index>> repeats_in(const Case& c, const Vector& in) {
  std::map<Place, Eigen::Index> first;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> out;
  for (Eigen::Index k = 0; k < in.size(); ++k) {
    if (in(k) < 0.5) continue;
    const auto [at, is_first] = first.try_emplace(place_of(scene_of_row(c, k)), k);
    if (!is_first) out.emplace_back(at->second, k);
  }
  return out;
}

}  // namespace abbe::diagnose
