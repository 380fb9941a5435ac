// Scatter is found for what it is, told in its own size, and not found where there is none.
#include "engine/diagnose/findings/noise/judge_noise.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// The only finding, which must be of this effect.
NoiseFinding only_noise(const Planted& p, std::string_view effect) {
  const std::vector<NoiseFinding> found = judge_noise(p.c, p.result);
  REQUIRE(found.size() == 1);
  CHECK(found[0].effect->name == effect);
  CHECK(found[0].p <= kAlarm);
  return found[0];
}

const DiagnosedParameter& figure_of(const NoiseFinding& f, std::string_view name) {
  const auto found = std::find_if(f.parameters.begin(), f.parameters.end(),
                                  [&](const DiagnosedParameter& p) { return p.name == name; });
  REQUIRE(found != f.parameters.end());
  return *found;
}

bool agrees(const DiagnosedParameter& told, double truth) { return std::abs(told.value - truth) < 3.5 * told.u; }

/// Touches for which `where` holds scatter by sd more, each time anew.
template <class Where>
void scatter(Planted& p, double sd_um, Where where) {
  for (int i = 0; i < p.count(); ++i) p.c.model.y(i) += sd_um * where(p.scene(i)) * p.normal(i, 50);
}

bool fast(const TouchScene& s) { return s.speed_mm_s > 5; }

/// The latter half repeats the touches of the first: the same place, stylus and speed, later.
void repeat(Planted& p) {
  const int half = p.count() / 2;
  for (int i = half; i < p.count(); ++i) {
    const double time = p.scene(i).time_s;
    p.scene(i) = p.scene(i - half);
    p.scene(i).time_s = time;
    p.c.model.free.row(i) = p.c.model.free.row(i - half);
    p.c.model.random.row(i) = p.c.model.random.row(i - half);
    p.c.model.y(i) = p.c.model.y(i - half) + Planted::kNoise_um * (p.normal(i, 0) - p.normal(i - half, 0));
  }
}

}  // namespace

TEST_CASE("every effect of the noise is judged, and planned") {
  const auto properties = noise_properties();
  for (const Effect* e : effects())
    CHECK_MESSAGE(std::count_if(properties.begin(), properties.end(),
                                [&](const NoiseProperty* p) { return p->effect == e; }) == is_noise(*e),
                  e->name << ": the effects of the noise, and no others, stand once in noise_property.cpp");
}

TEST_CASE("equal scatter is found unequal no more often than is allowed") {
  // A tenth of the alarms of the search: 0.5 of 500 expected; more than 4 once in 6000 times.
  int alarms = 0;
  for (int k = 1; k <= 500; ++k) {
    const Planted p(k);
    alarms += !judge_noise(p.c, p.result).empty();
  }
  CHECK(alarms <= 4);
}

TEST_CASE("a group that scatters more is told with its ratio, the others with theirs") {
  Planted p(1, 240);
  scatter(p, 1.5, fast);
  const NoiseFinding f = only_noise(p, "noise.unequal");
  CHECK(figure_of(f, "group").word == "fast probing");
  CHECK(figure_of(f, "faster_than_mm_s").value == doctest::Approx(5.5));
  CHECK(agrees(figure_of(f, "ratio"), std::hypot(Planted::kNoise_um, 1.5) / Planted::kNoise_um));
  CHECK(agrees(figure_of(f, "sd_um"), Planted::kNoise_um));
  CHECK(f.factor == Factor::speed);
  CHECK(f.where.front().second == "fast probing");
  CHECK_FALSE(f.certain);  // no touch was repeated
}

TEST_CASE("a surface, a placement, a run or a while may scatter more, too") {
  Planted p(2, 240);
  const auto told_of = [&](auto where, std::string_view group, Factor factor, std::string_view place) {
    scatter(p, 1.5, where);
    const NoiseFinding f = only_noise(p, "noise.unequal");
    CHECK(figure_of(f, "group").word == group);
    CHECK(agrees(figure_of(f, "ratio"), std::hypot(Planted::kNoise_um, 1.5) / Planted::kNoise_um));
    CHECK(f.factor == factor);
    CHECK(f.where.front().second == place);
    return f;
  };
  SUBCASE("a surface") {
    const auto f = told_of([](const TouchScene& s) { return s.feature == 2; }, "one feature", Factor::feature, "C");
    CHECK(figure_of(f, "feature").value == 3);
  }
  SUBCASE("a placement") {
    const auto f = told_of([](const TouchScene& s) { return s.setup == 1; }, "one setup", Factor::setup, "1");
    CHECK(figure_of(f, "setup").value == 1);
  }
  SUBCASE("a run") {
    for (int i = 0; i < p.count(); ++i) p.scene(i).run = 1 + i % 2;
    const auto f = told_of([](const TouchScene& s) { return s.run == 2; }, "one run", Factor::run, "2");
    CHECK(figure_of(f, "run").value == 2);
  }
  SUBCASE("a while") {
    scatter(p, 1.5, [](const TouchScene& s) { return s.touch >= 80 && s.touch < 130; });
    const NoiseFinding f = only_noise(p, "noise.unequal");
    CHECK(figure_of(f, "group").word == "a stretch of time");
    CHECK(std::abs(figure_of(f, "from_s").value - p.scene(80).time_s) < 100);
    CHECK(std::abs(figure_of(f, "to_s").value - p.scene(129).time_s) < 100);
    p.c.touches.known &= ~static_cast<unsigned>(Covariate::time);
    for (const NoiseFinding& other : judge_noise(p.c, p.result))
      CHECK(figure_of(other, "group").word != "a stretch of time");
  }
}

TEST_CASE("of what scatters along an axis no surface that faces that way scatters more, and the other way round") {
  Planted shaken(3, 240), rough(3, 240);
  for (Planted* p : {&shaken, &rough})
    for (int i = 0; i < p->count(); ++i) p->scene(i).feature = std::abs(p->scene(i).normal.y) > 0.7;
  scatter(shaken, 2, [](const TouchScene& s) { return s.normal.y; });
  scatter(rough, 2, [](const TouchScene& s) { return s.feature; });
  CHECK(figure_of(only_noise(shaken, "noise.vibration"), "direction").word == "y");
  CHECK(figure_of(only_noise(rough, "noise.unequal"), "group").word == "one feature");
}

TEST_CASE("gross outliers of one surface are its scatter, if they are far more than chance strikes it") {
  Planted p(4, 240);
  p.c.masked.assign(240, 0);
  CHECK_FALSE(struck_most(p.c));
  for (const int i : {7, 12, 31, 60, 99}) p.c.masked[i] = 1;  // of all surfaces
  CHECK_FALSE(struck_most(p.c));
  for (const int i : {7, 12, 31, 60, 99}) p.c.masked[i] = 0, p.c.masked[5 * (i / 5) + 2] = 1;
  REQUIRE(struck_most(p.c));
  CHECK(struck_most(p.c)->touches == "touches on C");
}

TEST_CASE("repeats tell scatter from a pattern too fine for the recording") {
  Planted noise(2, 240), pattern(2, 240);
  for (Planted* p : {&noise, &pattern}) repeat(*p);
  scatter(noise, 1.5, fast);
  for (int i = 0; i < pattern.count(); ++i)
    pattern.c.model.y(i) += 1.5 * fast(pattern.scene(i)) * pattern.normal(i % (pattern.count() / 2), 50);
  CHECK(only_noise(noise, "noise.unequal").certain);
  CHECK(only_noise(noise, "noise.unequal").repeats == Repeats::differ);
  CHECK_FALSE(only_noise(pattern, "noise.unequal").certain);
  CHECK(only_noise(pattern, "noise.unequal").repeats == Repeats::agree);
}

TEST_CASE("a machine that shakes along one axis is told with the axis and how much") {
  Planted p(3, 240);
  scatter(p, 2, [](const TouchScene& s) { return s.normal.y; });
  const NoiseFinding f = only_noise(p, "noise.vibration");
  CHECK(figure_of(f, "direction").word == "y");
  CHECK(agrees(figure_of(f, "sd_um"), 2));
  CHECK(f.factor == Factor::direction);
  CHECK_FALSE(f.certain);
  CHECK(f.sentence.ends_with("than the others, as if the machine shook that way."));
  Planted again(3, 240);
  repeat(again);
  scatter(again, 2, [](const TouchScene& scene) { return scene.normal.y; });
  CHECK(only_noise(again, "noise.vibration").sentence.ends_with("than the others: the machine shakes that way."));
}

TEST_CASE("all touches may scatter more than the probe's specification says") {
  Planted p(4, 240);
  scatter(p, 1.2, [](const TouchScene&) { return 1; });
  const NoiseFinding f = only_noise(p, "noise.vibration");
  CHECK(agrees(figure_of(f, "sd_um"), 1.2));
  CHECK_FALSE(f.factor);
  CHECK(f.sentence.find("in every direction") != std::string::npos);
}

TEST_CASE("what neighbours share is no scatter") {
  Planted p(5, 240);
  scatter(p, 1.5, fast);
  p.result.hyper.correlation = 0.5;
  const NoiseFinding f = only_noise(p, "noise.unequal");
  CHECK_FALSE(f.certain);
  CHECK(f.sentence.find("correlated by 0.50") != std::string::npos);
}

TEST_CASE("beside what has no name, or a name that leaves more than chance does, scatter is not judged") {
  Planted p(6, 240);
  scatter(p, 1.5, fast);
  REQUIRE(judge_noise(p.c, p.result).size() == 1);
  p.result.adequacy = kInadequate / 2;
  CHECK(judge_noise(p.c, p.result).empty());
  p.result.adequacy = 1;
  p.result.other.emplace();
  CHECK(judge_noise(p.c, p.result).empty());
}

TEST_CASE("rounded readings are told unless the machine file has them") {
  Planted p(7);
  p.c.step_um = 1, p.c.rounding_um = 1 / std::sqrt(12.0);
  const NoiseFinding f = only_noise(p, "noise.resolution");
  CHECK(figure_of(f, "resolution_um").value == 1);
  CHECK(f.certain);
  p.machine.effects = {{"noise.resolution", {{"resolution_um", {1, 0, {}}}}}};
  CHECK(judge_noise(p.c, p.result).empty());
  p.machine.effects[0].parameters["resolution_um"].value = 0.5;
  CHECK(judge_noise(p.c, p.result).size() == 1);
  p.c.rounding_um = 0;  // does not count beside the probe's noise
  CHECK(judge_noise(p.c, p.result).empty());
}

namespace {

/// These touches, all of feature C, are so far outwards: masked, as the baseline leaves them.
void strike(Planted& p, const std::vector<int>& touches, double um) {
  p.c.baseline.model = p.c.model;
  p.c.masked.assign(p.c.rows.size(), 0);
  p.c.off_um = Vector::Zero(p.count());
  for (const int i : touches) {
    p.c.masked[static_cast<std::size_t>(i)] = 1;
    p.c.off_um(i) = um;
    p.scene(i).feature = 2;
  }
}

}  // namespace

TEST_CASE("outliers are told with their share and size, and where most of them are") {
  Planted p(8);
  strike(p, {5, 40, 77, 110}, 8);
  const NoiseFinding f = only_noise(p, "noise.outliers");
  CHECK(figure_of(f, "share").value == doctest::Approx(4 / 120.0));
  CHECK(figure_of(f, "size_um").value == doctest::Approx(8));
  CHECK(f.where.front().second == "C");
  CHECK(f.certain);
  strike(p, {5, 40, 77, 110}, -8);
  CHECK(figure_of(only_noise(p, "noise.outliers"), "size_um").value == doctest::Approx(-8));
}

TEST_CASE("outliers that lie together may be something that happened then") {
  Planted p(9);
  strike(p, {70, 71, 73, 74}, 8);
  CHECK_FALSE(only_noise(p, "noise.outliers").certain);
}

TEST_CASE("one far touch, touches just beyond the limit, and as many as the machine file has are no finding") {
  Planted p(10);
  strike(p, {40}, 20);
  CHECK(judge_noise(p.c, p.result).empty());
  strike(p, {5, 40, 77, 110}, 1.2 * kOutlier * Planted::kNoise_um);
  CHECK(judge_noise(p.c, p.result).empty());
  strike(p, {5, 40, 77, 110}, 8);
  p.machine.effects = {{"noise.outliers", {{"share", {4 / 120.0, 0, {}}}}}};
  CHECK(judge_noise(p.c, p.result).empty());
}
