// A mismatch is located where the physics acts that explains it, or where the best pattern lies.
#include "engine/diagnose/findings/locate.hpp"
#include "engine/diagnose/explanations/patterns/patterns.hpp"

#include <doctest/doctest.h>

#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// Recordings in order: what their likeliest explanation has follows an exponential law, 3 nats in one of 20.
std::vector<Evidence> in_order() {
  std::vector<Evidence> out;
  for (int k = 0; k < 200; ++k) out.push_back({{-std::log((k + 0.5) / 200)}, {}, 0, 0});
  return out;
}

std::vector<Location> located(const Planted& p) {
  return locate(p.c, EvidenceSearch(p.c.model, p.c.hyper, p.c.explanations), p.result);
}

/// Where a pattern over a factor lies that is 2 um for the touches of which `in` holds.
template <class In>
std::vector<Location> pattern_over(Factor factor, In in) {
  Planted p(1, 240);
  for (int i = 0; i < p.count(); ++i)  // each tip in a sensor of its own
    p.scene(i).stylus.name = p.scene(i).stylus.ordinal == 1 ? "S1" : "S2";
  Matrix shape(p.count(), 1);
  for (int i = 0; i < p.count(); ++i) shape(i) = in(p.scene(i)) ? 1 : 0;
  p.c.model.y += 2 * shape;
  for (const Factor other : {factor, factor == Factor::position ? Factor::direction : Factor::position}) {
    Matrix columns = shape;
    if (other != factor)
      for (int i = 0; i < p.count(); ++i) columns(i) = p.normal(i, 60);
    add_pattern(p.c.explanations, other, "in groups", columns);
  }
  for (Explanation& e : p.c.explanations.list) e.prior = 0.5;
  p.result.first = p.result.on_grid = EvidenceSearch(p.c.model, p.c.hyper, p.c.explanations).evidence();
  p.result.other = finding_of(p.c.explanations, p.result.first, false);
  p.result.null = in_order();
  return located(p);
}

/// The only place that is told, by its label.
template <class In>
std::string label(Factor factor, In in) {
  const std::vector<Location> found = pattern_over(factor, in);
  REQUIRE(found.size() == 1);  // nothing speaks for the other factor
  CHECK(found[0].factor == name(factor));
  CHECK(found[0].share == 1);
  CHECK(found[0].p < 1e-3);
  return found[0].where.empty() ? "everywhere" : found[0].where[0].first + " " + found[0].where[0].second;
}

}  // namespace

TEST_CASE("where a pattern is strongest is told in words of its factor") {
  CHECK(label(Factor::sensor, [](const TouchScene& s) { return s.stylus.ordinal == 2; }) == "sensor S2");
  CHECK(label(Factor::setup, [](const TouchScene& s) { return s.setup == 1; }) == "setup 1");
  CHECK(label(Factor::feature, [](const TouchScene& s) { return s.feature == 3; }) == "feature D");
  CHECK(label(Factor::speed, [](const TouchScene& s) { return s.speed_mm_s > 5; }) == "speed 8 mm/s");
  CHECK(label(Factor::head, [](const TouchScene& s) { return s.visit % 3 == 2; }) == "head A 0.0 B 114.6");
  CHECK(label(Factor::direction, [](const TouchScene& s) { return s.normal.z > 0.97; }).find("normal ") == 0);
  CHECK(label(Factor::position, [](const TouchScene& s) { return s.point.x > 480; }) == "x 481 to 494 mm");
  CHECK(label(Factor::temperature, [](const TouchScene& s) { return s.temperature.part > 20.9; }) == "part_C 21.00 C");
}

TEST_CASE("a pattern over time lies between two times, or between two touches where no clock was logged") {
  const auto late = [](const TouchScene& s) { return s.time_s > 2900; };
  CHECK(label(Factor::time, late) == "touch 211 to 240");
}

TEST_CASE("all labels are told that are strong, and none where that is nearly everywhere") {
  CHECK(label(Factor::feature, [](const TouchScene& s) { return s.feature == 1 || s.feature == 3; }) == "feature B, D");
  CHECK(label(Factor::feature, [](const TouchScene& s) { return s.feature > 0; }) == "everywhere");
}

TEST_CASE("what shows nearly everywhere has no place") {
  CHECK(label(Factor::position, [](const TouchScene& s) { return s.feature % 2 == 0; }) == "everywhere");
}

TEST_CASE("nothing found lies nowhere") {
  Planted p(2);
  p.find({"probe.tip_radius"});
  p.result.findings.clear();
  CHECK(located(p).empty());
}

TEST_CASE("an effect shows in the factor of which it is a function, or in what of it the touches differ in") {
  Planted p(3);
  p.find({"probe.trigger_delay", "head.axis_errors", "machine.step"});
  const auto factor_of = [&](int k) {
    const Explanation& e = p.c.explanations.list[k];
    return shown_in(p.c, e, p.c.explanations.variants[e.variants.front()]);
  };
  CHECK(factor_of(0) == Factor::speed);
  CHECK(factor_of(1) == Factor::head);
  for (int i = 0; i < p.count(); ++i) p.scene(i).speed_mm_s = 3, p.scene(i).stylus.head_b_rad = 0;
  CHECK(factor_of(0) == Factor::direction);
  CHECK(factor_of(1) == Factor::direction);
}

TEST_CASE("what is new in a run shows there, and what is in one placement alone there") {
  Planted p(5);
  p.find({"thermal.part_expansion"});
  const Explanation& e = p.c.explanations.list[0];
  Variant variant = p.c.explanations.variants[e.variants.front()];
  std::size_t setup = 0;
  while (e.effect->parameters[setup].name != "setup") ++setup;
  variant.theta[setup] = 0;
  CHECK(shown_in(p.c, e, variant) == e.factor);
  variant.theta[setup] = 2;
  CHECK(shown_in(p.c, e, variant) == Factor::setup);
  variant.change.from = 2;
  CHECK(shown_in(p.c, e, variant) == Factor::run);
}

TEST_CASE("the likelier factor stands first, others beside it with their share of what the best describes") {
  Planted p(4, 240);
  p.plant("probe.tip_radius", {1, 0});
  p.plant("part.shift", {3, 1505, 0, 0, 0});
  p.find({"probe.tip_radius", "part.shift", "machine.squareness"});
  p.result.null = in_order();
  const std::vector<Location> found = located(p);
  REQUIRE(found.size() == 2);  // nothing speaks for the squareness
  CHECK(found[0].share == 1);
  CHECK(found[1].share > 0);
  CHECK(found[1].share < 1);
  CHECK(found[0].factor != found[1].factor);
}

TEST_CASE("what changed between runs lies in the run, whatever its physics") {
  Planted p(5, 240);
  for (int i = 0; i < p.count(); ++i) p.scene(i).run = i < 120 ? 1 : 2;
  for (int i = 120; i < p.count(); ++i) p.c.model.y(i) += 1.5;  // a larger tip in the second run
  p.find({"probe.tip_radius"});
  p.result.null = in_order();
  const std::vector<Location> found = located(p);
  REQUIRE(!found.empty());
  CHECK(found[0].factor == "run");
  CHECK(found[0].where[0].second == "2");
}

TEST_CASE("the size of a pattern is as uncertain as its signal-to-noise says, and never below nothing") {
  const Unexplained clear = pattern_of_size(Factor::time, "smooth", 2, 100);
  CHECK(clear.factor == "time");
  CHECK(clear.shape == "smooth");
  CHECK(clear.amplitude_u_um == doctest::Approx(0.2));
  CHECK(clear.low_um == doctest::Approx(2 - 1.96 * 0.2).epsilon(0.001));
  CHECK(clear.high_um == doctest::Approx(2 + 1.96 * 0.2).epsilon(0.001));
  const Unexplained faint = pattern_of_size(Factor::time, "smooth", 2, 1);
  CHECK(faint.amplitude_u_um == 2);
  CHECK(faint.low_um == 0);
}
