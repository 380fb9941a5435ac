#include "engine/report/study.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/stats/summary.hpp"
#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

const SourceFile& length_source() {
  static const SourceFile source("length.dmi", "");
  return source;
}

const Machine& machine() {
  static const Machine m = read_machine("coord3-mc16");
  return m;
}

Arguments distance() {
  Arguments a;
  a.add_text("mode", "NOMINL");
  a.add_number("nominal", 200);
  a.add_number("lower", -0.005);
  a.add_number("upper", 0.005);
  a.add_text("axis", "YAXIS");
  return a;
}

/// A length of 200 mm along y between two touches with one head position.
plan::Plan length_plan() {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  const auto p = b.point({800, 400, -500}, {0, -1, 0});
  const auto q = b.point({800, 600, -500}, {0, 1, 0});
  b.evaluate({p, q}, "DISTB", distance());
  return b.plan;
}

StudyOptions few(int machines) {
  StudyOptions options;
  options.machines = machines;
  options.threads = 2;
  return options;
}

bool has(const std::vector<Diagnostic>& messages, Code code) {
  return std::any_of(messages.begin(), messages.end(), [&](const Diagnostic& d) { return d.code == code; });
}

}  // namespace

TEST_CASE("a study reports figures, shares, counts and the machine's weak spot") {
  const Study study = run_study(length_plan(), machine(), few(400), length_source());
  const RunReport& r = study.report;
  CHECK(r.program == "length.dmi");
  CHECK(r.machine == "coord3-mc16");
  CHECK(r.machines.used == 400);
  CHECK(study.candidates.size() == 400);
  REQUIRE(r.characteristics.size() == 1);
  const CharacteristicReport& c = r.characteristics[0];
  CHECK(c.summary.n == 400);
  CHECK(c.reference.value() == doctest::Approx(200).epsilon(1e-12));
  CHECK(c.summary.u == summarize(study.result.samples[0].value).u);
  REQUIRE(c.contributions.size() == 3);
  CHECK(c.contributions[0].share + c.contributions[2].share == doctest::Approx(1).epsilon(1e-12));
  CHECK(c.contributions[1].share == 0);  // one head position shifts both touches alike
  CHECK(has(r.messages, Code::W0416));   // fewer than half of the paper's candidates pass
}

TEST_CASE("the probe's share is the variance of two touches") {
  const Study study = run_study(length_plan(), machine(), few(2000), length_source());
  const CharacteristicReport& c = study.report.characteristics.at(0);
  // Contributors are independent and act linearly: u^2 = V(geometry) + V(probe), V(probe) = 2 sd^2.
  // Of 2000 machines the sample variance of the probe scatters by sqrt(2 / 1999) = 3.2 %, and the
  // sum of the variances differs from u^2 by twice their sample covariance, at most 1 / sqrt(1999)
  // = 2.2 % of u^2. Four standard errors together: false-alarm rate 6e-5.
  const double expected = 2 * machine().probe.sd_mm.y * machine().probe.sd_mm.y / (c.summary.u * c.summary.u);
  CHECK(std::fabs(c.contributions[2].share / expected - 1) <= 4 * std::hypot(0.032, 0.022));
}

TEST_CASE("threads change no bit of a study") {
  StudyOptions one = few(150);
  one.threads = 1;
  const Study a = run_study(length_plan(), machine(), one, length_source());
  const Study b = run_study(length_plan(), machine(), few(150), length_source());
  CHECK(a.result.samples[0].value == b.result.samples[0].value);
  CHECK(a.report.characteristics[0].contributions[0].share == b.report.characteristics[0].contributions[0].share);
}

TEST_CASE("an adaptive study continues where a fixed one ends, and says when it gives up") {
  StudyOptions options = few(0);
  options.digits = 2;
  options.max_blocks = 2;
  const Study study = run_study(length_plan(), machine(), options, length_source());
  const Samples& all = study.result.samples.at(0);
  REQUIRE(study.result.machines == 2 * kBlockMachines);
  CHECK(study.report.machines.used == 2 * kBlockMachines);
  CHECK(std::is_sorted(study.candidates.begin(), study.candidates.end()));
  CHECK(std::adjacent_find(study.candidates.begin(), study.candidates.end()) == study.candidates.end());
  CHECK(all.machine.front() == 0);
  CHECK(all.machine.back() == 2 * kBlockMachines - 1);

  // The same 20 000 machines at once give the same values: blocks of trials are only a way of
  // counting.
  const Study whole = run_study(length_plan(), machine(), few(2 * kBlockMachines), length_source());
  CHECK(whole.result.samples[0].value == all.value);
  CHECK(whole.report.machines.generated == study.report.machines.generated);

  options.max_blocks = 1;
  CHECK(has(run_study(length_plan(), machine(), options, length_source()).report.messages, Code::W0605));
}

TEST_CASE("an adaptive study settles the interval of the coverage that was asked for, in blocks that hold its limits") {
  StudyOptions options = few(0);
  options.digits = 1;
  const int settled = run_study(length_plan(), machine(), options, length_source()).result.machines;
  options.coverage = 0.95;
  CHECK(run_study(length_plan(), machine(), options, length_source()).result.machines == settled);
  options.coverage = 0.998;  // J = 100 / (1 - p), JCGM 101, 7.9.4
  options.max_blocks = 10;
  CHECK(run_study(length_plan(), machine(), options, length_source()).result.machines == 100'000);
  options.max_blocks = 9;
  const Study stopped = run_study(length_plan(), machine(), options, length_source());
  CHECK(stopped.result.machines == 50'000);
  const auto told = std::find_if(stopped.report.messages.begin(), stopped.report.messages.end(),
                                 [](const Diagnostic& d) { return d.code == Code::W0605; });
  REQUIRE(told != stopped.report.messages.end());
  CHECK(told->message.find("stable to 1 digit after 50000 machines") != std::string::npos);
  CHECK(told->help == "see the Monte Carlo errors, or ask for a lower --coverage");
}

TEST_CASE("a characteristic that next to no machine reaches is lost, with the reason") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  const auto y = b.column();
  const auto p = b.point({800, 400, -500}, {0, -1, 0});
  b.append(plan::Obtain{y, p, plan::Quantity::y});
  // Every machine with an error loops without end; only the error-free one reads exactly 400.
  const int loop = static_cast<int>(b.plan.operations.size());
  b.append(plan::JumpUnless{{plan::PushColumn{y}, plan::PushConstant{400}, plan::Op2::subtract, plan::Op1::abs,
                             plan::PushConstant{1e-9}, plan::Op2::less},
                            loop});
  b.evaluate({p, p}, "DISTB", distance());
  b.append(b.plan.operations.back().action);  // once more, as in the next turn of a loop
  const Study study = run_study(b.plan, machine(), few(5), length_source());
  CHECK(study.report.characteristics.empty());
  CHECK(study.result.samples.size() == 2);
  REQUIRE(study.report.lost.size() == 1);
  CHECK(study.report.lost[0].feature == "F0, F0");
  CHECK(study.report.lost[0].reason.starts_with("0 of 5 machines reached it; the first stopped at line"));
  CHECK(study.report.traps.size() == 5);
}

TEST_CASE("an effect left in shifts the mean, corrected it leaves only its uncertainty") {
  // A tip 2 um larger than assumed in radius moves both touches outwards: the length reads 4 um long.
  Machine with = machine();
  with.effects = {{"probe.tip_radius", {{"amplitude_um", {2, 0.5, ""}}}},
                  // the length lies along y: each effect has a share of its own
                  {"machine.scale", {{"scale_um_per_m", {10, 1, ""}}, {"axis", {0, 0, "x"}}}}};
  StudyOptions options = few(400);
  const auto figures = [&](const Machine& m) {
    const Study study = run_study(length_plan(), m, options, length_source());
    CHECK(study.report.effect_use.has_value() == !m.effects.empty());
    if (study.report.effect_use) CHECK(*study.report.effect_use == options.effect_use);
    return study.report.characteristics.at(0);
  };
  const CharacteristicReport left_in = figures(with);
  options.effect_use = EffectUse::corrected;
  const CharacteristicReport corrected = figures(with), without = figures(machine());
  CHECK(left_in.summary.mean - corrected.summary.mean == doctest::Approx(0.004).epsilon(1e-6));
  CHECK(left_in.summary.u == doctest::Approx(corrected.summary.u).epsilon(1e-9));
  // 2 x 0.5 um of the parameter, independent of all else: the mean of 400 draws lies within 4 of its errors.
  CHECK(std::fabs(corrected.summary.mean - without.summary.mean) < 4 * 0.001 / std::sqrt(400));
  CHECK(corrected.summary.u > without.summary.u);
  REQUIRE(left_in.contributions.size() == 5);
  CHECK(left_in.contributions[3].name == "probe.tip_radius");
  CHECK(left_in.contributions[3].share > 0);
  CHECK(left_in.contributions[3].share == doctest::Approx(corrected.contributions[3].share).epsilon(1e-9));
  CHECK(left_in.contributions[4].share == 0);
}

TEST_CASE("an effect that moves no touch is told, and no influence counts as modelled by it") {
  Machine with = machine();
  with.effects = {{"thermal.part_expansion", {{"cte_error_ppm_per_K", {5, 1, ""}}}},  // at 20 degrees C
                  {"probe.tip_radius", {{"amplitude_um", {2, 0, ""}}}},
                  // the length lies along y
                  {"machine.scale", {{"scale_um_per_m", {10, 1, ""}}, {"axis", {0, 0, "x"}}}}};
  StudyOptions options = few(400);
  const auto idle = [&] {
    std::vector<std::string> told;
    for (const Diagnostic& d : run_study(length_plan(), with, options, length_source()).report.messages)
      if (d.code == Code::W0615) told.push_back(d.message.substr(0, d.message.find(':')));
    return told;
  };
  const auto status = [&](std::string_view influence_name) {
    for (const Influence& i : run_study(length_plan(), with, options, length_source()).report.influences)
      if (i.name == influence_name) return std::string(name(i.status));
    return std::string("missing");
  };
  CHECK(idle() == std::vector<std::string>{"thermal.part_expansion", "machine.scale"});
  CHECK(status("part temperature") == "not modelled");
  CHECK(status("tip size and form") == "modelled");
  options.effect_use = EffectUse::corrected;  // nothing is left of a certain size
  CHECK(idle() == std::vector<std::string>{"thermal.part_expansion", "probe.tip_radius", "machine.scale"});
  CHECK(status("tip size and form") == "not modelled");
}

TEST_CASE("an empirical effect at touches beyond those that it was fitted to is told") {
  Machine with = machine();
  const auto told = [&](std::map<std::string, EffectSetting::Value> range) {
    EffectSetting map{"empirical.map", {{"plane", {0, 0, "xy"}}, {"y_0_0_um", {1, 0.5, ""}}}};
    map.parameters.merge(range);
    with.effects = {map};
    return has(run_study(length_plan(), with, few(20), length_source()).report.messages, Code::W0623);
  };
  const EffectSetting::Value no{0, 0, ""}, half{500, 0, ""}, all{1000, 0, ""};
  CHECK_FALSE(told({{"from_1", no}, {"to_1", all}, {"from_2", no}, {"to_2", all}}));
  CHECK(told({{"from_1", no}, {"to_1", all}, {"from_2", no}, {"to_2", half}}));
  CHECK(told({{"from_1", half}, {"to_1", no}, {"from_2", no}, {"to_2", all}}));
}

TEST_CASE("what acts only on machines of a later block acts in the study") {
  Machine with = machine();
  with.effects = {{"noise.outliers", {{"share", {1.0 / 20'000, 0, ""}}}}};
  StudyOptions options = few(0);
  options.digits = 2;
  options.seed = 10;  // one at which the first block has no outlier and the second has
  const auto acted = [&] {
    return run_study(length_plan(), with, options, length_source()).result.activities.front().moved;
  };
  options.max_blocks = 1;
  REQUIRE_FALSE(acted());
  options.max_blocks = 2;
  CHECK(acted());
}

TEST_CASE("limits from few machines are told, those of the coverage asked for and those of 95 %") {
  const auto told = [](int machines, std::optional<double> coverage) {
    StudyOptions options = few(machines);
    options.coverage = coverage;
    return has(run_study(length_plan(), machine(), options, length_source()).report.messages, Code::W0435);
  };
  CHECK(told(399, {}));
  CHECK_FALSE(told(400, {}));
  CHECK(told(399, 0.5));
  CHECK_FALSE(told(400, 0.5));
  CHECK(told(400, 0.99));
  CHECK_FALSE(told(2000, 0.99));
  StudyOptions options = few(100);
  options.coverage = 0.99999;
  const auto messages = run_study(length_plan(), machine(), options, length_source()).report.messages;
  const auto help =
      std::find_if(messages.begin(), messages.end(), [](const auto& d) { return d.code == Code::W0435; })->help;
  CHECK(help.find("--machines 2000000 or more; JCGM 101, 7.2.2 recommends 1000000000") != std::string::npos);
}

TEST_CASE("settings that make no sense are refused") {
  CHECK_THROWS_AS(run_study(length_plan(), machine(), few(1), length_source()), UserError);  // E0603
  StudyOptions options = few(100);
  options.digits = 3;
  CHECK_THROWS_AS(run_study(length_plan(), machine(), options, length_source()), UserError);
}

TEST_CASE("the steps of a study are announced") {
  std::vector<std::string> steps;
  run_study(length_plan(), machine(), few(20), length_source(),
            [&](std::string_view step) { steps.emplace_back(step); });
  CHECK(std::find(steps.begin(), steps.end(), "probe alone") != steps.end());
}
