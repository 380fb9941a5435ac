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
  }
  void miss(const char* effect, Covariate what, bool logged) {
    const auto missing = static_cast<unsigned>(what);
    c.explanations.unjudged.push_back({find_effect(effect), missing, logged ? missing : 0});
    if (!logged) c.touches.known &= ~missing;
  }
  /// Instead of the tip's radius: a pattern over a factor.
  void find_pattern_over(Factor factor) {
    result.findings.clear();
    c.explanations.list.emplace_back().factor = factor;
    result.other = Finding{};
    result.other->explanation = static_cast<int>(c.explanations.list.size()) - 1;
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
  p.c.baseline.surfaces = Surfaces::unknown;
  CHECK_FALSE(p.says().starts_with("Check"));
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
