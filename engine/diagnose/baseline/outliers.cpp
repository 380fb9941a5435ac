// Gross outliers: touches so far from what all others predict that they are dirt, burrs or early triggers.
// They are left out, or they would spoil the fit. Dirt strikes single touches by chance, though: touches next
// to each other, of one stylus or facing one way one after the other, of one place again and again, or all of one feature, that
// are off, are a mismatch with a cause, and so are those that a sudden change puts where they are: they stay in.
#include "engine/diagnose/baseline/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/diagnose/baseline/sudden_change.hpp"
#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/model/prediction.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/diagnose/place.hpp"
#include "engine/diagnose/quantile.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kMaskings = 8;
/// Probability of so many pairs of neighbours among touches struck by chance, below which they are no chance.
/// One pair may be one piece of dirt.
constexpr double kChance = 0.005;
constexpr int kLeastPairs = 2;

/// By how much the middle half of the residuals scatters less than the fit says, where gross outliers have
/// spoilt the fit; 1 otherwise. Tails of the kind that sensors have do not spoil it so much.
double spoilt(const Vector& standardised) {
  constexpr double kNormal = 1.4826, kTails = 2;
  std::vector<double> size;
  for (const double r : standardised) size.push_back(std::abs(r));
  return std::min(1.0, kTails * kNormal * median(std::move(size)));
}

/// Gross outliers among these touches out, the rest fitted again, until none is left.
void mask(Case& c, const std::vector<char>& candidates) {
  c.masked.assign(candidates.size(), 0);
  const LinearModel whole = compact(c.baseline.model);
  bool found = true;
  for (int round = 0; found; ++round) {
    take_part(c, whole);
    c.hyper = estimate(c.model);
    if (round == kMaskings) return;
    const Vector loo = leave_one_out(c.model, c.hyper);
    const double limit = kOutlier * spoilt(loo);
    std::vector<std::pair<double, std::size_t>> gross;
    double worst = 0;
    for (Eigen::Index k = 0; k < loo.size(); ++k) {
      const auto i = static_cast<std::size_t>(c.rows[k]);
      const double size = std::abs(loo(k));
      if (!candidates[i] || size <= limit) continue;
      gross.emplace_back(size, i);
      worst = std::max(worst, size);
    }
    // Only what is near the worst: a gross touch spoils its neighbours, which come back once it is out.
    for (const auto& [size, i] : gross)
      if (size > worst / 2) c.masked[i] = 1;
    found = !gross.empty();
  }
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Touches that follow each other among those with the same key.
template <class Key>
Pairs followers(const RecordedTouches& t, Key key) {
  std::map<decltype(key(t.touches[0])), std::size_t> last;
  Pairs out;
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const auto [at, first] = last.try_emplace(key(t.touches[i]), i);
    if (!first) out.emplace_back(at->second, i), at->second = i;
  }
  return out;
}

/// The probability that of n things that each come so with this share, `count` or more do.
double binomial_tail(int n, double share, int count) {
  if (share >= 1) return 1;
  double term = std::exp(std::lgamma(n + 1.0) - std::lgamma(count + 1.0) - std::lgamma(n - count + 1.0)) *
      std::pow(share, count) * std::pow(1 - share, n - count);
  double sum = 0;
  for (int k = count; k <= n; ++k) {
    sum += term;
    term *= double(n - k) / (k + 1) * share / (1 - share);
  }
  return sum;
}

/// Outliers of a feature that has more of them than chance gives to any: it does not lie where it is said to.
std::vector<char> of_one_feature(const RecordedTouches& t, const std::vector<char>& masked) {
  std::map<int, int> touches, outliers;
  int all = 0;
  for (std::size_t i = 0; i < masked.size(); ++i) {
    const int feature = t.touches[i].scene.feature;
    ++touches[feature], outliers[feature] += masked[i], all += masked[i];
  }
  std::vector<char> out(masked.size(), 0);
  for (const auto& [feature, count] : outliers) {
    if (count <= kLeastPairs) continue;
    double chance = 0;  // that any feature has so many
    for (const auto& [other, n] : touches) chance += binomial_tail(all, double(n) / double(masked.size()), count);
    if (chance > kChance) continue;
    for (std::size_t i = 0; i < masked.size(); ++i) out[i] |= masked[i] && t.touches[i].scene.feature == feature;
  }
  return out;
}

/// Outliers that are no chance: in more pairs of neighbours than chance makes.
std::vector<char> systematic(const RecordedTouches& t, const RecordingRow* rows, const std::vector<char>& masked) {
  const auto place_on_part = [&](const RecordedTouch& touch) {
    return std::tuple(touch.scene.feature, rows[touch.row].touch);
  };
  // A shift along one axis shows in every touch of that axis, with touches of others in between.
  const auto facing = [](const RecordedTouch& touch) {
    const Vec3& n = touch.scene.normal;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
    return std::tuple(touch.scene.run, touch.scene.setup, axis, n[axis] > 0);
  };
  const Pairs in_sequence =
                  followers(t, [](const RecordedTouch&touch) { return std::pair(touch.scene.run, touch.scene.setup); }),
              of_place = followers(t, place_on_part);
  // A part that bends between two runs: neighbours, and the same ones in both.
  Pairs either = in_sequence;
  either.insert(either.end(), of_place.begin(), of_place.end());
  const Pairs relations[] = {in_sequence,
                             followers(t, [](const RecordedTouch& touch) { return touch.scene.stylus.ordinal; }),
                             followers(t, facing),
                             of_place,
                             followers(t, [](const RecordedTouch& touch) { return place_of(touch.scene); }),
                             either};
  const double n = static_cast<double>(masked.size()),
               m = static_cast<double>(std::count(masked.begin(), masked.end(), 1));
  std::vector<char> out = of_one_feature(t, masked);
  for (const Pairs& pairs : relations) {
    int both = 0;
    for (const auto& [a, b] : pairs) both += masked[a] && masked[b] ? 1 : 0;
    if (both < kLeastPairs ||
        poisson_tail(both, static_cast<double>(pairs.size()) * m * (m - 1) / (n * (n - 1))) > kChance)
      continue;
    for (const auto& [a, b] : pairs)
      if (masked[a] && masked[b]) out[a] = out[b] = 1;
  }
  return out;
}

}  // namespace

void take_part(Case& c, const LinearModel& all) {
  const std::vector<char> is_alone = alone(without_rows(all, c.masked));  // of those that are not masked
  const bool judged = std::count(is_alone.begin(), is_alone.end(), 0) > 0;
  std::vector<char> left_out = c.masked;
  c.rows.clear();
  auto next = is_alone.begin();
  for (std::size_t i = 0; i < c.masked.size(); ++i) {
    if (!c.masked[i]) left_out[i] = *next++ && judged;
    if (!left_out[i]) c.rows.push_back(static_cast<int>(i));
  }
  c.model = without_rows(all, left_out);
}

void mask_outliers(Case& c) {
  const std::vector<char> all(c.touches.touches.size(), 1);
  mask(c, all);
  const std::vector<char> related = systematic(c.touches, c.recording->rows.data(), c.masked),
                          changed = put_there_by_a_sudden_change(c);
  // What is kept spoils its neighbours: nothing is dirt beside it that was none before.
  std::vector<char> dirt = c.masked;
  for (std::size_t i = 0; i < dirt.size(); ++i)
    if (related[i] || changed[i]) dirt[i] = 0;
  if (dirt != c.masked) mask(c, dirt);
  if (std::count(c.masked.begin(), c.masked.end(), 1) > 0)
    c.off_um = beyond_prediction(compact(c.baseline.model), c.hyper, c.masked);
}

}  // namespace abbe::diagnose
