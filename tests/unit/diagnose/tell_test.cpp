// What was found is told with what is believed of it, and gets into the machine file where it may.
#include "engine/diagnose/findings/tell.hpp"

#include <doctest/doctest.h>

#include <tuple>

#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/caveats.hpp"
#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// A recording whose tip is so much larger than assumed, found; `out`: what predicts touches left out better.
struct Told : Planted {
  Diagnosis out;

  explicit Told(double radius_um = 1.2) : Planted(1) {
    plant("probe.tip_radius", {radius_um, 0});
    find({"probe.tip_radius"});
    out.improvement = Improvement{"leave-one-setup-out", 20, 4};
  }
  const DiagnosedEffect& tell() {
    tell_findings(c, result, out);
    REQUIRE(out.effects.size() == 1);
    return out.effects[0];
  }
  bool says(std::string_view text) const { return out.effects.at(0).sentence.find(text) != std::string::npos; }
};

double amplitude(const Diagnosis& d) { return d.model_effects.at(0).parameters.at("amplitude_um").value; }

}  // namespace

TEST_CASE("a name that nothing speaks against is believed, and goes into the machine file") {
  Told t;
  const DiagnosedEffect& e = t.tell();
  CHECK(e.members == std::vector<std::string>{"probe.tip_radius"});
  CHECK(e.probability > kTold);
  CHECK(e.sentence.starts_with("It is explained by tip radius other than assumed: amplitude "));
  REQUIRE(t.out.model_effects.size() == 1);
  CHECK(t.out.model_effects[0].name == "probe.tip_radius");
  CHECK(amplitude(t.out) == e.parameters[0].value);
  CHECK(t.out.superseded.empty());
}

TEST_CASE("a doubted name is believed by half at most") {
  const auto doubted = [](auto change) {
    Told t;
    change(t);
    return t.tell().probability == kDoubted;
  };
  CHECK_FALSE(doubted([](Told&) {}));
  CHECK(doubted([](Told& t) { t.out.improvement.reset(); }));
  CHECK(doubted([](Told& t) { t.out.improvement->se = 21; }));
  CHECK(doubted([](Told& t) { t.result.adequacy = kInadequate / 2; }));
  CHECK(doubted([](Told& t) { t.result.other = t.result.findings.front(); }));
  CHECK(doubted([](Told& t) { t.out.baseline.geometry_scale = kLargeErrors; }));
  CHECK_FALSE(doubted([](Told& t) { t.out.baseline.geometry_scale = kLargeErrors, t.out.baseline.known = true; }));
  CHECK(doubted([](Told& t) { t.c.explanations.list[0].missing = 1; }));
  CHECK(doubted([](Told& t) { t.c.step_um = 5; }));  // rounding makes as much, with this machine's quiet probe
}

TEST_CASE("what the machine file has already is told beside it, or as gone") {
  Told more, gone, none;
  const EffectSetting half{"probe.tip_radius", {{"amplitude_um", {0.6, 0.05, ""}}}};
  more.machine.effects = {{"probe.cosine_error", {}}, half};
  more.tell();
  CHECK(more.says("That is beside what the machine file has of it."));
  CHECK(more.out.superseded == std::vector<std::size_t>{1});
  CHECK(amplitude(more.out) == doctest::Approx(0.6 + more.out.effects[0].parameters[0].value));

  gone.machine.effects = {half};
  gone.machine.effects[0].parameters["amplitude_um"].value = -gone.tell().parameters[0].value;
  none.machine.effects = gone.machine.effects;
  none.tell();
  CHECK(none.says("The machine file has the opposite: it is not there any more."));
  CHECK(none.out.model_effects.empty());
  CHECK(none.out.superseded == std::vector<std::size_t>{0});
}

TEST_CASE("what no machine file may carry is not in it") {
  Told large(2000);
  large.tell();
  CHECK(large.says("No such effect has such a size"));
  CHECK(large.out.model_effects.empty());
  CHECK_FALSE(large.out.effects[0].parameters[0].plausible);

  Told rounded;
  rounded.c.step_um = 5;
  rounded.tell();
  CHECK(rounded.says("record the digits that the machine has"));
  CHECK(rounded.out.model_effects.empty());
}

TEST_CASE("why a name is believed by half is said where nothing else says it") {
  const auto says_so = [](auto change) {
    Told t;
    change(t);
    t.tell();
    return t.says("predicted better by no more than chance may do");
  };
  CHECK_FALSE(says_so([](Told&) {}));
  CHECK(says_so([](Told& t) { t.out.improvement->se = 21; }));
  CHECK(says_so([](Told& t) { t.out.improvement.reset(); }));
  CHECK_FALSE(says_so([](Told& t) { t.out.improvement->se = 21, t.result.adequacy = kInadequate / 2; }));
}

TEST_CASE("a swing that was recorded less than twice is believed by half at most") {
  for (const double cycles : {1.5, 4.0}) {
    Planted p(1);
    const double azimuth_deg = 30, elevation_deg = 60, any_direction = 3;
    p.plant("thermal.cycle", {2, lasts_s(p.c.touches) / cycles, 40, any_direction, azimuth_deg, elevation_deg});
    p.find({"thermal.cycle"});
    Diagnosis out;
    out.improvement = Improvement{"leave-one-fifth-out", 20, 4};
    tell_findings(p.c, p.result, out);
    REQUIRE(out.effects.size() == 1);
    const bool once = cycles < 2;
    CHECK((out.effects[0].probability == kDoubted) == once);
    CHECK((out.effects[0].sentence.find("Fewer than two periods of it were recorded") != std::string::npos) == once);
  }
}

TEST_CASE("a change between runs in one placement takes for granted that the part lay still") {
  for (const bool same_setup : {true, false}) {
    Planted p(2);
    for (int i = 0; i < p.count(); ++i) {
      p.scene(i).run = i < 60 ? 1 : 2, p.scene(i).setup = same_setup ? 1 : p.scene(i).run;
      p.c.model.y(i) += i < 60 ? 0 : 1.5;
    }
    p.find({"probe.tip_radius"});
    Diagnosis out;
    out.improvement = Improvement{"leave-one-setup-out", 20, 4};
    tell_findings(p.c, p.result, out);
    REQUIRE(out.effects.size() == 1);
    CHECK(out.effects[0].change[0].from == 2);
    CHECK((out.effects[0].sentence.find("give them different setups") != std::string::npos) == same_setup);
  }
}

TEST_CASE("scatter is told with its place where nothing else was, and counts in the p-value") {
  Planted p(3);
  NoiseFinding noise{find_effect("noise.vibration"),
                     1e-6,
                     {{.name = "sd_um", .unit = "um", .value = 1, .u = 0.1}},
                     "Touches along y scatter."};
  noise.factor = Factor::direction, noise.where = {{"normal", "along y"}};
  Diagnosis sure, unsure, beside;
  tell_noise(p.c, {noise}, sure);
  REQUIRE(sure.effects.size() == 1);
  CHECK(sure.effects[0].probability > kTold);
  CHECK(sure.effects[0].sentence == "Touches along y scatter.");
  CHECK(sure.location.at(0).factor == "direction");
  CHECK(sure.p_value == 1e-6);
  CHECK(sure.model_effects.at(0).name == "noise.vibration");

  noise.certain = false;
  tell_noise(p.c, {noise}, unsure);
  CHECK(unsure.effects.at(0).probability == kDoubted);
  CHECK(unsure.effects[0].sentence.find("Repeats of the same touches would tell") != std::string::npos);

  beside.p_value = 1e-9;
  beside.effects.emplace_back();
  tell_noise(p.c, {noise}, beside);
  CHECK(beside.location.empty());
  CHECK(beside.p_value == 1e-9);
}

TEST_CASE("no repeats are asked for where there are enough of them") {
  Planted p(3);
  NoiseFinding noise{find_effect("noise.vibration"),
                     1e-6,
                     {{.name = "sd_um", .unit = "um", .value = 1, .u = 0.1}},
                     "Touches scatter."};
  noise.certain = false;
  for (const auto& [repeats, says, carried] :
       {std::tuple{Repeats::agree, "repeats of the same touches agree: it is no scatter", std::size_t{0}},
        std::tuple{Repeats::differ, "Repeats of the same touches differ", std::size_t{1}}}) {
    noise.repeats = repeats;
    Diagnosis out;
    tell_noise(p.c, {noise}, out);
    CHECK(out.effects.at(0).sentence.find(says) != std::string::npos);
    CHECK(out.effects[0].sentence.find("Repeats of the same touches would tell") == std::string::npos);
    CHECK(out.model_effects.size() == carried);
  }
}

TEST_CASE("scatter of an impossible size is doubted as any other name is") {
  Planted p(5);
  NoiseFinding dirt{
      find_effect("noise.outliers"), 1e-12, {{.name = "share", .unit = "", .value = 1.5, .u = 0.01}}, "Dirt."};
  Diagnosis out;
  tell_noise(p.c, {dirt}, out);
  CHECK(out.effects.at(0).probability == kDoubted);
  CHECK(out.effects[0].sentence.find("No such effect has such a size") != std::string::npos);
  CHECK(out.model_effects.empty());
}

TEST_CASE("of each of two effects that are gone it is said") {
  Told of;
  of.find({"probe.tip_radius", "machine.scale"});
  Finding second = of.result.findings.at(0);
  second.explanation = 1, second.set = {1}, second.variant = of.c.explanations.list[1].variants[0];
  of.result.findings[0].set = {0};
  of.result.findings.push_back(second);
  for (int i = of.count() / 2; i < of.count(); ++i) of.scene(i).run = 2;
  for (const Finding& f : of.result.findings) of.c.explanations.variants[f.variant].change = {0, 2};
  tell_findings(of.c, of.result, of.out);
  REQUIRE(of.out.effects.size() == 2);
  for (const DiagnosedEffect& e : of.out.effects) CHECK(e.sentence.find(" It is gone: ") != std::string::npos);
}

TEST_CASE("what is gone must have been looked for") {
  for (const bool again : {true, false}) {
    Told of;
    for (int i = 0; i < of.count(); ++i) {
      TouchScene& s = of.scene(i);
      s.run = i < of.count() / 2 ? 1 : 2;
      s.stylus.tip_ordinal = again ? 1 : s.run;
    }
    Variant& variant = of.c.explanations.variants[of.result.findings[0].variant];
    variant.change = {0, 2};
    for (int i = of.count() / 2; i < of.count(); ++i) variant.signature.row(i).setZero();
    tell_findings(of.c, of.result, of.out);
    CHECK(of.says("It is gone: the machine file needs nothing of it") == again);
    CHECK(of.says("no orientation in which it was there was touched since") != again);
    CHECK(of.out.model_effects.empty() == again);
  }
}

TEST_CASE("the verdict is the worst of what was found") {
  Planted p(4);
  p.plant("probe.tip_radius", {1.2, 0});
  p.find({"probe.tip_radius", "machine.scale"});
  Diagnosis d;
  p.result.findings[0].set = {0};
  CHECK(verdict_of(p.c, p.result, d) == Verdict::named);
  p.result.findings[0].set = {0, 1};
  CHECK(verdict_of(p.c, p.result, d) == Verdict::one_of);
  p.c.explanations.list[0].missing = 1;
  CHECK(verdict_of(p.c, p.result, d) == Verdict::cannot_judge);
  p.result.other.emplace();
  CHECK(verdict_of(p.c, p.result, d) == Verdict::unexplained);
  p.result.other.reset(), p.result.findings.clear();
  CHECK(verdict_of(p.c, p.result, d) == Verdict::no_mismatch);
  d.effects.emplace_back();  // scatter
  CHECK(verdict_of(p.c, p.result, d) == Verdict::named);
}

TEST_CASE("what holds for several effects is said once") {
  const std::vector<DiagnosedEffect> none, first(1, {{"part.clamping"}, 1, {}, "It is bent. It is of this part."});
  CHECK(unless_said(none, " It is of this part.") == " It is of this part.");
  CHECK(unless_said(first, " It is of this part.") == "");
  CHECK(unless_said(first, " It is gone.") == " It is gone.");
  CHECK(unless_said(first, "") == "");
}

TEST_CASE("at one temperature the error of a sensor is told beside that of a coefficient") {
  const auto told = [](double second_K) {
    Told t;
    for (int i = 0; i < t.count(); ++i) {
      TouchScene& s = t.scene(i);
      s.on_part = s.point;
      s.temperature.part = i % 2 ? 21 : second_K;
    }
    t.plant("thermal.part_expansion", {12, 0, 11.5, 0, 0, 0, 0});
    t.find({"thermal.part_expansion"});
    return t.tell().sentence;
  };
  const std::string sentence = told(21);
  REQUIRE(sentence.find("Here temperature error ") != std::string::npos);
  const double K = std::stod(sentence.substr(sentence.find("Here temperature error ") + 23));
  CHECK(K == doctest::Approx(12 / 11.5).epsilon(0.1));
  CHECK(told(24).find("would do nearly the same") == std::string::npos);
}

TEST_CASE("a size that goes by what nobody logged is no figure for a machine file") {
  Told t;
  t.c.touches.known &= ~static_cast<unsigned>(Covariate::load);
  const Effect& bending = *find_effect("part.load_bending");
  Variant variant;
  variant.columns = {{0, 0, 1, true}};
  const std::string parameter(bending.parameters[0].name);
  CHECK(whose_surroundings(t.c, bending, variant, {{.name = parameter}}).find("no load_kg") != std::string::npos);
  CHECK(whose_surroundings(t.c, bending, variant, {}).empty());  // another one is told
  t.c.touches.known |= static_cast<unsigned>(Covariate::load);
  t.c.touches.varying &= ~static_cast<unsigned>(Covariate::load);
  CHECK(whose_surroundings(t.c, bending, variant, {{.name = parameter}}).find("load_kg is the same throughout") !=
        std::string::npos);
  variant.columns[0].assumed = false;
  CHECK(whose_surroundings(t.c, bending, variant, {{.name = parameter}}).empty());
}

TEST_CASE("a part that is placed anew for a run has not moved since the run before") {
  Case c;
  for (const auto& [run, setup] : {std::pair(1, 1), {2, 1}, {3, 2}, {4, 2}}) {
    c.rows.push_back(static_cast<int>(c.touches.touches.size()));
    TouchScene& scene = c.touches.touches.emplace_back().scene;
    scene.run = run, scene.setup = setup;
  }
  CHECK(begins_within_a_setup(c, {.from = 2}));
  CHECK_FALSE(begins_within_a_setup(c, {.from = 3}));
  CHECK(begins_within_a_setup(c, {.from = 3, .until = 4}));
}
