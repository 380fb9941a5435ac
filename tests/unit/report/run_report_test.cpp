#include "engine/report/run_report.hpp"
#include "engine/math/units.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/ids.hpp"
#include "engine/effects/effect.hpp"
#include "engine/influences/influence.hpp"
#include "engine/report/influences.hpp"
#include "engine/report/study.hpp"
#include "sample_plan.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

/// 1000 values around 500 in steps of `step`.
std::vector<double> ramp(double middle, double step) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(middle + (i - 499.5) * step);
  return values;
}

const CharacteristicReport::Contribution* contribution(const CharacteristicReport& c, const std::string& name) {
  for (const auto& k : c.contributions)
    if (k.name == name) return &k;
  return nullptr;
}

}  // namespace

TEST_CASE("an effect models an influence that reports declare, or none") {
  const auto declared = influence_quantities();
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    CHECK((effect->influence.empty() || std::any_of(declared.begin(), declared.end(), [&](const InfluenceQuantity& q) {
             return q.name == effect->influence;
           })));
  }
}

TEST_CASE("limits are relative to the error-free value, conformance is a share") {
  const RunResult run = run_of({samples(0, 500, {499.999, 500.0002}, ramp(500, 1e-6))}, 1003);
  const auto reports = characteristic_reports(length_and_angle(), run, {});
  REQUIRE(reports.size() == 1);
  const CharacteristicReport& c = reports[0];
  CHECK(c.features == std::vector<std::string>{"A", "B"});
  CHECK(c.tolerance == "LEN");
  CHECK(c.kind == "DISTB");
  CHECK(c.unit == "mm");
  CHECK(c.line == 41);
  CHECK(c.lcl.value() == doctest::Approx(-475.5e-6).epsilon(1e-9));  // 25th of 1000
  CHECK(c.ucl.value() == doctest::Approx(474.5e-6).epsilon(1e-9));   // 975th
  CHECK(*c.conformance_probability == 0.7);                          // i - 499.5 <= 200: 700 of 1000
  CHECK(c.evaluated == 1000);
  CHECK(c.trapped == 0);
  CHECK(c.elsewhere == 3);
}

TEST_CASE("the decision on the error-free value goes by the errors around it") {
  // Errors from 0.5005 to 1.4995 um: 95 % of them are not above 1.4495 um.
  const RunResult run = run_of({samples(0, 500, {499.998, 500.001}, ramp(500.001, 1e-6))}, 1000);
  const CharacteristicReport::Decision d = characteristic_reports(length_and_angle(), run, {}).at(0).decision.value();
  CHECK(d.guard_band.value() == doctest::Approx(1.4495e-3).epsilon(1e-9));
  CHECK(d.lower.value() == doctest::Approx(499.9994495).epsilon(1e-12));
  CHECK(d.upper.value() == doctest::Approx(499.9995505).epsilon(1e-12));
  CHECK(d.verdict == Conformity::undecided);  // half of 500 + e, and every 500 - e, are inside
  CHECK(d.tolerance_to_uncertainty == doctest::Approx(3e-3 / 475e-6).epsilon(1e-9));
}

TEST_CASE("decisions are in the unit of the report; a zone begins at 0") {
  const auto decision = [](double upper) {
    const RunResult run = run_of({samples(1, 0, {{}, upper * kDegree}, ramp(0.5 * kDegree, 1e-3 * kDegree))}, 1000);
    return characteristic_reports(length_and_angle(), run, {}).at(0).decision.value();
  };
  CHECK(decision(2).guard_band.value() == doctest::Approx(0.9495).epsilon(1e-9));
  CHECK(decision(2).upper.value() == doctest::Approx(1.0505).epsilon(1e-9));
  CHECK_FALSE(decision(2).lower);
  CHECK(decision(2).verdict == Conformity::conforms);
  CHECK(decision(2).tolerance_to_uncertainty == doctest::Approx(2 / 0.475).epsilon(1e-9));
  CHECK(decision(0.9).verdict == Conformity::undecided);
  CHECK_FALSE(decision(0.9).guard_band);  // it would leave values below 0 only
}

TEST_CASE("where every machine has limits of its own, the decision goes by them") {
  RunResult run = run_of({samples(0, 0, {{}, 1e-3}, ramp(0, 1e-6))}, 1000);
  const auto decision = [&] { return characteristic_reports(length_and_angle(), run, {}).at(0).decision.value(); };
  CHECK(decision().guard_band.value() == doctest::Approx(449.5e-6).epsilon(1e-9));
  // Each limit follows its machine's value: by how much it is kept does not vary.
  for (const double v : run.samples[0].value) run.samples[0].own_limits.push_back({{}, 1e-3 + v});
  CHECK(decision().guard_band.value() < 1e-12);
}

TEST_CASE("each limit of a machine judges by itself") {
  RunResult run = run_of({samples(0, 0, {-1e-3, 1e-3}, ramp(0, 1e-6))}, 1000);  // to either side by 499.5e-6
  const auto conforming = [&] {
    return *characteristic_reports(length_and_angle(), run, {}).at(0).conformance_probability;
  };
  CHECK(conforming() == 1);
  for (std::size_t i = 0; i < 1000; ++i) run.samples[0].own_limits.push_back({-1e-3, i < 100 ? -1e-3 : 1e-3});
  CHECK(conforming() == 0.9);
  for (std::size_t i = 0; i < 1000; ++i) run.samples[0].own_limits[i].lower = i < 300 ? 1e-3 : -1e-3;
  CHECK(conforming() == 0.7);
}

TEST_CASE("angles leave in degrees") {
  const RunResult run =
      run_of({samples(1, 90 * kDegree, {std::nullopt, 91 * kDegree}, ramp(90 * kDegree, 1e-3 * kDegree))}, 1000);
  const CharacteristicReport c = characteristic_reports(length_and_angle(), run, {}).at(0);
  CHECK(c.unit == "deg");
  CHECK(c.reference.value() == doctest::Approx(90).epsilon(1e-14));
  CHECK(c.nominal == doctest::Approx(90).epsilon(1e-14));
  CHECK(*c.upper == doctest::Approx(91).epsilon(1e-14));
  CHECK_FALSE(c.lower);
  CHECK(c.summary.u == doctest::Approx(1e-3 * std::sqrt(1000 * 1001 / 12.0)).epsilon(1e-9));  // of n equal steps
  CHECK(c.lcl.value() == doctest::Approx(-0.4755).epsilon(1e-9));
}

TEST_CASE("shares of variance sum to one and ignore rounding") {
  const auto alone = [](double step) { return run_of({samples(0, 500, {}, ramp(500, step))}, 1000); };
  const std::vector<ContributorRun> runs{{"geometry", alone(2e-6)}, {"head", alone(1e-13)}, {"probe", alone(1e-6)}};
  const CharacteristicReport c = characteristic_reports(length_and_angle(), alone(3e-6), runs).at(0);
  CHECK(contribution(c, "geometry")->share == doctest::Approx(0.8).epsilon(1e-6));
  CHECK(contribution(c, "probe")->share == doctest::Approx(0.2).epsilon(1e-6));
  CHECK(contribution(c, "head")->share == 0);  // u = 3e-11 mm is rounding
  CHECK_FALSE(c.conformance_probability);      // no limits, no probability
  CHECK_FALSE(c.decision);
}

TEST_CASE("when nothing varies every share is zero, not NaN") {
  const RunResult constant = run_of({samples(0, 500, {}, std::vector<double>(1000, 500.0))}, 1000);
  const CharacteristicReport c =
      characteristic_reports(length_and_angle(), constant, {{"geometry", constant}, {"probe", constant}}).at(0);
  CHECK(contribution(c, "geometry")->share == 0);
  CHECK(contribution(c, "probe")->share == 0);
}

TEST_CASE("shares are unknown, not zero, when a contributor alone reaches nothing") {
  const RunResult all = run_of({samples(0, 500, {}, ramp(500, 1e-6))}, 1000);
  const RunResult none = run_of({samples(0, 500, {}, {500.0})}, 1000);
  CHECK(characteristic_reports(length_and_angle(), all, {{"geometry", all}, {"probe", none}})
            .at(0)
            .contributions.empty());
}

TEST_CASE("a characteristic that fewer than two machines reached has no figures") {
  const RunResult run = run_of({samples(0, 500, {}, {500.0}), samples(1, 1, {}, {1.0, 1.1})}, 1000);
  const auto reports = characteristic_reports(length_and_angle(), run, {});
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].tolerance == "ANG");
}

TEST_CASE("shares are unknown when a contributor alone sends no machine there") {
  const RunResult one = run_of({samples(0, 500, {}, ramp(500, 1e-6))}, 1000);
  const auto reports = characteristic_reports(length_and_angle(), one, {{"probe", run_of({}, 1000)}});
  CHECK(reports.at(0).contributions.empty());
}

TEST_CASE("only machines that stopped before it are trapped; a condition sent the others elsewhere") {
  RunResult run = run_of({samples(0, 500, {}, {500.0, 500.1, 500.2})}, 10);
  run.traps = {{2, 7, 50, "after it"}, {5, 3, 40, "before it"}};
  const CharacteristicReport c = characteristic_reports(length_and_angle(), run, {}).at(0);
  CHECK(c.evaluated == 3);
  CHECK(c.trapped == 1);
  CHECK(c.elsewhere == 6);
}

TEST_CASE("without a reference there is nothing that limits could be relative to") {
  RunResult run = run_of({samples(0, 500, {499.9, 500.1}, {500.0, 500.1, 500.2})}, 10);
  run.samples[0].reference = std::nullopt;
  const CharacteristicReport c = characteristic_reports(length_and_angle(), run, {}).at(0);
  CHECK_FALSE(c.reference);
  CHECK_FALSE(c.lcl);
  CHECK_FALSE(c.ucl);
  CHECK(c.summary.symmetric.high == 500.2);
  CHECK(c.conformance_probability.has_value());
  CHECK_FALSE(c.decision);
}

TEST_CASE("the same labels again in the same line are further occurrences") {
  plan::Plan plan = length_and_angle();
  plan.characteristics.push_back(plan.characteristics[0]);
  plan.characteristics.push_back(plan.characteristics[0]);
  plan.characteristics.back().line = 50;
  const RunResult run = run_of({samples(0, 500, {}, {500, 501}), samples(1, 1, {}, {1, 2}),
                                samples(2, 500, {}, {500, 501}), samples(3, 500, {}, {500, 501})},
                               2);
  const auto reports = characteristic_reports(plan, run, {});
  REQUIRE(reports.size() == 4);
  CHECK(reports[0].occurrence == 1);
  CHECK(reports[1].occurrence == 1);
  CHECK(reports[2].occurrence == 2);
  CHECK(reports[3].occurrence == 1);
}

TEST_CASE("influences are declared; an effect that acts makes its influence modelled") {
  EffectActivities acted;
  const auto status = [&](const Machine& machine, const std::string& influence_name) {
    for (const Influence& influence : declare_influences(machine, acted).influences)
      if (influence.name == influence_name) return std::string(name(influence.status));
    return std::string("missing");
  };
  Machine machine;
  CHECK(status(machine, "number and place of the points") == "modelled");
  for (const char* of_the_file : {"geometry", "head indexing", "probe repeatability"})
    CHECK(status(machine, of_the_file) == "not modelled");
  machine.components[5].e_max = 1e-6, machine.head.sd_b_rad = 4e-6, machine.probe.sd_mm.z = 1e-4;
  for (const char* of_the_file : {"geometry", "head indexing", "probe repeatability"})
    CHECK(status(machine, of_the_file) == "modelled");
  machine.components[5].e_max = 0;
  for (double Machine::*squareness :
       {&Machine::squareness_cwy_rad, &Machine::squareness_bwz_rad, &Machine::squareness_awz_rad}) {
    machine.*squareness = 1e-5;
    CHECK(status(machine, "geometry") == "modelled");
    machine.*squareness = 0;
    CHECK(status(machine, "geometry") == "not modelled");
  }
  CHECK(status(machine, "operator") == "not modelled");
  CHECK(status(machine, "part temperature") == "not modelled");
  CHECK(status(machine, "vibration and outliers") == "not modelled");
  machine.effects = {{"thermal.part_expansion", {}}, {"noise.outliers", {}}};
  acted = {{}, {.moved = true}};
  CHECK(status(machine, "part temperature") == "not modelled");
  CHECK(status(machine, "vibration and outliers") == "modelled");
  acted = {{.moved = true}, {}};
  CHECK(status(machine, "part temperature") == "modelled");
  CHECK(status(machine, "vibration and outliers") == "not modelled");
  CHECK(status(machine, "thermal drift") == "not modelled");
}

TEST_CASE("what is the same on every machine has no conformity, for its uncertainty is not known") {
  const auto report = [](double spread) {
    const RunResult run = run_of({samples(0, 500, {499.9, 500.1}, ramp(500, spread))}, 1000);
    return characteristic_reports(length_and_angle(), run, {})[0];
  };
  CHECK(report(1e-6).varies);
  CHECK(report(1e-6).conformance_probability);
  CHECK(!report(0).varies);
  CHECK(!report(1e-14).varies);
  CHECK(!report(1e-9).varies);  // u = 0.3 nm
  CHECK(!report(0).conformance_probability);
  CHECK(!report(0).decision);
  const auto angle_varies = [](double spread_rad) {
    const RunResult run = run_of({samples(1, 1, {}, ramp(1, spread_rad))}, 1000);
    return characteristic_reports(length_and_angle(), run, {})[0].varies;
  };
  CHECK(angle_varies(1e-11));  // u = 2.9e-9 rad
  CHECK(!angle_varies(1e-12));
}

TEST_CASE("a coverage that is asked for gives its intervals beside those of 95 %") {
  const RunResult run = run_of({samples(0, 500, {}, ramp(500, 1e-3))}, 1000);
  CHECK(!characteristic_reports(length_and_angle(), run, {})[0].interval);
  const auto report = characteristic_reports(length_and_angle(), run, {}, nullptr, 0.5)[0];
  REQUIRE(report.interval);
  CHECK(report.interval->coverage == 0.5);
  CHECK(report.interval->symmetric.high - report.interval->symmetric.low == doctest::Approx(0.5));
  CHECK(*report.ucl - *report.lcl == doctest::Approx(0.95));
  // Of an angle it is in degrees, as is the uncertainty of each source: 5 mrad are 0.2865 degrees.
  const RunResult turned = run_of({samples(1, 1, {}, ramp(1, 1e-5))}, 1000);
  const BudgetRuns runs{{{"geometry", turned}}, turned, turned};
  const auto angle = characteristic_reports(length_and_angle(), turned, {}, &runs, 0.5)[0];
  CHECK(angle.interval->symmetric.high - angle.interval->symmetric.low == doctest::Approx(0.28648).epsilon(1e-4));
  CHECK(angle.budget.at(0).u == doctest::Approx(angle.summary.u));
  CHECK(angle.alignment_split.at(0).u == doctest::Approx(angle.summary.u));
}

TEST_CASE("a bound makes an influence bounded, unless it is modelled; the workpiece file goes first") {
  Machine machine;
  machine.bounds = {{"thermal drift", 0.0003, "drift test"}, {"fixturing", 0.002, "machine"}};
  Workpiece workpiece;
  workpiece.bounds = {{"fixturing", 0.001, "task"}};
  EffectActivities acted;
  const auto find = [&](const char* name) {
    for (const Influence& influence : declare_influences(machine, acted, &workpiece).influences)
      if (influence.name == name) return influence;
    return Influence{};
  };
  CHECK(find("thermal drift").status == InfluenceStatus::bounded);
  CHECK(find("thermal drift").at_most_um == doctest::Approx(0.3));
  CHECK(find("thermal drift").source == "drift test");
  CHECK(find("fixturing").at_most_um == doctest::Approx(1));
  CHECK(find("fixturing").source == "task");
  CHECK(find("operator").status == InfluenceStatus::not_modelled);
  CHECK(declare_influences(machine, acted, &workpiece).messages.empty());
  machine.effects = {{"thermal.cycle", {}}};
  acted = {{}};
  CHECK(find("thermal drift").status == InfluenceStatus::bounded);
  acted = {{.moved = true}};
  CHECK(find("thermal drift").status == InfluenceStatus::modelled);
  const auto messages = declare_influences(machine, acted, &workpiece).messages;
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].code == Code::W0434);
}

TEST_CASE("every effect models one influence") {
  for (const Effect* effect : effects()) {
    CAPTURE(std::string(effect->name));
    Machine machine;
    machine.effects = {{std::string(effect->name), {}}};
    int found = 0;
    for (const Influence& influence : declare_influences(machine, {{.moved = true}}).influences) {
      if (influence.name != effect->influence) continue;
      ++found;
      CHECK(influence.status == InfluenceStatus::modelled);
    }
    CHECK(found == 1);
  }
}

TEST_CASE("samples as CSV: every machine, labels quoted, angles in degrees") {
  Study study;
  study.result = run_of({samples(0, 500, {}, {500.25}), samples(1, 90 * kDegree, {}, {90 * kDegree, 45 * kDegree})}, 2);
  study.result.samples[0].machine = {1};
  study.result.samples[0].reference = std::nullopt;
  study.candidates = {0, 7};
  CHECK(samples_csv(length_and_angle(), study) ==
        "machine,candidate,characteristic,line,occurrence,unit,reference,value\r\n"
        "1,7,\"FA(A),FA(B),TA(LEN)\",41,1,mm,,500.25\r\n"
        "0,0,\"FA(A),TA(ANG)\",42,1,deg,90,90\r\n"
        "1,7,\"FA(A),TA(ANG)\",42,1,deg,90,45\r\n");
}
