// What a workpiece does to measured values: the true part for the reference, what is uncertain of
// it for virtual machines.
#include "engine/run/part.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

Workpiece workpiece(const std::string& members) {
  return parse_workpiece(SourceFile("w.json", R"({"schema": "abbe.workpiece/1", "name": "w", )" + members + "}"));
}

Arguments nominal_zero() {
  Arguments a;
  a.add_text("mode", "NOMINL");
  a.add_number("nominal", 0);
  a.add_number("lower", -1);
  a.add_number("upper", 1);
  return a;
}

/// The length between F0 and F1, 500 mm apart along x; `tecomp` as the program switches it.
plan::Plan length(std::optional<bool> tecomp = {}) {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  if (tecomp) b.append(plan::SetTemperatureCompensation{*tecomp});
  const auto p = b.point({500, 500, -500}, {-1, 0, 0}), q = b.point({1000, 500, -500}, {1, 0, 0});
  Arguments a = nominal_zero();
  a.add_text("axis", "XAXIS");
  b.evaluate({p, q}, "DISTB", a);
  return b.plan;
}

/// The diameter of a circle F0 of 40 mm, touched at twelve points.
plan::Plan circle(bool inner) {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  Element nominal;
  nominal.point = {800, 500, -500};
  nominal.size = 20;
  const auto id = b.feature(Shape::circle, nominal);
  b.plan.features[id.value].inner = inner;
  b.append(plan::BeginMeasure{id});
  for (int k = 0; k < 12; ++k) {
    const Vec3 out{std::cos(k * kPi / 6), std::sin(k * kPi / 6), 0};
    b.append(plan::Touch{id, constant(nominal.point + 20 * out), constant(inner ? -out : out), true});
  }
  b.append(plan::EndMeasure{id});
  b.evaluate({id}, "DIAM", nominal_zero());
  b.evaluate({id}, "CIRLTY", [] {
    Arguments a;
    a.add_number("upper", 1), a.add_number("zone", 1);
    return a;
  }());
  return b.plan;
}

RunResult run(const plan::Plan& plan, const Workpiece& w, int machines, bool part = true) {
  static const Machine machine = read_machine("coord3-mc16");
  RunOptions options;
  options.contributors.geometry = options.contributors.head = options.contributors.probe = false;
  options.contributors.part = part;
  options.workpiece = &w;
  return run_plan(plan, machine, screened_machines(machine, 1, machines, 2), options, no_source());
}

std::vector<double> lengths(const Workpiece& w, int machines, bool part = true) {
  return run(length(), w, machines, part).samples[0].value;
}

struct Moments {
  double mean = 0, sd = 0;
};
Moments moments(const std::vector<double>& x) {
  Moments m;
  for (const double v : x) m.mean += v / static_cast<double>(x.size());
  for (const double v : x) m.sd += (v - m.mean) * (v - m.mean) / static_cast<double>(x.size() - 1);
  m.sd = std::sqrt(m.sd);
  return m;
}

std::string faults(const plan::Plan& plan, const Workpiece& w) {
  try {
    Part(w, plan);
  } catch (const UserError& error) {
    return render(error.diagnostics().front());
  }
  return "";
}

}  // namespace

TEST_CASE("a steel part of 500 mm is 5.75 um longer at 21 degrees C") {
  const Workpiece warm = workpiece(R"("material": {"cte_ppm_per_K": 11.5}, "temperature": {"part_C": 21})");
  const RunResult r = run(length(), warm, 3);
  CHECK(r.samples[0].reference.value() == doctest::Approx(500).epsilon(1e-14));
  for (const double v : r.samples[0].value) CHECK(std::fabs(v - 500.00575) < 1e-9);
  // Only the difference to the scales counts: steel scales at the same temperature give the right
  // length.
  const Workpiece alike = workpiece(
      R"("material": {"cte_ppm_per_K": 11.5}, "scales": {"cte_ppm_per_K": 11.5}, "temperature": {"part_C": 21, "scale_C": 21})");
  for (const double v : lengths(alike, 3)) CHECK(std::fabs(v - 500) < 1e-9);
  for (const double v : lengths(warm, 3, false)) CHECK(std::fabs(v - 500) < 1e-9);
}

TEST_CASE("compensation removes the expansion and leaves what it does not know") {
  // u(L) = L sqrt((a u_s)^2 + (dT u_a)^2) with a sensor good to 0.1 K, 5 K above 20 and a
  // coefficient good to 0.5 ppm/K: 500 mm (1.15 and 2.5 um/m) = 1.376 um. 4000 machines: u to 1.1
  // %; six standard errors, false alarm 2e-9.
  const std::string members =
      R"("material": {"cte_ppm_per_K": {"value": 11.5, "u": 0.5}}, "temperature": {"part_C": 25},
                                 "compensation": {"sensor_K": {"value": 0, "u": 0.1}, "on": )";
  const Workpiece on = workpiece(members + "true}"), off = workpiece(members + "false}");
  constexpr int n = 4000;
  const double u_mm = 500 * std::hypot(11.5e-6 * 0.1, 5 * 0.5e-6);
  const Moments compensated = moments(lengths(on, n));
  CHECK(std::fabs(compensated.mean - 500) < 6 * u_mm / std::sqrt(n));
  CHECK(std::fabs(compensated.sd / u_mm - 1) < 6 / std::sqrt(2.0 * n));
  const double expansion_mm = 500 * 11.5e-6 * 5, u_off_mm = 500 * 5 * 0.5e-6;
  CHECK(std::fabs(moments(lengths(off, n)).mean - 500 - expansion_mm) < 6 * u_off_mm / std::sqrt(n));
  // TECOMP of the program wins over the file.
  CHECK(run(length(true), off, 5).samples[0].value == run(length(), on, 5).samples[0].value);
  CHECK(run(length(false), on, 5).samples[0].value == run(length(), off, 5).samples[0].value);
}

TEST_CASE("the reference is the true value, and machines add what is not known of it") {
  const Workpiece w = workpiece(R"("surfaces": {"f1": {"offset_um": {"value": 3, "u": 0.5}}})");
  constexpr int n = 4000;
  const RunResult r = run(length(), w, n);
  CHECK(r.samples[0].reference.value() == doctest::Approx(500.003).epsilon(1e-14));
  const Moments m = moments(r.samples[0].value);
  CHECK(std::fabs(m.mean - 500.003) < 6 * 0.0005 / std::sqrt(n));
  CHECK(std::fabs(m.sd / 0.0005 - 1) < 6 / std::sqrt(2.0 * n));
  for (const double v : lengths(w, 3, false)) CHECK(v == doctest::Approx(500.003).epsilon(1e-14));
}

TEST_CASE("a position about datums is the same in every coordinate system") {
  // x starts at the face F0, which lies 10 um beside its nominal; the hole F1 and the datum F2 lie where they should.
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  b.plan.frames = {{"FACE"}};
  const auto face = b.point({700, 500, -500}, {-1, 0, 0});
  std::vector<plan::FeatureId> holes;
  for (const double x : {800.0, 860.0}) {
    const Element nominal{.point = {x, 500, -500}, .direction = {0, 0, 1}, .size = 20};
    holes.push_back(b.feature(Shape::circle, nominal));
    b.append(plan::BeginMeasure{holes.back()});
    for (const Vec3 out : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}})
      b.append(plan::Touch{holes.back(), constant(nominal.point + 20 * out), constant(out), true});
    b.append(plan::EndMeasure{holes.back()});
  }
  Arguments alone;
  alone.add_number("zone", 1), alone.add_text("space", "2D");
  Arguments about = alone;
  about.add_feature("datum", holes[1].value);
  b.append(plan::TranslateFrame{{0}, {{Axis::x, face, {}}}});
  b.evaluate({holes[0]}, "POS", alone);
  b.evaluate({holes[0]}, "POS", about);
  const RunResult r = run(b.plan, workpiece(R"("surfaces": {"F0": {"offset_um": 10}})"), 1);
  CHECK(r.samples[0].reference.value() == doctest::Approx(0.02).epsilon(1e-9));  // 10 um off on one side
  CHECK(r.samples[1].reference.value() < 1e-9);
}

TEST_CASE("a diameter is the same for a bore and a shaft") {
  for (const bool inner : {false, true}) {
    CAPTURE(inner);
    CHECK(run(circle(inner), workpiece(R"("surfaces": {"F0": {"diameter_mm": 40.01}})"), 1).samples[0].reference ==
          doctest::Approx(40.01).epsilon(1e-12));
    CHECK(
        run(circle(inner), workpiece(R"("surfaces": {"F0": {"diameter_deviation_um": -4}})"), 1).samples[0].reference ==
        doctest::Approx(39.996).epsilon(1e-12));
    CHECK(run(circle(inner), workpiece(R"("surfaces": {"F0": {"offset_um": 1}})"), 1).samples[0].reference ==
          doctest::Approx(inner ? 39.998 : 40.002).epsilon(1e-12));
  }
}

TEST_CASE("a diameter that a variable gives is known when the feature is touched") {
  plan::Plan varying = circle(false);
  plan::FeatureDef& def = varying.features[0];
  for (const auto& [name, value] : {std::pair{"x", 800.0}, {"y", 500.0}, {"z", -500.0}, {"k", 1.0}, {"diam", 0.0}})
    def.arguments.add_number(name, value);
  def.varying = {{"diam", 0, plan::ColumnId{0}}}, def.nominal = {};
  varying.columns = 1;
  varying.operations.insert(varying.operations.begin(), {plan::Assign{{0}, {plan::PushConstant{40}}}, {}, 0});
  CHECK(run(varying, workpiece(R"("surfaces": {"F0": {"diameter_mm": 40.01}})"), 1).samples[0].reference ==
        doctest::Approx(40.01).epsilon(1e-12));
}

TEST_CASE("a label that is defined again is on the same surface, seen from its own side and size") {
  // A bore of 40 mm, then a plug of 40.004 mm under the same label: the surface of 40.01 mm is 10 um and 6 um from them.
  plan::Plan twice = circle(true);
  plan::FeatureDef plug = twice.features[0];
  plug.inner = false, plug.nominal.size = 20.002;
  twice.features.push_back(plug);
  const Workpiece w = workpiece(R"("surfaces": {"F0": {"diameter_mm": {"value": 40.01, "u": 0.001}}})");
  const Part part(w, twice);
  const PlaceOnPart bore{{0}, {820, 500, -500}, {-1, 0, 0}, twice.features[0].nominal, {1, 0, 0}, {0, 1, 0}};
  PlaceOnPart outside = bore;
  outside.feature = {1}, outside.normal = {1, 0, 0}, outside.nominal = twice.features[1].nominal;
  CHECK(part.known_offset_mm(bore) == doctest::Approx(-0.005));
  CHECK(part.known_offset_mm(outside) == doctest::Approx(0.003));
  // The doubt of the diameter moves the same surface the same way, whichever side it is touched from.
  const Part::Draw draw = part.draw({1, 0});
  const double moved = part.error(draw, bore, {}, {}, false, {}).x;
  CHECK(std::fabs(moved) > 1e-7);
  CHECK(part.error(draw, outside, {}, {}, false, {}).x == doctest::Approx(moved));
  twice.features[1].nominal.size = 30;
  CHECK(faults(twice, w).find("its diameter there is 60 mm") != std::string::npos);
}

TEST_CASE("a known form is in the reference, an unknown one only in the machines") {
  // Three lobes with touches every 30 degrees: the touches meet crest and trough, so the roundness
  // is twice the amplitude.
  const Workpiece known =
      workpiece(R"("surfaces": {"F0": {"form": [{"undulations": 3, "amplitude_um": 2, "phase_deg": 0}]}})");
  const RunResult a = run(circle(false), known, 3);
  CHECK(a.samples[1].reference.value() == doctest::Approx(0.004).epsilon(1e-6));
  for (const double v : a.samples[1].value) CHECK(v == doctest::Approx(0.004).epsilon(1e-6));
  const Workpiece unknown =
      workpiece(R"("surfaces": {"F0": {"form": [{"undulations": 3, "amplitude_um": 2, "phase_deg": "random"}]}})");
  const RunResult b = run(circle(false), unknown, 200);
  CHECK(b.samples[1].reference.value() < 1e-9);
  // Touches every 90 degrees of the wave meet at least cos 45 degrees of it; different machines
  // have different phases.
  for (const double v : b.samples[1].value) CHECK((v > 0.004 * std::sqrt(0.5) - 1e-7 && v < 0.004 + 1e-7));
  CHECK(b.samples[1].value[0] != b.samples[1].value[1]);
}

TEST_CASE("waves lie as their phase says, and what is not known of them too") {
  // amplitude cos(n phi + phase), phi from x: two waves of 2 um at 30 degrees.
  const plan::Plan plan = circle(false);
  const auto at = [&](double degrees) {
    const Vec3 out{std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180), 0};
    const Element& nominal = plan.features[0].nominal;
    return PlaceOnPart{{0}, nominal.point + 20 * out, out, nominal, {1, 0, 0}, {0, 1, 0}};
  };
  const auto with = [](const std::string& amplitude, const std::string& phase) {
    return workpiece(R"("surfaces": {"F0": {"form": [{"undulations": 2, "amplitude_um": )" + amplitude +
                     R"(, "phase_deg": )" + phase + "}]}}");
  };
  const auto doubt = [&](const Part& part, std::uint32_t machine, double degrees) {
    const PlaceOnPart place = at(degrees);
    return dot(part.error(part.draw({1, machine}), place, {}, {}, false, {}), place.normal);
  };
  const Workpiece known = with(R"({"value": 2, "u": 0.5})", "30"), unknown = with("2", R"("random")");
  const Part part(known, plan);
  for (const double degrees : {0.0, 20.0, 75.0, 200.0}) {
    const double wave = std::cos((2 * degrees + 30) * kPi / 180);
    CHECK(part.known_offset_mm(at(degrees)) == doctest::Approx(2e-3 * wave).scale(1e-3));
    CHECK(doubt(part, 7, degrees) == doctest::Approx(doubt(part, 7, -15) * wave).scale(1e-3));  // a crest at -15
  }
  CHECK(std::fabs(doubt(part, 7, -15)) > 1e-5);
  // Of unknown phase it is out and in alike everywhere: the mean of n has the standard deviation 2 um / sqrt(2 n).
  const Part anywhere(unknown, plan);
  constexpr int n = 400;
  for (const double degrees : {0.0, 45.0}) {
    double mean = 0;
    for (std::uint32_t machine = 0; machine < n; ++machine) mean += doubt(anywhere, machine, degrees) / n;
    CHECK(std::fabs(mean) < 4 * 2e-3 / std::sqrt(2.0 * n));
  }
}

TEST_CASE("how large a random form is may be uncertain, too") {
  const Workpiece w = workpiece(R"("surfaces": {"F0": {"random_form_um": {"value": 1, "u": 0.2}}})");
  const plan::Plan plan = circle(false);
  const Part part(w, plan);
  std::vector<double> sd_mm;
  constexpr int n = 1000;
  for (std::uint32_t machine = 0; machine < n; ++machine)
    sd_mm.push_back(part.draw({1, machine}).surfaces[0].random_sd_mm);
  CHECK(std::fabs(variance(sd_mm) / (0.2e-3 * 0.2e-3) - 1) < 4 * std::sqrt(2.0 / (n - 1)));
}

TEST_CASE("a random form scatters like its standard deviation and belongs to the place") {
  const Workpiece w = workpiece(R"("surfaces": {"F0": {"random_form_um": 1}})");
  constexpr int n = 4000;
  // The mean radius of 12 touches: the diameter has 2 / sqrt(12) um.
  const Moments m = moments(run(circle(false), w, n).samples[0].value);
  CHECK(std::fabs(m.sd / (0.002 / std::sqrt(12.0)) - 1) < 6 / std::sqrt(2.0 * n));
}

TEST_CASE("a touch that is repeated finds the same random form, another one another") {
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  Arguments a = nominal_zero();
  a.add_text("axis", "XAXIS");
  const Vec3 out{1, 0, 0};
  for (const Vec3& place : {Vec3{800, 500, -500}, Vec3{800, 500, -500}, Vec3{800, 500.01, -500}})
    b.evaluate({b.point(place, out)}, "CORTOL", a);
  const Workpiece w = workpiece(
      R"("surfaces": {"F0": {"random_form_um": 1}, "F1": {"random_form_um": 1}, "F2": {"random_form_um": 1}})");
  const RunResult r = run(b.plan, w, 20);
  CHECK(r.samples[1].value == r.samples[0].value);
  for (std::size_t i = 0; i < 20; ++i) CHECK(r.samples[2].value[i] != r.samples[0].value[i]);

  TouchedSpots spots;
  const auto numbers = [&](const Vec3& point, std::uint32_t site) {
    const TouchedSpots::Numbers n = spots.at(point, out, site);
    return std::pair{n.site, n.visit};
  };
  CHECK(numbers({0, 0, 0}, 3) == std::pair{3u, 0u});
  // A recorded point of the same place lies beside it along the normal; a step is another place.
  CHECK(numbers({0.02, 0, 0}, 4) == std::pair{3u, 0u});
  CHECK(numbers({5, 0, 0}, 4) == std::pair{4u, 0u});
  // One touch of the plan that a loop makes at several places has another form at each.
  CHECK(numbers({0, 1, 0}, 4) == std::pair{4u, 1u});
  CHECK(numbers({0, 1, 0}, 4) == std::pair{4u, 1u});
  // Where spots are looked for ends nowhere between two that are one, nor between positive and negative places.
  CHECK(numbers({-0.05, -0.0004, 6.9996}, 5) == std::pair{5u, 0u});
  CHECK(numbers({0.04, 0.0003, 7.0003}, 6) == std::pair{5u, 0u});
}

/// A part at 25 degrees C expands by 1 ppm/K more than is known; nothing else errs.
static RunResult grown(const plan::Plan& plan) {
  Machine machine = read_machine("coord3-mc16");
  machine.effects.push_back({"thermal.part_expansion", {{"cte_error_ppm_per_K", {1, 0, ""}}}});
  const Workpiece w = workpiece(R"("material": {"cte_ppm_per_K": 0}, "temperature": {"part_C": 25})");
  RunOptions options;
  options.contributors.geometry = options.contributors.head = options.contributors.probe = false;
  options.workpiece = &w;
  return run_plan(plan, machine, screened_machines(machine, 1, 2, 1), options, no_source());
}

TEST_CASE("effects of the machine see the temperatures and the load of the workpiece") {
  const RunResult r = grown(length());
  // 1 ppm/K, 5 K, 500 mm.
  CHECK(r.samples[0].value[0] == doctest::Approx(500.0025).epsilon(1e-12));
}

TEST_CASE("a part without a coordinate system of its own grows from the middle of its touches") {
  // 1 ppm/K more than known, at 25 degrees C: 250 mm from the middle 1.25 um, wherever the part stands in the machine.
  PlanBuilder b;
  b.append(plan::SelectSensor{b.sensor(0, 0, 150)});
  Arguments a = nominal_zero();
  a.add_text("axis", "XAXIS");
  for (const double side : {-1.0, 1.0}) b.evaluate({b.point({750 + side * 250, 500, -500}, {side, 0, 0})}, "CORTOL", a);
  const RunResult r = grown(b.plan);
  CHECK(r.samples[0].value[0] == doctest::Approx(-1.25e-3).scale(1e-3));
  CHECK(r.samples[1].value[0] == doctest::Approx(1.25e-3).scale(1e-3));
}

TEST_CASE("effects of the machine see the temperatures that each virtual machine drew") {
  // d = -(e (T - 20)) s over 500 mm along x, with e = 2 ppm/K and T = 22 +- 0.5 degrees C, and then with e +-
  // 0.5 ppm/K too: var = L^2 [ (e u_T)^2 + (u_e (T - 20))^2 + (u_e u_T)^2 ], the product of two independent
  // quantities.
  constexpr int kMany = 4000;
  constexpr double kLength_mm = 500, kE = 2e-6, kUE = 0.5e-6, kT = 2, kUT = 0.5;
  const Workpiece w =
      workpiece(R"("material": {"cte_ppm_per_K": 0}, "temperature": {"scale_C": {"value": 22, "u": 0.5}})");
  const auto run_with = [&](double u, EffectUse use, int block_lanes, bool part) {
    Machine machine = read_machine("coord3-mc16");
    machine.effects = {{"thermal.scale_expansion", {{"cte_error_ppm_per_K", {2, u, ""}}}}};
    RunOptions options;
    options.contributors.geometry = options.contributors.head = options.contributors.probe = false;
    options.contributors.part = part;
    options.effect_use = use;
    options.block_lanes = block_lanes;
    options.workpiece = &w;
    return run_plan(length(), machine, screened_machines(machine, 1, kMany, 2), options, no_source()).samples[0].value;
  };
  const auto check = [&](const Moments& m, double mean, double variance) {
    CHECK(std::fabs(m.mean - mean) < 5 * std::sqrt(variance / kMany));
    CHECK(m.sd * m.sd == doctest::Approx(variance).epsilon(0.12).scale(0));  // five standard errors
  };
  const double temperature_alone = kLength_mm * kLength_mm * kE * kE * kUT * kUT;
  const double both = kLength_mm * kLength_mm * (kE * kE * kUT * kUT + kUE * kUE * kT * kT + kUE * kUE * kUT * kUT);
  const std::vector<double> drawn = run_with(0, EffectUse::left_in, 128, true);
  check(moments(drawn), 500 - kE * kT * kLength_mm, temperature_alone);
  check(moments(run_with(0.5, EffectUse::left_in, 128, true)), 500 - kE * kT * kLength_mm, both);
  check(moments(run_with(0.5, EffectUse::corrected, 128, true)), 500, both);
  // The temperatures are those of the machines, whatever else acts and however they are grouped.
  CHECK(run_with(0, EffectUse::left_in, 37, true) == drawn);
  CHECK(run_with(0, EffectUse::left_in, 128, false) == drawn);
}

TEST_CASE("a logged temperature acts at the time of the touch") {
  // The part warms by 1 K while the program goes to the second point: only that point has moved.
  Workpiece w = workpiece(R"("material": {"cte_ppm_per_K": 10})");
  static const Machine machine = read_machine("coord3-mc16");
  RunOptions options;
  options.contributors.geometry = options.contributors.head = options.contributors.probe = false;
  const auto rows =
      record_plan(length(), machine, screened_machines(machine, 1, 1, 1), options, no_source()).recording.rows;
  w.log.time_s = {*rows[0].time_s, *rows[1].time_s};
  w.log.temperature_C[TemperatureLog::part] = {20, 21};
  for (const double v : lengths(w, 2)) CHECK(v == doctest::Approx(500.005).epsilon(1e-12));
}

TEST_CASE("surfaces that the program does not have, or that cannot have the size, are refused") {
  const Workpiece unknown = workpiece(R"("surfaces": {"F00": {"offset_um": 1}})");
  CHECK(faults(length(), unknown).find("error E0423: the program measures no feature 'F00'") != std::string::npos);
  CHECK(faults(length(), unknown).find("did you mean 'F0'?") != std::string::npos);
  CHECK(faults(length(), workpiece(R"("surfaces": {"F0": {"diameter_mm": 5}})"))
            .find("error E0424: feature 'F0' is a POINT and has no diameter") != std::string::npos);
  CHECK(faults(length(),
               workpiece(R"("surfaces": {"F0": {"form": [{"undulations": 2, "amplitude_um": 1, "phase_deg": 0}]}})"))
            .find("no undulations") != std::string::npos);
  CHECK(faults(length(), workpiece(R"("surfaces": {"f0": {"offset_um": 1}})")).empty());
}

TEST_CASE("a recording has the temperatures and the load that the file gives, and no others") {
  static const Machine machine = read_machine("coord3-mc16");
  const Workpiece w =
      workpiece(R"("material": {"cte_ppm_per_K": 11.5}, "temperature": {"part_C": 21, "air_C": 19}, "load_kg": 30)");
  RunOptions options;
  options.workpiece = &w;
  const RecordingRow row =
      record_plan(length(), machine, screened_machines(machine, 1, 1, 1), options, no_source()).recording.rows.at(1);
  CHECK(row.temp_part_C == 21);
  CHECK(row.temp_air_C == 19);
  CHECK(row.load_kg == 30);
  CHECK_FALSE(row.temp_x_C);
}
