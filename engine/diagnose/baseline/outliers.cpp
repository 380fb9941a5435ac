// Gross outliers: touches so far from what all others predict that they are dirt, burrs or early triggers.
// They are left out, or they would spoil the fit. Dirt strikes single touches by chance, though: touches next
// to each other, of one stylus or facing one way one after the other, or of one place again and again, that are all off, are a
// mismatch with a cause, and so are those that a sudden change puts where they are: they stay in. Those of one tip in one
// orientation are noise of its own.
#include "engine/diagnose/baseline/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "engine/diagnose/baseline/sudden_change.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/place.hpp"

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

/// Gross outliers out, the rest fitted again, until none is left. Those `kept` are none.
void mask(Case& c, const std::vector<char>& kept) {
  c.masked.assign(c.touches.touches.size(), 0);
  const LinearModel whole = compact(c.baseline.model);
  for (int round = 0; round < kMaskings; ++round) {
    c.model = without_rows(whole, c.masked);
    c.hyper = estimate(c.model);
    const Vector loo = leave_one_out(c.model, c.hyper);
    Eigen::Index k = 0;
    bool found = false;
    const double worst = loo.cwiseAbs().maxCoeff(), limit = kOutlier * spoilt(loo);
    for (std::size_t i = 0; i < c.masked.size(); ++i) {
      if (c.masked[i]) continue;
      // Only what is near the worst: a gross touch spoils its neighbours, which come back once it is out.
      const double size = std::abs(loo(k++));
      if (size > limit && size > worst / 2 && !kept[i]) c.masked[i] = found = true;
    }
    if (!found) break;
  }
  c.model = without_rows(whole, c.masked);
  c.hyper = estimate(c.model);
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

/// Upper tail of a Poisson law.
double at_least(int n, double expected) {
  double term = std::exp(-expected), below = 0;
  for (int k = 0; k < n; ++k) below += term, term *= expected / (k + 1);
  return std::max(0.0, 1 - below);
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
  std::vector<char> out(masked.size(), 0);
  for (const Pairs& pairs : relations) {
    int both = 0;
    for (const auto& [a, b] : pairs) both += masked[a] && masked[b] ? 1 : 0;
    if (both < kLeastPairs || at_least(both, static_cast<double>(pairs.size()) * m * (m - 1) / (n * (n - 1))) > kChance)
      continue;
    for (const auto& [a, b] : pairs)
      if (masked[a] && masked[b]) out[a] = out[b] = 1;
  }
  return out;
}

/// Upper tail of a binomial law.
double at_least_of(int n, int many, double share) {
  double sum = 0;
  for (int k = n; k <= many; ++k)
    sum += std::exp(std::lgamma(many + 1.0) - std::lgamma(k + 1.0) - std::lgamma(many - k + 1.0) + k * std::log(share) +
                    (many - k) * std::log1p(-share));
  return sum;
}

/// Dirt strikes any stylus. Where nearly all outliers are of one tip in one orientation, that one scatters more than the
/// others: it gets a noise of its own. Whether one did.
bool part_noisy_tip(Case& c) {
  constexpr int kEnough = 20;  // touches
  LinearModel& m = c.baseline.model;
  std::map<int, std::vector<std::size_t>> tips;
  for (std::size_t i = 0; i < c.masked.size(); ++i) tips[c.touches.touches[i].scene.stylus.tip_ordinal].push_back(i);
  const auto struck = static_cast<int>(std::count(c.masked.begin(), c.masked.end(), 1));
  const double all = static_cast<double>(c.masked.size());
  for (const auto& [tip, rows] : tips) {
    const double own = static_cast<double>(rows.size());
    if (own < kEnough || all - own < kEnough) continue;
    const auto here =
        static_cast<int>(std::count_if(rows.begin(), rows.end(), [&](std::size_t i) { return c.masked[i]; }));
    if (at_least_of(here, struck, own / all) * double(tips.size()) > kChance) continue;
    for (const std::size_t i : rows) m.noise_group[i] = m.noise_groups;
    ++m.noise_groups;
    c.baseline.noise_names.emplace_back(c.touches.touches[rows.front()].scene.stylus.name);
    return true;
  }
  return false;
}

}  // namespace

void mask_outliers(Case& c) {
  const std::vector<char> none(c.touches.touches.size(), 0);
  mask(c, none);
  if (part_noisy_tip(c)) mask(c, none);
  std::vector<char> kept = systematic(c.touches, c.recording->rows.data(), c.masked);
  const std::vector<char> changed = put_there_by_a_sudden_change(c);
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] |= changed[i];
  if (std::count(kept.begin(), kept.end(), 1) > 0) mask(c, kept);
  if (std::count(c.masked.begin(), c.masked.end(), 1) > 0)
    c.off_um = beyond_prediction(compact(c.baseline.model), c.hyper, c.masked);
  c.rows.clear();
  for (std::size_t i = 0; i < c.masked.size(); ++i)
    if (!c.masked[i]) c.rows.push_back(static_cast<int>(i));
}

}  // namespace abbe::diagnose
