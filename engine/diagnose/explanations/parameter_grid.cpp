#include "engine/diagnose/explanations/parameter_grid.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace abbe::diagnose {

namespace {

constexpr int kMoments = 32, kPlaces = 9;

/// From the first touch to the last.
ParameterGrid moments(const RecordedTouches& t) {
  std::vector<double> times;
  for (const RecordedTouch& touch : t.touches)
    if (times.empty() || touch.scene.time_s > times.back()) times.push_back(touch.scene.time_s);
  return {.kind = ParameterGrid::Kind::tried, .tried = moments_between(times, kMoments), .between = true};
}

/// Equally spaced frequencies from half a cycle up: the spectral resolution is one cycle per recording.
/// None shorter than the effect has them: what repeats after a few touches would fit one of those.
std::vector<double> periods(const EffectParameter& p, const RecordedTouches& t) {
  std::vector<double> list;
  const double shortest = std::max(p.low, quickest_of_a_room_s(lasts_s(t)));
  for (int k = 1; lasts_s(t) / (0.5 * k) >= shortest; ++k) list.push_back(lasts_s(t) / (0.5 * k));
  return list;
}

std::vector<double> time_constants(const RecordedTouches& t) {
  std::vector<double> list;
  for (const double share : {0.05, 0.15, 0.5, 1.5}) list.push_back(share * lasts_s(t));
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

/// The probing speeds, if there are several but no more than a few; 0 stands for none.
std::vector<double> qualified_at(const RecordedTouches& t) {
  constexpr std::size_t kFew = 5;
  std::vector<double> list = speeds_in(t);
  if (list.size() < 2 || list.size() > kFew) list.clear();
  list.insert(list.begin(), 0);
  return list;
}

std::vector<double> codes(const EffectParameter& p) {
  std::vector<double> list;
  for (double v = p.low; v <= p.high; ++v) list.push_back(v);
  return list;
}

std::vector<double> listed(const EffectParameter& p) { return {p.tried.begin(), p.tried.end()}; }

/// The sides of what was touched, along the axes of the part.
Vec3 sides_mm(const RecordedTouches& t) {
  Vec3 low = t.touches.front().scene.on_part, high = low;
  for (const RecordedTouch& touch : t.touches)
    for (int k = 0; k < 3; ++k)
      low[k] = std::min(low[k], touch.scene.on_part[k]), high[k] = std::max(high[k], touch.scene.on_part[k]);
  return high - low;
}

/// Shares of the height that touches span, of a part that may be three times as high. Of a gauge, which is far longer than
/// high, the middle alone: elsewhere a bow would be no more than a length that is wrong.
std::vector<double> heights(const RecordedTouches& t) {
  constexpr double kSlender = 0.05;
  const Vec3 sides = sides_mm(t);
  if (sides.z < kSlender * std::max(sides.x, sides.y)) return {0};
  std::vector<double> list;
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) list.push_back(share * sides.z);
  return list;
}

/// One at least. Less than half a wave is a size, or an angle of the part.
std::vector<double> wavelengths(const EffectParameter& p, const RecordedTouches& t) {
  const Vec3 sides = sides_mm(t);
  const double extent = std::max({sides.x, sides.y, sides.z});
  std::vector<double> list{p.tried.front()};
  for (const double length : p.tried.subspan(1))
    if (length <= 2 * extent) list.push_back(length);
  return list;
}

ParameterGrid each_for_itself(const std::vector<double>& values) {
  ParameterGrid out{.kind = ParameterGrid::Kind::tried};
  for (const double v : values) out.tried.push_back({v, {v, v}, 1 / double(values.size())});
  return out;
}

/// Each stands for those up to halfway to its neighbours, and as far beyond the ends; one alone for itself.
ParameterGrid with_those_between(const std::vector<double>& values) {
  ParameterGrid out = each_for_itself(values);
  out.between = true;
  if (values.size() < 2) return out;
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t last = sorted.size() - 1;
  const auto half_above = [&](std::size_t k) { return (sorted[k + 1] - sorted[k]) / 2; };
  for (TriedValue& v : out.tried) {
    const auto k = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), v.value) - sorted.begin());
    const double below = k > 0 ? half_above(k - 1) : half_above(0),
                 above = k < last ? half_above(k) : half_above(last - 1);
    v.cell = {v.value - below, v.value + above};
  }
  return out;
}

}  // namespace

std::vector<Variant> with_each(const std::vector<Variant>& variants, const std::vector<TriedValue>& values) {
  std::vector<Variant> out;
  for (const Variant& variant : variants) {
    for (const TriedValue& at : values) {
      Variant& longer = out.emplace_back(variant);
      longer.theta.push_back(at.value);
      longer.cells.push_back(at.cell);
      longer.weight *= at.share;
    }
  }
  return out;
}

double quickest_of_a_room_s(double duration_s) {
  constexpr double kUsually_s = 600, kOfARoom_s = 120, kFewCycles = 14, kManyCycles = 500;
  return std::max({kOfARoom_s, std::min(kUsually_s, duration_s / kFewCycles), duration_s / kManyCycles});
}

std::vector<double> speeds_in(const RecordedTouches& t) {
  constexpr double kAlike = 1.15;
  std::vector<double> all, list;
  for (const RecordedTouch& touch : t.touches) all.push_back(touch.scene.speed_mm_s);
  std::sort(all.begin(), all.end());
  for (auto first = all.begin(), last = first; first != all.end(); first = last) {
    last = std::find_if(first, all.end(), [&](double speed) { return speed > kAlike * *first; });
    list.push_back(*(first + (last - first) / 2));
  }
  return list;
}

std::vector<TriedValue> moments_between(const std::vector<double>& ends_s, std::size_t parts) {
  const std::size_t gaps = ends_s.empty() ? 0 : ends_s.size() - 1, count = std::min(parts, gaps);
  std::vector<TriedValue> list;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = k * gaps / count, last = (k + 1) * gaps / count, middle = (first + last - 1) / 2;
    list.push_back({(ends_s[middle] + ends_s[middle + 1]) / 2,
                    {ends_s[first], ends_s[last]},
                    double(last - first) / double(gaps)});
  }
  return list;
}

ParameterGrid grid_of(const EffectParameter& p, const RecordedTouches& t, double least_period_um) {
  const bool needless = (p.unless_logged & t.varying) != 0;
  switch (needless ? Sought::not_at_all : p.sought) {
    case Sought::listed: return each_for_itself(listed(p));
    case Sought::signal_period: {
      std::vector<double> periods_um = listed(p);
      std::erase_if(periods_um, [&](double period_um) { return period_um < least_period_um; });
      return each_for_itself(periods_um);
    }
    case Sought::around_listed: return with_those_between(listed(p));
    case Sought::wavelength: return with_those_between(wavelengths(p, t));
    case Sought::height: return with_those_between(heights(t));
    case Sought::moment: return moments(t);
    case Sought::period: return with_those_between(periods(p, t));
    case Sought::time_constant: return with_those_between(time_constants(t));
    case Sought::reading: return with_those_between(places(t));
    case Sought::phase: return {.kind = ParameterGrid::Kind::phase};
    case Sought::direction: return {.kind = ParameterGrid::Kind::direction};
    case Sought::stylus: return each_for_itself(ordinals(t.styli.size()));
    case Sought::setup: return each_for_itself(setups(t));
    case Sought::speed: return each_for_itself(qualified_at(t));
    case Sought::tip: return each_for_itself(ordinals(t.tips > int(t.styli.size()) ? std::size_t(t.tips) : 0));
    case Sought::not_at_all: break;
  }
  if (!p.choices.empty()) return each_for_itself(codes(p));
  return {.fixed = p.standard != 0 ? p.standard : std::clamp(0.0, p.low, std::max(p.low, p.high))};
}

}  // namespace abbe::diagnose
