#include "engine/report/diagnosis/diagnosis_report.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

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
  CHECK_FALSE(says(diagnosis_text(d), "MPE"));
  d.worst_length = LengthError{120, -0.36e-3, 1.1e-3};
  CHECK(
      says(diagnosis_text(d), "; of lengths the third worst is off by 0.36 um over 120 mm, where the MPE is 1.10 um"));
  const auto worst = nlohmann::json::parse(diagnosis_json(d, "m"))["worst_length"];
  CHECK(worst["error_um"].get<double>() == doctest::Approx(-0.36));
  CHECK(worst["mpe_um"].get<double>() == doctest::Approx(1.1));
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
                           seen_from("noise.vibration", 0.9)};
  d.cannot_judge = {{"thermal.drift", {"time_s"}, {}}, {"noise.unequal", {"sensor"}, {}}};
  CHECK(diagnosis_sentences(d).size() == 3);
  CHECK(says(diagnosis_sentences(d)[1], "at the least 1.5 um (probe.tip_radius)"));  // scatter is another thing
  CHECK(
      says(diagnosis_sentences(d).back(),
           "Of the 2 effects that such touches can show, half would be seen from 1.5 um on at the latest, and the last "
           "one (machine.ram_droop) from 6.2 um on; 1 more cannot be judged."));
  for (const std::string& written : {diagnosis_text(d), diagnosis_html(d, "r.csv", "m.json")})
    CHECK(says(written, "use the machine file as it is"));
  for (const bool known : {false, true}) {
    d.baseline.known = known;
    CHECK(says(diagnosis_text(d), "What depends on the place alone") == !known);
  }
  CHECK(says(diagnosis_text(d), "what to do next:\n"));
  d.baseline.geometry_scale = 3;
  d.messages = {diagnostic(Code::W0723, "large", "measure calibrated lengths")};
  CHECK_FALSE(says(diagnosis_text(d), "as it is"));
  for (const Code doubt : {Code::W0723, Code::W0716, Code::W0720, Code::W0730}) {
    d.messages = {diagnostic(doubt, "doubted", "measure calibrated lengths")};
    CHECK(says(diagnosis_text(d), "what to do next:\n  Measure calibrated lengths.\n"));
  }

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
    CHECK(says(written, "1 touch left out, far from where the others predict it: SPH1 touch 7 (setup 1, run 1)"));
    CHECK(says(written, "--model-out writes the machine file with it,"));  // of one name there is no first
  }
}

TEST_CASE("a change that is the best for two questions is proposed once") {
  Diagnosis d = nothing_found();
  d.judged = Judged::plan;
  d.next_measurement = {{"repeat with probing speed 3 mm/s", "Run 2.", {"a.b", "c.d"}, 0.9, 40, ""},
                        {"repeat with the part clamped anew", "Run 3.", {"e.f", "g.h"}, 0.8, 50, ""},
                        {"repeat with probing speed 3 mm/s", "Run 2.", {"i.j", "k.l"}, 0.7, 40, ""}};
  const std::string said = diagnosis_text(d);
  CHECK(says(said,
             "  repeat with probing speed 3 mm/s (40 min): tells a.b / c.d apart with probability 0.90, and i.j / "
             "k.l apart with probability 0.70\n    Run 2.\n  repeat with the part clamped anew"));
  CHECK(said.find("Run 2.") == said.rfind("Run 2."));
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
  d.p_value = 0.052;
  CHECK(says(first_sentence(d), "by chance in 5.2 % of such recordings"));
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
  d.improvement->bias_before_um = 0.44, d.improvement->bias_after_um = 0.22;
  CHECK(
      says(third(20, 0.8),
           "had not seen it predicts better: rms of what is left 0.91 to 0.80 um, bias where it acts 0.44 to 0.22 um"));
  CHECK(says(third(3.5, 0.8),
             "it predicts better, though part of that may be chance"));  // two standard errors are 4 nats
  CHECK(says(third(20, 1.2), "something is there too, but not of the size"));
  CHECK(says(third(2, 0.8), "it predicts better, though part of that may be chance"));
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
  d.baseline.noisier = true;
  CHECK(says(first_sentence(d), "if its touches scatter 2.1 times as much as its file says:"));
  d.baseline.uneven = true;
  CHECK(says(first_sentence(d),
             "as its file says, and if one of its error functions, guides or rails is more uneven than the rest:"));
  d.baseline.noisier = false;
  CHECK(says(first_sentence(d), "specification reports if one of its error functions, guides or rails is more uneven"));
}

TEST_CASE("what the names leave, and lengths beyond the specification, are told in their sizes") {
  Diagnosis d = named();
  d.cannot_judge = {{"machine.squareness", {"time_s"}, {}}, {"thermal.drift", {"time_s"}, {}}};
  REQUIRE(open_questions(d).size() == 1);  // what was named is no open question
  CHECK(open_questions(d)[0].effect == "thermal.drift");
  d.verdict = Verdict::cannot_judge;
  CHECK(says(diagnosis_sentences(d)[1], "was not logged or did not change: machine.squareness (missing: time_s)."));
  d.adequacy_p = 0.005;
  CHECK(says(diagnosis_sentences(d)[1], "something else is at work"));
  d.adequacy_p = 0.03;
  CHECK(says(diagnosis_sentences(d)[1], "something else may be at work"));
  d = nothing_found();
  d.beyond = LengthError{500, -0.012, 0.0035};
  CHECK(says(first_sentence(d), "wrong by 12 um, where the specification allows 3.5 um"));
}

TEST_CASE("the table tells in which run a name is new") {
  Diagnosis d = named();
  d.effects.front().change = {{.from = 2}};
  CHECK(says(diagnosis_text(d), "machine.squareness, new in run 2"));
}

TEST_CASE("JSON has each figure under its own name") {
  Diagnosis d = named();
  DiagnosedEffect& e = d.effects.front();
  e.members = {"machine.squareness", "machine.scale"};
  e.change = {{.from = 2, .until = 4}, {.from = 3}};
  d.unexplained.emplace();
  d.unexplained->amplitude_um = 5, d.unexplained->low_um = 4, d.unexplained->high_um = 6;
  d.improvement = Improvement{"scheme", 20, 2, 0.91, 0.8, 0.44, 0.22, 3, 1.5};
  Detectable shows;
  shows.detect = 7, shows.name = 8, shows.detect_um = 1.5, shows.name_um = 2.5;
  d.smallest_detectable = {shows};
  d.beyond = LengthError{500, -0.012, 0.0035};
  JudgedValue v;
  v.unit = "mm", v.value = 100.002, v.reference = 100, v.deviation = 0.002, v.u = 0.001, v.z = 2.1, v.p = 0.04,
  v.low = -0.003, v.high = 0.0025;
  d.values = {v};
  const auto json = nlohmann::json::parse(diagnosis_json(d, "m"));
  CHECK(json["effects"][0]["new_in_run"] == nlohmann::json{2, 3});
  CHECK(json["effects"][0]["gone_in_run"] == nlohmann::json{4, nullptr});
  CHECK(json["unexplained"]["amplitude_um"]["interval95"] == nlohmann::json{4, 6});
  CHECK(json["improvement"]["rms_um"] == nlohmann::json{{"before", 0.91}, {"after", 0.8}});
  CHECK(json["improvement"]["bias_um"] == nlohmann::json{{"before", 0.44}, {"after", 0.22}});
  CHECK(json["improvement"]["chi2_per_dof"] == nlohmann::json{{"before", 3}, {"after", 1.5}});
  const auto& seen = json["smallest_detectable"][0];
  CHECK(seen["detect"] == 7);
  CHECK(seen["name"] == 8);
  CHECK(seen["detect_um"] == 1.5);
  CHECK(seen["name_um"] == 2.5);
  CHECK(json["length_beyond_mpe"]["error_um"] == doctest::Approx(-12));
  CHECK(json["length_beyond_mpe"]["mpe_um"] == doctest::Approx(3.5));
  CHECK(json["values"][0]["lcl"] == -0.003);
  CHECK(json["values"][0]["ucl"] == 0.0025);
  CHECK(json["p_value"] == 1e-6);
  d.judged = Judged::targets_only;
  CHECK(nlohmann::json::parse(diagnosis_json(d, "m"))["p_value"].is_null());
}

TEST_CASE("a machine file keeps what is not superseded, and gets what was found") {
  Diagnosis d = named();
  d.superseded = {0, 2};
  d.model_effects = {{"machine.squareness", {{"squareness_urad", {12, 1.5, ""}}, {"plane", {0, 0, "xy"}}}}};
  d.known_state = "{\"touches\": 225}";
  const auto machine = nlohmann::json::parse(
      improved_machine(R"({"name": "m", "effects": [{"name": "a"}, {"name": "b"}, {"name": "c"}, {"name": "d"}]})", d));
  REQUIRE(machine["effects"].size() == 3);
  CHECK(machine["effects"][0]["name"] == "b");
  CHECK(machine["effects"][1]["name"] == "d");
  CHECK(machine["effects"][2]["parameters"]["squareness_urad"] == nlohmann::json{{"value", 12}, {"u", 1.5}});
  CHECK(machine["effects"][2]["parameters"]["plane"] == "xy");
  CHECK(machine["known_state"]["touches"] == 225);
}

TEST_CASE("values and residuals are drawn in their units") {
  Diagnosis d = named();
  d.improvement.emplace();
  d.improvement->bias_before_um = 0.44, d.improvement->bias_after_um = 0.22;
  d.residuals.resize(2);
  for (ResidualRow& r : d.residuals) r.before_um = 1;
  d.residuals[1].time_s = 600;  // from 0 to 10 minutes
  std::string page = diagnosis_html(d, "r.csv", "m.json");
  CHECK(says(page, "<td class=\"n\">0.44</td><td class=\"n\">0.22</td>"));
  CHECK(says(page, ">10</text>"));
  CHECK(says(page, "cy=\"86.0\""));  // nothing is left of them: the middle of the second plot, from 24 to 148
  d.residuals.clear();
  JudgedValue v;
  v.characteristic = "A1", v.program = "p.dmi", v.unit = "deg";
  v.deviation = 0.001, v.low = -0.002, v.high = 0.002;  // 3.6 seconds of arc of 7.2
  d.values = {v};
  page = diagnosis_html(d, "v.csv", "m.json");
  CHECK(says(page, "deviation, arcsec"));
  CHECK(says(page, ">6</text>"));
  CHECK(says(page, "r=\"3.5\" fill=\"#0072B2\""));
  d.values[0].deviation = 0.003;
  CHECK(says(diagnosis_html(d, "v.csv", "m.json"), "r=\"3.5\" fill=\"#D55E00\""));
  CHECK(says(diagnosis_text(d), "    -0.00200 to   0.00200 "));
}
