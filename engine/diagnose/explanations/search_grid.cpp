#include "engine/diagnose/explanations/search_grid.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/effects/direction.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kMoments = 32, kPlaces = 9;

double duration(const RecordedTouches& t) {
  return std::max(1.0, t.touches.back().scene.time_s - t.touches.front().scene.time_s);
}

/// Moments between touches, evenly over the sequence: a step cannot be placed better than between two touches.
std::vector<double> moments(const RecordedTouches& t) {
  std::vector<double> list;
  const int n = static_cast<int>(t.touches.size());
  const int count = std::min(kMoments, n - 1);
  for (int k = 1; k <= count; ++k) {
    const int i = std::clamp(static_cast<int>(std::lround(double(k) * n / (count + 1))), 1, n - 1);
    list.push_back((t.touches[i - 1].scene.time_s + t.touches[i].scene.time_s) / 2);
  }
  return list;
}

/// Equally spaced frequencies from half a cycle up: the spectral resolution is one cycle per recording.
/// None shorter than the effect has them: what repeats after a few touches would fit one of those.
std::vector<double> periods(const EffectParameter& p, const RecordedTouches& t) {
  std::vector<double> list;
  const double shortest = std::max(p.low, quickest_of_a_room_s(duration(t)));
  for (int k = 1; duration(t) / (0.5 * k) >= shortest; ++k) list.push_back(duration(t) / (0.5 * k));
  return list;
}

std::vector<double> time_constants(const RecordedTouches& t) {
  std::vector<double> list;
  for (const double share : {0.05, 0.15, 0.5, 1.5}) list.push_back(share * duration(t));
  return list;
}

std::vector<double> places(const RecordedTouches& t) {
  std::set<double> readings;
  for (const RecordedTouch& touch : t.touches)
    for (int k = 0; k < 3; ++k) readings.insert(std::round(touch.scene.reading[k] / 10) * 10);
  std::vector<double> all(readings.begin(), readings.end()), list;
  for (int k = 1; k <= 3 * kPlaces; ++k)
    list.push_back(all[std::min(all.size() - 1, k * all.size() / (3 * kPlaces + 1))] + 5);
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

/// Ordinals of what there may be several of; 0 stands for all of them.
std::vector<double> ordinals(std::size_t count) {
  std::vector<double> list{0};
  for (std::size_t k = 1; count > 1 && k <= count; ++k) list.push_back(double(k));
  return list;
}

/// The placements of the part, if there are several; 0 stands for all of them.
std::vector<double> setups(const RecordedTouches& t) {
  std::set<double> list{0};
  for (const RecordedTouch& touch : t.touches) list.insert(touch.scene.setup);
  return list.size() > 2 ? std::vector<double>(list.begin(), list.end()) : std::vector<double>{0};
}

std::vector<double> codes(const EffectParameter& p) {
  std::vector<double> list;
  for (double v = p.low; v <= p.high; ++v) list.push_back(v);
  return list;
}

std::vector<double> listed(const EffectParameter& p) { return {p.tried.begin(), p.tried.end()}; }

/// One at least. Less than half a wave is a size, or an angle of the part.
std::vector<double> wavelengths(const EffectParameter& p, const RecordedTouches& t) {
  Vec3 low = t.touches.front().scene.on_part, high = low;
  for (const RecordedTouch& touch : t.touches)
    for (int k = 0; k < 3; ++k)
      low[k] = std::min(low[k], touch.scene.on_part[k]), high[k] = std::max(high[k], touch.scene.on_part[k]);
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  std::vector<double> list{p.tried.front()};
  for (const double length : p.tried.subspan(1))
    if (length <= 2 * extent) list.push_back(length);
  return list;
}

}  // namespace

double quickest_of_a_room_s(double duration_s) {
  constexpr double kUsually_s = 600, kCycles = 14, kOfARoom_s = 120;
  return std::max(kOfARoom_s, std::min(kUsually_s, duration_s / kCycles));
}

Search search_of(const EffectParameter& p, const RecordedTouches& t) {
  using Kind = Search::Kind;
  switch (p.sought) {
    case Sought::listed:
    case Sought::signal_period: return {Kind::tried, listed(p)};
    case Sought::around_listed: return {Kind::tried, listed(p), true};
    case Sought::wavelength: return {Kind::tried, wavelengths(p, t), true};
    case Sought::moment: return {Kind::tried, moments(t), true};
    case Sought::period: return {Kind::tried, periods(p, t), true};
    case Sought::time_constant: return {Kind::tried, time_constants(t), true};
    case Sought::reading: return {Kind::tried, places(t), true};
    case Sought::phase: return {Kind::phase, {0, 90}};
    case Sought::direction: return {Kind::direction, {0, 1, 2}};
    case Sought::stylus: return {Kind::tried, ordinals(t.styli.size())};
    case Sought::setup: return {Kind::tried, setups(t)};
    case Sought::tip: return {Kind::tried, ordinals(t.tips > int(t.styli.size()) ? std::size_t(t.tips) : 0)};
    case Sought::not_at_all: break;
  }
  if (!p.choices.empty()) return {Kind::tried, codes(p)};
  return {Kind::fixed, {p.standard != 0 ? p.standard : std::clamp(0.0, p.low, std::max(p.low, p.high))}};
}

std::vector<Cell> cells_of(const Search& search) {
  std::vector<Cell> cells;
  if (!search.between || search.values.size() < 2) {
    for (const double v : search.values) cells.push_back({v, v});
    return cells;
  }
  std::vector<double> sorted = search.values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t last = sorted.size() - 1;
  const auto half_above = [&](std::size_t k) { return (sorted[k + 1] - sorted[k]) / 2; };
  for (const double v : search.values) {
    const auto k = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), v) - sorted.begin());
    const double below = k > 0 ? half_above(k - 1) : half_above(0),
                 above = k < last ? half_above(k) : half_above(last - 1);
    cells.push_back({v - below, v + above});
  }
  return cells;
}

}  // namespace abbe::diagnose
