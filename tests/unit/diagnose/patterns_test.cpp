// Patterns that no effect of the catalogue makes are found in their factor.
#include <doctest/doctest.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/explanations/patterns/patterns.hpp"
#include "engine/diagnose/model/evidence.hpp"
#include "engine/effects/effect.hpp"
#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// The likeliest pattern for a displacement, um, in noise of 1 um.
std::string likeliest(const RecordedTouches& t, const std::function<Vec3(const TouchScene&)>& displacement_um) {
  const auto n = static_cast<Eigen::Index>(t.touches.size());
  LinearModel m;
  m.free = m.random = Matrix::Zero(n, 3);
  m.y.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const TouchScene& s = t.touches[static_cast<std::size_t>(i)].scene;
    for (int k = 0; k < 3; ++k) m.free(i, k) = s.normal[k], m.random(i, k) = s.normal[k] * s.point.x / 500;
    m.y(i) = dot(s.normal, displacement_um(s)) +
        normal_quantile(uniform_pair({4, static_cast<std::uint32_t>(i), stream_of("patterns_test"), 9, 0, 0}).a);
  }
  m.random_group.assign(3, 0);
  m.noise_um = Vector::Ones(n);
  m.noise_group.assign(t.touches.size(), 0);
  m.follows.assign(t.touches.size(), 0);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  Explanations all;
  std::vector<int> rows(t.touches.size());
  std::iota(rows.begin(), rows.end(), 0);
  add_other(t, rows, all);
  for (Explanation& e : all.list) e.prior = 1.0 / double(all.list.size());
  const Evidence evidence = EvidenceSearch(m, h, all).evidence();
  const auto best = std::max_element(evidence.log_bayes.begin(), evidence.log_bayes.end());
  CHECK(*best > 10);
  return all.list[static_cast<std::size_t>(best - evidence.log_bayes.begin())].name;
}

}  // namespace

TEST_CASE("a pattern is found in its factor, smooth or not") {
  const RecordedTouches t = scattered(300);
  const Vec3 oblique = Vec3{1, 1, -1} / std::sqrt(3.0);
  CHECK(likeliest(t, [](const TouchScene& s) {
          return 3.0 * Vec3{std::sin(s.time_s / 700), std::cos(s.time_s / 900), std::sin(s.time_s / 800)};
        }) == "OTHER time, slow");
  CHECK(likeliest(t, [&](const TouchScene& s) { return (s.visit / 2 % 2 ? 1.5 : -1.5) * oblique; }) ==
        "OTHER time, rugged");
  CHECK(likeliest(t, [&](const TouchScene& s) { return 5 * (std::fmod(s.reading.y / 130, 1) - 0.5) * oblique; }) ==
        "OTHER position, along a guide");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return 4 * std::exp(-std::pow(norm(s.point - Vec3{250, 200, 150}) / 120, 2)) * s.normal;
        }) == "OTHER position, height");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return std::pow(double(s.feature) - 2, 2) * (s.time_s - 2000) / 2000 * s.normal;
        }) == "OTHER feature, size in time");
}

TEST_CASE("the form of one ball is a pattern of the direction, and counts once") {
  RecordedTouches t = scattered(300);
  const auto over_position = [&] {
    Explanations all;
    std::vector<int> rows(t.touches.size());
    std::iota(rows.begin(), rows.end(), 0);
    add_other(t, rows, all);
    return std::count_if(all.list.begin(), all.list.end(),
                         [](const Explanation& e) { return e.factor == Factor::position; });
  };
  const auto on_several = over_position();
  for (RecordedTouch& touch : t.touches)
    touch.scene.point = touch.scene.reading = Vec3{200, 300, 100} + 12.5 * touch.scene.normal;
  CHECK(over_position() <= on_several - 4);
  CHECK(likeliest(t, [](const TouchScene& s) { return 10 * s.normal.x * s.normal.y * s.normal.z * s.normal; }) ==
        "OTHER direction, smooth");
}

TEST_CASE("a joint that settles after each indexing is seen over the time since") {
  const RecordedTouches t = scattered(300);
  const auto since = [&](const TouchScene& s) {
    return (s.time_s - t.touches[static_cast<std::size_t>(15 * s.visit)].scene.time_s) / 140;
  };
  CHECK(likeliest(t, [&](const TouchScene& s) {
          return 3 * std::log1p(9 * since(s)) / 2.3 * Vec3{s.stylus.head_b_rad - 1, 0.5, 0};
        }) == "OTHER head, settling");
}

TEST_CASE("patterns over two factors are seen where they lie") {
  const RecordedTouches t = scattered(300);
  const Vec3 middle{250, 200, 150};
  CHECK(likeliest(t, [](const TouchScene& s) {
          return (s.speed_mm_s - 5.5) * (std::abs(s.travel.x) + std::abs(s.travel.y) + std::abs(s.travel.z) - 1.4) * 3 *
              s.normal;
        }) == "OTHER speed, over direction");
  CHECK(likeliest(t, [&](const TouchScene& s) {
          return (s.stylus.head_b_rad - 1) * Vec3{0.02 * (s.point.y - middle.y), 0, 0};
        }) == "OTHER head, over position");
  CHECK(likeliest(t, [](const TouchScene& s) { return (std::fmod(double(s.time_s), 2500) / 1250 - 1) * s.normal; }) ==
        "OTHER time, size along the sequence");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return Vec3{3.0 * (s.feature == 1), -3.0 * (s.feature == 3), 3.0 * (s.feature == 4)};
        }) == "OTHER feature, offset on the part");
  const auto clamped = [&](const TouchScene& s) {
    return (s.time_s - t.touches[static_cast<std::size_t>(100 * s.setup)].scene.time_s) / 1400;
  };
  CHECK(likeliest(t, [&](const TouchScene& s) {
          return (s.setup == 1 ? -1 : 1) * std::sqrt(clamped(s)) * cross(Vec3{0.04, 0, 0}, s.point - middle);
        }) == "OTHER setup, settling");
}

TEST_CASE("what no two factors tell is found over more of them") {
  const RecordedTouches t = scattered(300);
  CHECK(likeliest(t, [](const TouchScene& s) {
          return Vec3{3 * std::sin(s.time_s / 40 * (1 + s.time_s / 6000)), 0, 0};  // of no one period
        }) == "OTHER time, from touch to touch");
  CHECK(likeliest(t, [](const TouchScene& s) {  // swarf on one side of a tip, until it falls off
          const double around = s.visit * s.visit;
          const Vec3 side{std::cos(around), std::sin(around), 0.3};
          return 6 * std::exp(-std::pow(norm(transpose(s.stylus.R_WR) * s.normal - side), 2)) * s.normal;
        }) == "OTHER direction, sides of tips in time");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return 15 * std::cos(s.time_s / 900) * std::cos(s.point.x / 160) * s.normal.x * s.normal.y * s.normal;
        }) == "OTHER time, over place and direction");
}

TEST_CASE("what is wrong at one place or on one spot is found there") {
  const RecordedTouches t = scattered(300);
  CHECK(likeliest(t, [](const TouchScene& s) {
          return Vec3{0, 8 * std::exp(-(std::pow(s.reading.x - 350, 2) + std::pow(s.reading.y - 100, 2)) / 3000), 0};
        }) == "OTHER position, one place");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return (s.feature == 2 ? 6.0 : 0.0) *
              std::exp(-std::pow(norm(s.normal_on_part - Vec3{0, 0.6, 0.8}) / 0.5, 2) / 2) * s.normal;
        }) == "OTHER feature, one spot");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return s.feature == 2 && s.time_s > 1500 ? Vec3{2, -2, 2} : Vec3{};
        }) == "OTHER feature, one of them in time");
}

TEST_CASE("what leans, turns or yields is found as such") {
  const RecordedTouches t = scattered(300);
  CHECK(likeliest(t, [](const TouchScene& s) {
          return Vec3{(s.visit / 5 % 2 ? 0.012 : -0.012) * (s.reading.z - 150), 0, 0};
        }) == "OTHER time, leaning");
  CHECK(likeliest(scattered(300, 4), [](const TouchScene& s) {
          return (s.visit / 18 % 2 ? 0.04 : -0.04) * cross(Vec3{0, 1, 1}, -s.stylus.length_mm * s.stylus.to_head);
        }) == "OTHER head, turning in time");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return 4 * std::exp(-std::pow((s.reading.x - 250) / 60, 2)) * s.normal.y * s.normal.y * s.normal;
        }) == "OTHER position, along a guide");
}

TEST_CASE("what dynamics, skidding and warmth do to some touches is found there") {
  const RecordedTouches t = scattered(300);
  CHECK(likeliest(t, [](const TouchScene& s) {
          const Vec3 travel = transpose(s.stylus.R_WR) * s.travel;
          return (s.stylus.ordinal == 2 ? 2.0 : 0.5) * (s.acceleration_mm_s2 - 300) / 25 *
              (1 - travel.z * travel.z - 0.6) * s.normal;
        }) == "OTHER speed, of each sensor");
  CHECK(likeliest(t, [](const TouchScene& s) {
          const Vec3 skid = transpose(s.stylus.R_WR) * (s.travel - dot(s.travel, s.normal) * s.normal);
          return (s.stylus.ordinal == 2 ? 2.5 : -1.5) * skid.z / norm(skid) * s.normal;
        }) == "OTHER direction, of oblique approaches");
  CHECK(likeliest(t, [](const TouchScene& s) {
          return (s.temperature.part - 20.5) * 3 * (s.feature == 1 ? 1 : s.feature == 4 ? -1 : 0) * s.normal;
        }) == "OTHER temperature, of each feature");
}

TEST_CASE("a probe that does not come home from the touch before is seen by its direction") {
  const RecordedTouches t = scattered(300);
  CHECK(likeliest(t, [&](const TouchScene& s) {
          const auto here = static_cast<std::size_t>((s.time_s - 60 * s.visit) / 10);
          return here % 15 == 0
              ? Vec3{}
              : 1.5 * (t.touches[here - 1].scene.normal - Vec3{0, 0, 1} * t.touches[here - 1].scene.normal.z);
        }) == "OTHER direction, of the touch before");
}

namespace {

/// What is told of the variant that comes nearest to a displacement, um, of those of which something is.
std::string told_of_nearest(const RecordedTouches& t, const std::function<Vec3(const TouchScene&)>& displacement_um) {
  std::vector<int> rows(t.touches.size());
  std::iota(rows.begin(), rows.end(), 0);
  Vector seen(t.touches.size());
  for (const int i : rows) seen(i) = dot(t.touches[i].scene.normal, displacement_um(t.touches[i].scene));
  std::string told;
  double least = seen.squaredNorm();
  for (const Variant& v : explanations_without_readings(t, rows).variants) {
    if (v.told.empty()) continue;
    const double left = (seen - v.signature * least_squares(v.signature, seen)).squaredNorm();
    if (left < 0.999 * least) least = left, told = v.told;
  }
  return told;
}

double period_in(const std::string& told) { return std::stod(told.substr(std::string("a period of ").size())); }

}  // namespace

TEST_CASE("what swings quicker than a room is seen, and its period is told") {
  RecordedTouches t = scattered(300);
  constexpr double kPeriod_s = 83;
  const auto swing = [](const TouchScene& s) {
    return std::sin(2 * kPi * s.time_s / kPeriod_s + 1) * Vec3{1, -0.7, 0.8};
  };
  CHECK(likeliest(t, swing) == "OTHER time, quick cycles");

  const double touches = kPeriod_s / (t.touches.back().scene.time_s - t.touches.front().scene.time_s) * 300;
  const std::string untimed = told_of_nearest(t, swing);  // nobody has logged a time
  CHECK(untimed.ends_with(" touches"));
  CHECK(std::abs(period_in(untimed) - touches) < 0.2);
  t.known |= static_cast<unsigned>(Covariate::time);
  const std::string timed = told_of_nearest(t, swing);
  CHECK(timed.ends_with(" s"));
  CHECK(std::abs(period_in(timed) - kPeriod_s) < 1.5);

  for (RecordedTouch& touch : t.touches) touch.scene.time_s *= 4;  // of hours: quicker than ten minutes
  constexpr double kCompressor_s = 400;
  const auto compressor = [](const TouchScene& s) {
    return std::sin(2 * kPi * s.time_s / kCompressor_s + 1) * Vec3{1, -0.7, 0.8};
  };
  CHECK(likeliest(t, compressor) == "OTHER time, quick cycles");
  CHECK(std::abs(period_in(told_of_nearest(t, compressor)) - kCompressor_s) < 6);
}

TEST_CASE("a machine that leaves a feature too early, or swings when it comes to one, is seen by the way there") {
  RecordedTouches t = scattered(400);
  for (std::size_t i = 0; i < t.touches.size(); ++i) t.touches[i].scene.feature = static_cast<int>(i) / 8 % 6;
  const auto number = [](const TouchScene& s) { return static_cast<std::size_t>((s.time_s - 60 * s.visit) / 10); };
  const auto way = [&](std::size_t from) {
    return from + 1 < t.touches.size() ? unit(t.touches[from + 1].scene.point - t.touches[from].scene.point) : Vec3{};
  };
  const auto leaves = [&](const TouchScene& s) {
    const bool last = number(s) % 8 == 7 && (number(s) + 1) % 100 != 0;
    return last ? s.acceleration_mm_s2 / 100 * way(number(s)) : Vec3{};
  };
  const auto comes = [&](const TouchScene& s) {
    return number(s) % 8 == 0 && number(s) % 100 != 0 ? -3.0 * way(number(s) - 1) : Vec3{};
  };
  CHECK(likeliest(t, leaves) == "OTHER time, first and last touches");
  CHECK(told_of_nearest(t, leaves) ==
        "the last on each feature off along the way between features, by speed and acceleration");
  CHECK(likeliest(t, comes) == "OTHER time, first and last touches");
  CHECK(told_of_nearest(t, comes) == "the first on each feature off along the way between features");
}

TEST_CASE("many runs make no more variants than few") {
  RecordedTouches t = scattered(400);
  for (std::size_t i = 0; i < t.touches.size(); ++i)
    t.touches[i].scene.run = 1 + static_cast<int>(i) / 10, t.touches[i].scene.feature = static_cast<int>(i) / 2;
  std::vector<int> rows(t.touches.size());
  std::iota(rows.begin(), rows.end(), 0);
  const Explanations all = explanations_without_readings(t, rows);
  std::set<std::pair<int, int>> fresh, gone, passing;
  int at_any_time = 0, over_in_the_next_run = 0;
  for (const Variant& b : all.variants) {
    const Effect* effect = all.list[static_cast<std::size_t>(b.explanation)].effect;
    const bool from_a_moment = effect && moment_of(*effect) && b.change.from == 0;
    if (from_a_moment)
      ++(b.change.any() ? over_in_the_next_run : at_any_time);
    else if (b.change.any())
      (b.change.until == 0 ? fresh : b.change.from == 0 ? gone : passing).emplace(b.change.from, b.change.until);
  }
  CHECK(fresh.size() == 8);
  CHECK(gone.size() == 4);
  CHECK(passing.size() == 3);
  CHECK(over_in_the_next_run > 0);
  CHECK(over_in_the_next_run <= at_any_time);
  for (const Explanation& e : all.list)
    if (e.factor == Factor::run || e.factor == Factor::feature)
      for (const int b : e.variants) CHECK(all.variants[static_cast<std::size_t>(b)].signature.cols() <= 18 * 32);
}
