#include "engine/report/diagnosis/diagnosis_report.hpp"

#include <doctest/doctest.h>

using namespace abbe;

namespace {

Diagnosis nothing_found() {
  Diagnosis d;
  d.touches = 225;
  d.p_value = 0.5;
  return d;
}

Diagnosis named() {
  Diagnosis d = nothing_found();
  d.verdict = Verdict::named;
  d.p_value = 1e-6;
  DiagnosedEffect e;
  e.members = {"machine.squareness"};
  e.probability = 0.9;
  d.effects.push_back(e);
  return d;
}

std::string first_sentence(const Diagnosis& d) { return diagnosis_sentences(d).front(); }

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a recording that agrees says with which machine") {
  Diagnosis d = nothing_found();
  CHECK(says(first_sentence(d), "225 touches are what a machine of this specification reports"));
  d.baseline.geometry_scale = 3.8;
  CHECK(says(first_sentence(d), "geometric errors are 3.8 times those of its specification, or rougher: a difference"));
  CHECK(says(diagnosis_text(d), "baseline: 3.80 times the machine's errors of its specification, noise"));
  d.baseline.rougher = d.baseline.uneven = true;
  CHECK(says(diagnosis_text(d), "specification, rougher than harmonics, in part more uneven than the rest, noise"));
  d.baseline.known = true;
  CHECK(says(first_sentence(d), "what this machine reports as its file knows it"));
}

TEST_CASE("that it is another machine comes first, in the text and on the page, beside a name too") {
  for (Diagnosis d : {nothing_found(), named()}) {
    CHECK_FALSE(says(first_sentence(d), "not the machine that its file knows"));
    CHECK_FALSE(says(diagnosis_html(d, "r.csv", "m.json"), "<h1>Not the machine that its file knows</h1>"));
    d.baseline.known = true;
    d.beyond_known = 4.2;
    CHECK(says(first_sentence(d), "not the machine that its file knows"));
    CHECK(says(diagnosis_html(d, "r.csv", "m.json"), "<h1>Not the machine that its file knows</h1>"));
  }
}

TEST_CASE("whatever is found, there are three sentences, a table and what to do next") {
  Diagnosis d = nothing_found();
  const auto seen_from = [](const char* effect, double detect_um) {
    Detectable seen;
    seen.effect = effect, seen.detect_um = detect_um;
    seen.scatter = seen.effect.starts_with("noise.");
    return seen;
  };
  d.smallest_detectable = {seen_from("machine.ram_droop", 6.2), seen_from("probe.tip_radius", 1.5),
                           seen_from("noise.vibration", 9)};
  d.cannot_judge = {{"thermal.drift", {"time_s"}, {}}};
  CHECK(diagnosis_sentences(d).size() == 3);
  CHECK(
      says(diagnosis_sentences(d).back(),
           "Of the 2 effects that such touches can show, half would be seen from 1.5 um on at the latest, and the last "
           "one (machine.ram_droop) from 6.2 um on; 1 more cannot be judged."));
  for (const std::string& written : {diagnosis_text(d), diagnosis_html(d, "r.csv", "m.json")})
    CHECK(says(written, "use the machine file as it is"));
  CHECK(says(diagnosis_text(d), "what to do next:\n"));
  d.baseline.geometry_scale = 3;
  d.messages = {diagnostic(Code::W0723, "large", "measure calibrated lengths")};
  CHECK_FALSE(says(diagnosis_text(d), "as it is"));
  CHECK(says(diagnosis_text(d), "what to do next:\n  Measure calibrated lengths.\n"));

  Diagnosis scatter = named();
  scatter.effects.front().members = {"noise.vibration"};
  scatter.effects.front().sentence = "It is explained by vibration.";
  REQUIRE(diagnosis_sentences(scatter).size() == 3);  // repeats agree: no machine file carries it
  CHECK_FALSE(says(diagnosis_sentences(scatter).back(), "results are less certain"));
  scatter.model_effects = {{"noise.vibration", {}}};
  CHECK(says(diagnosis_sentences(scatter).back(), "results are less certain"));
}

TEST_CASE("a page speaks of an explanation only where there is one") {
  Diagnosis d = nothing_found();
  d.residuals.resize(2);
  d.residuals[0].x_mm = 1, d.residuals[0].before_um = 1;
  CHECK(says(diagnosis_html(d, "r.csv", "m.json"), "<h2>Residuals</h2>"));
  CHECK_FALSE(says(diagnosis_html(d, "r.csv", "m.json"), "with the explanation in it"));
  CHECK_FALSE(says(diagnosis_html(d, "r.csv", "m.json"), ">before<"));
  d.improvement.emplace();
  CHECK(says(diagnosis_html(d, "r.csv", "m.json"), "with the explanation in it"));
  CHECK(says(diagnosis_html(d, "r.csv", "m.json"), ">before<"));
}

TEST_CASE("text and page say which touches were left out, and what to do with a model") {
  Diagnosis d = named();
  d.baseline.outliers = {"SPH1 touch 7 (setup 1, run 1)"};
  d.model_effects = {{"machine.squareness", {}}};
  for (const std::string& written : {diagnosis_text(d), diagnosis_html(d, "r.csv", "m.json")}) {
    CHECK(says(written, "1 touch left out: SPH1 touch 7 (setup 1, run 1)"));
    CHECK(says(written, "--model-out writes the machine file with it"));
  }
}

TEST_CASE("each name of a set has its own probability and size") {
  Diagnosis d = named();
  d.verdict = Verdict::one_of;
  DiagnosedEffect& e = d.effects.front();
  e.members = {"machine.squareness", "machine.scale"};
  e.parameters = {{.name = "squareness_urad", .unit = "urad", .value = 12, .u = 1, .low = 10, .high = 14}};
  e.by_member = {{0.6, e.parameters, {}},
                 {0.3, {{.name = "scale_um_per_m", .unit = "um/m", .value = -5, .u = 0.5, .low = -6, .high = -4}}, {}}};
  d.model_effects = {{"machine.squareness", {}}};
  const std::string text = diagnosis_text(d), page = diagnosis_html(d, "r.csv", "m.json");
  for (const std::string& told : {text, page}) {
    CHECK(says(told, "one of these"));
    CHECK(says(told, "squareness 12.0 urad (10.0 to 14.0)"));
    CHECK(says(told, "scale -5.0 um/m (-6.0 to -4.0)"));
  }
  CHECK(says(text, "machine.scale                          0.30"));
  CHECK(says(text, "(of several names, with the first)"));
}

TEST_CASE("a chance has no more digits than simulations give") {
  Diagnosis d = nothing_found();
  d.p_value = 1;
  CHECK(says(first_sentence(d), "by chance in nearly all of such recordings"));
  d.p_value = 1 / 2682.0;
  d.verdict = Verdict::named;
  CHECK(says(first_sentence(d), "by chance it would look so in 1 in 2700 of such recordings"));
}

TEST_CASE("touches are predicted better only where less of them is left") {
  Diagnosis d = named();
  d.improvement.emplace();
  const auto third = [&](double gain, double rms_after_um) {
    d.improvement->log_score_gain = gain, d.improvement->se = 2;
    d.improvement->rms_before_um = 0.91, d.improvement->rms_after_um = rms_after_um;
    return diagnosis_sentences(d).back();
  };
  CHECK(says(third(20, 0.8), "had not seen it predicts better: "));
  CHECK(says(third(20, 1.2), "something is there too, but not of the size"));
  CHECK(says(third(2, 0.8), "it predicts better, though not beyond doubt"));
  CHECK(says(third(2, 1.28), "it does not predict better"));
  CHECK(says(third(-2, 0.8), "it cannot be told whether it predicts better"));
  CHECK(says(third(-20, 0.8), "it comes closer, but errs by more than it says that it may"));
  CHECK(says(third(-20, 1.2), "it predicts worse"));
}

TEST_CASE("what a machine file carries of a pattern, and of names beside it, is said") {
  Diagnosis d = named();
  d.unexplained.emplace();
  d.model_effects = {{"machine.squareness", {}}};
  std::string steps = diagnosis_text(d);
  CHECK(says(steps, "No machine file can carry this pattern"));
  CHECK(says(steps, "To reckon with what has a name until it is mended: --model-out writes"));
  d.unexplained->model = "empirical.curve";
  steps = diagnosis_text(d);
  CHECK_FALSE(says(steps, "No machine file can carry this pattern"));
  CHECK(says(steps, "To reckon with it until it is mended: --model-out writes"));
  d.unexplained->model_follows = "time";
  CHECK(says(diagnosis_text(d), "To reckon with what of it follows time alone until it is mended: --model-out writes"));
}

TEST_CASE("the noise stands beside that of the machine file") {
  Diagnosis d = nothing_found();
  d.baseline.noise_um = 1.06, d.baseline.stated_noise_um = 0.5;
  CHECK(says(baseline_in_words(d), "noise 1.06 um (0.50 in the machine file)"));
}
