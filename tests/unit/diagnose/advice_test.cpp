// What to do next is little enough to be done.
#include "engine/diagnose/planning/advice.hpp"

#include <doctest/doctest.h>

#include "engine/diagnose/findings/belief.hpp"
#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// A tip's radius was found, and it leaves more than chance does.
struct LeavesMore : Planted {
  LeavesMore() : Planted(1) {
    plant("probe.tip_radius", {2, 0});
    find({"probe.tip_radius"});
    result.adequacy = kInadequate / 2;
    c.baseline.surfaces = Surfaces::calibrated;
    for (int i = 0; i < count(); ++i) recording.rows[i].touch = i + 1;
  }
  void miss(const char* effect, Covariate what, bool logged) {
    const auto missing = static_cast<unsigned>(what);
    c.explanations.unjudged.push_back({find_effect(effect), missing, logged ? missing : 0});
    if (!logged) c.touches.known &= ~missing;
  }
  /// Instead of the tip's radius: a pattern over a factor, alike at all touches.
  void find_pattern_over(Factor factor) {
    result.findings.clear();
    c.explanations.list.emplace_back().factor = factor;
    result.other = Finding{};
    result.other->explanation = static_cast<int>(c.explanations.list.size()) - 1;
    result.other->variant = static_cast<int>(c.explanations.variants.size());
    c.explanations.variants.emplace_back().signature = Matrix::Ones(c.model.y.size(), 1);
  }
  std::string says(double believed = 1) const {
    Diagnosis told;
    told.effects.push_back({{"probe.tip_radius"}, believed, {}, {}});
    return otherwise(c, result, told);
  }
};

}  // namespace

TEST_CASE("a name that stands alone and is doubted is followed by what would show whether it is right") {
  LeavesMore p;
  p.result.adequacy = 1;
  CHECK(p.says() == "");
  CHECK(p.says(kDoubted).starts_with("Repeat with the part turned and with another stylus ball"));
}

TEST_CASE("of all that was not logged three columns are asked for, each once") {
  LeavesMore p;
  p.miss("thermal.part_expansion", Covariate::part_temperature, false);
  p.miss("thermal.scale_expansion", Covariate::scale_temperature, false);  // three more, and no two of them do
  p.miss("probe.trigger_delay", Covariate::speed, true);
  p.miss("machine.dynamics", Covariate::acceleration, false);
  p.miss("part.load_bending", Covariate::load, false);
  CHECK(p.says().ends_with("first of all, log accel_mm_s2, temp_part_C, load_kg, and let them vary."));
}

TEST_CASE("what was logged and is the same throughout comes last") {
  LeavesMore p;
  p.miss("probe.trigger_delay", Covariate::speed, true);
  p.miss("machine.dynamics", Covariate::acceleration, false);
  CHECK(p.says().ends_with("first of all, log accel_mm_s2, and let it and speed_mm_s vary."));
}

TEST_CASE("what tells more comes before a run that hardly tells two names apart") {
  LeavesMore p;
  p.find({"probe.tip_radius", "probe.trigger_delay"});
  p.result.findings.front().set = {0, 1};
  Diagnosis told;
  told.effects.push_back({{"probe.tip_radius", "probe.trigger_delay"}, 1, {}, {}});
  CHECK(otherwise(p.c, p.result, told).find("No other run of these touches would tell them apart") !=
        std::string::npos);
  NextMeasurement& next = told.next_measurement.emplace_back();
  next.separates = told.effects.front().members;
  next.expected_probability = 0.55;
  CHECK(otherwise(p.c, p.result, told)
            .find("only a little better than guessing. Do first what tells more: probe.tip_radius: ") !=
        std::string::npos);
  next.expected_probability = 0.9;
  CHECK(otherwise(p.c, p.result, told).find("guessing") == std::string::npos);
}

TEST_CASE("a calibrated feature that strays may have a wrong figure in its certificate") {
  LeavesMore p;
  p.find_pattern_over(Factor::feature);
  CHECK(p.says().starts_with("Check what is given of these features first"));
  p.c.explanations.list.back().shape = "one of them in time";
  CHECK(p.says().starts_with("The touches of one feature may only scatter"));
  p.c.explanations.list.back().shape = "size";
  p.c.baseline.surfaces = Surfaces::unknown;
  CHECK_FALSE(p.says().starts_with("Check"));
}

TEST_CASE("a feature that strays in one run alone is no wrong figure of a certificate") {
  LeavesMore p;
  p.find_pattern_over(Factor::feature);
  p.c.touches.features = {"BORE"};
  Matrix& shape = p.c.explanations.variants.back().signature;
  for (std::size_t k = 0; k < p.c.rows.size(); ++k) {
    TouchScene& scene = p.c.touches.touches[p.c.rows[k]].scene;
    scene.feature = 0, scene.run = 1 + static_cast<int>(k % 3);
    if (scene.run != 2) shape(static_cast<Eigen::Index>(k)) = 0;
  }
  CHECK(p.says().starts_with("BORE strays in run 2 alone, so that it is no property of the part"));
}

TEST_CASE("what was done already is not advised") {
  LeavesMore p;
  p.find_pattern_over(Factor::speed);
  CHECK(p.says().starts_with("Repeat at a third speed"));
  for (std::size_t i = 0; i < p.c.touches.touches.size(); ++i)
    p.c.touches.touches[i].scene.speed_mm_s = 3 + 3 * static_cast<double>(i % 3);
  CHECK(p.says().starts_with("Repeat at another acceleration"));

  LeavesMore turned;
  turned.find_pattern_over(Factor::direction);
  CHECK(turned.says().starts_with("Repeat with the part turned"));
  turned.scene(0).setup = 1, turned.scene(1).setup = 2;
  turned.scene(1).feature = turned.scene(0).feature, turned.recording.rows[1].touch = 1;
  turned.scene(0).normal = {1, 0, 0}, turned.scene(1).normal = {0, 1, 0};
  CHECK(turned.says().starts_with("The part stood turned in one of its placements"));
}

TEST_CASE("what the machine file has and these touches do not show is told where nothing was found") {
  LeavesMore p;
  EffectSetting step;
  step.name = "machine.step";
  step.parameters["amplitude_um"] = {5, 0.1, {}}, step.parameters["t0_s"] = {1e6, 0, {}};
  p.machine.effects = {step};
  const std::string told = "These touches cannot tell whether machine.step of the machine file is still there";
  CHECK_FALSE(p.says().starts_with(told));
  p.result.findings.clear();
  CHECK(p.says().starts_with(told));
  p.machine.effects[0].parameters["t0_s"] = {0, 0, {}};  // there in all of them, as another placement would be
  CHECK(p.says().starts_with(told));
  p.machine.effects[0].parameters["t0_s"] = {p.scene(p.count() / 2).time_s, 0, {}};
  CHECK_FALSE(p.says().starts_with(told));
}

TEST_CASE("where a placement is odd the part may have been warm in it") {
  LeavesMore p;
  p.find_pattern_over(Factor::setup);
  CHECK(p.says().find("temp_part_C") == std::string::npos);
  p.c.touches.known &= ~static_cast<unsigned>(Covariate::part_temperature);
  CHECK(p.says().find("log temp_part_C") != std::string::npos);
}

TEST_CASE("files of one run hide what is new in one of them") {
  LeavesMore p;
  const std::string told = "All files have the same run";
  CHECK(p.says(kDoubted).find(told) == std::string::npos);
  for (RecordedTouch& touch : p.c.touches.touches) touch.file = touch.row / 60;
  CHECK(p.says(kDoubted).find(told) != std::string::npos);
  CHECK(p.says().find(told) == std::string::npos);
  for (RecordedTouch& touch : p.c.touches.touches) touch.scene.run = 1 + touch.file;
  CHECK(p.says(kDoubted).find(told) == std::string::npos);
}

TEST_CASE("what explains a mismatch may be a pattern of the machine file that is there no more") {
  LeavesMore p;
  const std::string told = "no longer what its file has of empirical.curve";
  CHECK(p.says(kDoubted).find(told) == std::string::npos);
  const auto pattern_of = [](double
                                 um) {  // the same along every normal, as the wrong radius of the tip that was planted
    return EffectSetting{"empirical.curve", {{"from", {-1, 0, {}}}, {"to", {-0.5, 0, {}}}, {"r15_um", {um, 0, {}}}}};
  };
  p.machine.effects = {pattern_of(1), pattern_of(-3)};
  CHECK(p.says(kDoubted).find(told) != std::string::npos);
  p.machine.effects = {pattern_of(-1)};
  CHECK(p.says(kDoubted).find(told) == std::string::npos);
}

TEST_CASE("what the machine file has from some moment on may have been there from the start this time") {
  LeavesMore p;
  p.result.adequacy = 1;
  p.machine.effects = {{"probe.step", {{"amplitude_um", {4, 0.2, ""}}, {"t0_s", {167, 1, ""}}}}};
  CHECK(p.says().starts_with("The machine file has probe.step from 167 s after the start on"));
  p.machine.effects.front().parameters["t0_s"].value = 0;
  CHECK(p.says() == "");
}
