// Touches scattered over a volume, and a recording of them in which an effect was planted.
#pragma once

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/findings/search.hpp"
#include "engine/effects/effect.hpp"
#include "engine/lanes/random.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

/// Their normals are in all directions; after each `visit` of them the head is indexed to another of three orientations.
inline RecordedTouches scattered(int count, int visit = 15) {
  RecordedTouches t;
  for (int i = 0; i < count; ++i) {
    const auto u = [&](std::uint32_t which) {
      return uniform_pair({3, static_cast<std::uint32_t>(i), stream_of("patterns_test"), which, 0, 0}).a;
    };
    RecordedTouch touch;
    touch.row = touch.scene.touch = i;
    TouchScene& s = touch.scene;
    s.point = s.reading = {500 * u(0), 400 * u(1), 300 * u(2)};
    const double z = 2 * u(3) - 1, around = 2 * kPi * u(4), r = std::sqrt(1 - z * z);
    s.normal = {r * std::cos(around), r * std::sin(around), z};
    s.visit = i / visit;
    s.time_s = 10 * i + 60 * s.visit;
    s.stylus.indexed = true;
    s.stylus.head_b_rad = s.visit % 3;
    s.stylus.to_head = Vec3{std::sin(2 * kPi / 3 * (s.visit % 3)), 0, std::cos(2 * kPi / 3 * (s.visit % 3))};
    s.stylus.length_mm = 100;
    s.stylus.ordinal = 1 + s.visit / 3 % 2;
    s.acceleration_mm_s2 = u(6) < 0.5 ? 200 : 400;
    s.temperature.part = 20 + std::round(u(7) * 4) / 4;
    s.feature = i % 5;
    s.speed_mm_s = u(5) < 0.5 ? 3 : 8;
    s.travel = unit(Vec3{0.3, 0.3, 0.1} - s.normal);
    s.normal_on_part = s.normal;
    s.setup = i / 100;
    t.touches.push_back(touch);
  }
  return t;
}

/// A recording of scattered touches: a placement that nobody knows, a machine whose x is too long, and noise.
struct Planted {
  static constexpr double kNoise_um = 0.5;

  Recording recording;
  Machine machine;
  Case c;
  SearchResult result;

  explicit Planted(std::uint32_t seed, int count = 120) : seed_(seed) {
    c.recording = &recording;
    c.machine = &machine;
    c.touches = scattered(count);
    c.touches.known = c.touches.varying = ~0u;
    c.touches.features = {"A", "B", "C", "D", "E"};
    c.touches.styli = {"S1", "S2"};
    for (RecordedTouch& touch : c.touches.touches)
      touch.scene.stylus.shaft_diameter_mm = 3, touch.scene.stylus.young_MPa = 550e3;
    c.rows.resize(c.touches.touches.size());
    std::iota(c.rows.begin(), c.rows.end(), 0);
    recording.rows.resize(c.rows.size());
    LinearModel& m = c.model;
    m.free.resize(count, 3), m.random.resize(count, 1), m.y.resize(count);
    m.random_group = {0};
    m.noise_um = Vector::Constant(count, kNoise_um);
    m.noise_group.assign(c.rows.size(), 0);
    m.follows.assign(c.rows.size(), 0);
    for (int i = 0; i < count; ++i) {
      const TouchScene& s = c.touches.touches[i].scene;
      for (int k = 0; k < 3; ++k) m.free(i, k) = s.normal[k];
      m.random(i, 0) = s.normal.x * s.point.x / 500;
      m.y(i) = 3 * s.normal.x - 2 * s.normal.y + 0.8 * m.random(i, 0) + kNoise_um * normal(i, 0);
    }
    c.hyper.noise = result.hyper.noise = result.hyper_of_likelier.noise = Vector::Ones(1);
  }

  /// A standard normal number of this recording.
  double normal(int address, std::uint32_t which) const {
    return normal_quantile(
        uniform_pair({seed_, static_cast<std::uint32_t>(address), stream_of("scattered"), which, 0, 0}).a);
  }

  TouchScene& scene(int touch) { return c.touches.touches[touch].scene; }
  int count() const { return static_cast<int>(c.rows.size()); }

  /// Displaces all touches as the effect of this name does; its draws are new in each visit.
  void plant(const std::string& name, const std::vector<double>& theta) {
    const Effect& effect = *find_effect(name);
    for (int i = 0; i < count(); ++i) {
      std::vector<double> z;
      for (int k = 0; k < effect.draws; ++k) z.push_back(normal(scene(i).visit, 1 + static_cast<std::uint32_t>(k)));
      c.model.y(i) += kUmPerMm * dot(scene(i).normal, effect.displace(scene(i), theta.data(), z.data()));
    }
  }

  /// Seeks these effects alone, and finds the likeliest of them.
  void find(const std::vector<std::string>& names) {
    c.explanations = named_explanations(c.touches, c.rows, names);
    result.first = result.on_grid = EvidenceSearch(c.model, c.hyper, c.explanations).evidence();
    result.findings = {finding_of(c.explanations, result.first, true)};
  }

 private:
  std::uint32_t seed_;
};

}  // namespace abbe::diagnose
