#include "engine/diagnose/explanations/patterns/touch_factors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace abbe::diagnose::patterns {

namespace {

/// Cosine of the angle between an approach and the surface's normal beyond which the two differ: 1.8 degrees.
constexpr double kStraight = 0.9995;
constexpr double kLever_mm = 100;

/// From 0 to 1 along the longest extent, the others in proportion.
void onto_unit(Points& points) {
  std::vector<double> low(points.front()), high(points.front());
  for (const auto& p : points)
    for (std::size_t k = 0; k < p.size(); ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  double extent = 1e-9;
  for (std::size_t k = 0; k < low.size(); ++k) extent = std::max(extent, high[k] - low[k]);
  for (auto& p : points)
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = (p[k] - low[k]) / extent;
}

bool same_visit(const TouchScene& a, const TouchScene& b) {
  return a.run == b.run && a.setup == b.setup && a.visit == b.visit;
}

/// The number of a key, in the order of their first use.
template <class Key>
int ordinal(std::map<Key, int>& known, const Key& key) {
  return known.emplace(key, static_cast<int>(known.size())).first->second;
}

/// Whether the places, of an extent of 1, follow from the normals: a linear function of them, as on a ball.
bool on_one_round(const Points& place, const Directions& normal) {
  constexpr double kFollows = 0.02;
  const Matrix by_normal = linear(as_points(normal)), at = linear(place).rightCols(3);
  const Matrix left = at - by_normal * least_squares(by_normal, at);
  return left.squaredNorm() < kFollows * kFollows * double(at.rows());
}

/// Groups by the order of their first use. Of more than a pattern may have columns for, those that follow one
/// another are taken together.
void in_few(std::vector<int>& group) {
  constexpr int kMostGroups = 32;
  std::map<int, int> known;
  std::vector<int> order;
  for (const int g : group) order.push_back(ordinal(known, g));
  const auto count = static_cast<int>(known.size());
  if (count <= kMostGroups) return;
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = order[i] * kMostGroups / count;
}

/// Levels of a measured quantity above zero, numbered from the lowest. Values that differ by less than a twentieth
/// are one level, as of one command; of many levels, neighbours are taken together.
std::vector<int> levels_of(const std::vector<double>& value) {
  constexpr double kOneLevel = 1.05;
  constexpr int kMostLevels = 8;
  std::map<double, int> level;
  for (const double v : value) level.emplace(v, 0);
  double lowest = level.begin()->first;
  int count = 0;
  for (auto& [v, k] : level) {
    if (v > kOneLevel * lowest) lowest = v, ++count;
    k = count;
  }
  ++count;
  std::vector<int> out;
  for (const double v : value) out.push_back(count > kMostLevels ? level[v] * kMostLevels / count : level[v]);
  return out;
}

/// Between features, where no touch was left out.
void find_ways(const RecordedTouches& t, const std::vector<int>& rows, TouchFactors& out) {
  out.arriving.resize(rows.size()), out.leaving.resize(rows.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const TouchScene &from = t.touches[rows[i - 1]].scene, &to = t.touches[rows[i]].scene;
    const Vec3 way = to.point - from.point;
    if (rows[i - 1] + 1 == rows[i] && from.run == to.run && from.setup == to.setup && from.feature != to.feature &&
        norm(way) > 0)
      out.leaving[i - 1] = out.arriving[i] = way / norm(way);
  }
}

}  // namespace

TouchFactors::TouchFactors(const RecordedTouches& t, const std::vector<int>& rows)
    : part_above_20(static_cast<Eigen::Index>(rows.size())) {
  std::map<std::pair<double, double>, int> orientations;
  std::map<std::pair<int, int>, int> dynamics_used;
  std::vector<double> accelerations;
  std::map<std::array<int, 3>, double> begun;
  for (Vector& v : scale_above_20) v.resize(part_above_20.size());
  const double first_s = t.touches.front().scene.time_s;
  timed = (t.known & static_cast<unsigned>(Covariate::time)) != 0;
  duration_s = lasts_s(t);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TouchScene& s = t.touches[rows[i]].scene;
    const auto on_probe = [&](const Vec3& v) { return transpose(s.stylus.R_WR) * v; };
    time.push_back({(s.time_s - first_s) / duration_s});
    touch.push_back({double(i)});
    settled.push_back({s.time_s - begun.emplace(std::array{s.run, s.setup, s.visit}, s.time_s).first->second});
    clamped.push_back({s.time_s - begun.emplace(std::array{s.run, s.setup, -1}, s.time_s).first->second});
    for (int k = 0; k < 3; ++k) reading[k].push_back({s.reading[k]});
    place.push_back({s.point.x, s.point.y, s.point.z});
    normal.push_back(s.normal);
    normal_on_part.push_back(s.normal_on_part);
    normal_on_probe.push_back(on_probe(s.normal));
    before_on_probe.push_back(i > 0 && rows[i - 1] + 1 == rows[i] && same_visit(s, t.touches[rows[i - 1]].scene)
                                  ? normal_on_probe[i - 1]
                                  : Vec3{});
    turned.push_back(cross(-s.stylus.length_mm / kLever_mm * s.stylus.to_head, s.normal));  // n . (w x l) = w . (l x n)
    travel.push_back(s.travel);
    travel_on_probe.push_back(on_probe(s.travel));
    skid.push_back(on_probe(s.travel - dot(s.travel, s.normal) * s.normal));
    oblique = oblique || dot(s.travel, s.normal) > -kStraight;
    orientation.push_back(ordinal(orientations, {s.stylus.head_a_rad, s.stylus.head_b_rad}));
    sensor.push_back(s.stylus.ordinal);
    feature.push_back(s.feature);
    setup.push_back(s.setup);
    run.push_back(s.run);
    speed_mm_s.push_back(s.speed_mm_s);
    accelerations.push_back(s.acceleration_mm_s2);
    const auto row = static_cast<Eigen::Index>(i);
    part_above_20(row) = s.temperature.part - kReferenceTemperature_C;
    for (int k = 0; k < 3; ++k) scale_above_20[k](row) = s.temperature.scale[k] - kReferenceTemperature_C;
  }
  find_ways(t, rows, *this);
  onto_unit(touch), onto_unit(settled), onto_unit(clamped), onto_unit(place);
  for (Points& r : reading) onto_unit(r);
  one_round = on_one_round(place, normal);
  for (std::vector<int>* group : {&orientation, &sensor, &feature, &setup, &run}) in_few(*group);
  speed = levels_of(speed_mm_s);
  const std::vector<int> acceleration = levels_of(accelerations);
  for (std::size_t i = 0; i < rows.size(); ++i) dynamics.push_back(ordinal(dynamics_used, {speed[i], acceleration[i]}));
}

bool several(const std::vector<int>& group) {
  return std::any_of(group.begin(), group.end(), [&](int g) { return g != group.front(); });
}

bool differ(const Vector& temperature) {
  constexpr double kDiffers_K = 0.1;
  return temperature.maxCoeff() - temperature.minCoeff() > kDiffers_K;
}

double stretch(const TouchFactors& f, double share, int touches) {
  return std::max(share, touches / double(f.touch.size()));
}

Matrix trend(const TouchFactors& f) {
  Matrix m(f.time.size(), 2);
  for (std::size_t i = 0; i < f.time.size(); ++i) {
    const double t = f.time[i][0] - 0.5;
    m.row(static_cast<Eigen::Index>(i)) << 2 * t, 2 * t * t;
  }
  return m;
}

Matrix settling(const Points& since) {
  Matrix m(since.size(), 2);
  for (std::size_t i = 0; i < since.size(); ++i)
    m.row(static_cast<Eigen::Index>(i)) << since[i][0], std::sqrt(since[i][0]);
  return m;
}

}  // namespace abbe::diagnose::patterns
