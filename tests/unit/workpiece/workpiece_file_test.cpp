#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/workpiece/workpiece.hpp"

using namespace abbe;

namespace {

Workpiece parse(const std::string& members) {
  return parse_workpiece(SourceFile("w.json", R"({"schema": "abbe.workpiece/1", "name": "w", )" + members + "}"));
}

/// All messages about a file, one a line; "" when it is good.
std::string faults(const std::string& members) {
  try {
    parse(members);
  } catch (const UserError& error) {
    std::string out;
    for (const Diagnostic& d : error.diagnostics())
      out += std::string(info(d.code).name) + " " + d.message + " | " + d.help + "\n";
    return out;
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string surface(const std::string& members) { return R"("surfaces": {"A": {)" + members + "}}"; }

}  // namespace

TEST_CASE("every way to write a quantity is understood") {
  const Workpiece w = parse(R"("surfaces": {
    "A": {"offset_um": 3},
    "B": {"offset_um": {"value": 1, "u": 0.2}},
    "C": {"offset_um": {"value": 1, "u": 0.2, "dof": 9}},
    "D": {"offset_um": {"value": 0, "half_width": 3, "distribution": "rectangular"}},
    "E": {"offset_um": {"value": 0, "u": 1, "distribution": "arcsine"}},
    "F": {"offset_um": {"value": 0, "half_width": 3, "distribution": "trapezoidal", "top_share": 0.5}},
    "G": {"offset_um": {"value": 838, "components": [{"u": 3}, {"u": 4}]}}})");
  const auto& s = w.surfaces;
  CHECK(s[0].offset_mm.value == doctest::Approx(0.003));
  CHECK(s[0].offset_mm.exact());
  CHECK(s[1].offset_mm.u() == doctest::Approx(0.0002).scale(0));
  CHECK(s[2].offset_mm.u() == doctest::Approx(0.0002 * std::sqrt(9.0 / 7)).scale(0));
  CHECK(s[3].offset_mm.u() == doctest::Approx(0.003 / std::sqrt(3.0)));
  CHECK(s[4].offset_mm.components[0].scale == doctest::Approx(0.001 * std::sqrt(2.0)));
  CHECK(s[5].offset_mm.components[0].shape == 0.5);
  CHECK(s[6].offset_mm.u() == doctest::Approx(0.005));
  CHECK(s[6].offset_mm.value == doctest::Approx(0.838));
}

TEST_CASE("a workpiece file may bound influences") {
  const Workpiece w =
      parse(R"("bounds": [{"influence": "fixturing", "at_most_um": 2, "source": "FE model of the clamps"}])");
  REQUIRE(w.bounds.size() == 1);
  CHECK(w.bounds[0].influence == "fixturing");
  CHECK(w.bounds[0].at_most_mm == doctest::Approx(0.002));
  CHECK(has(faults(R"("bounds": [{"influence": "fixtring", "at_most_um": 2, "source": "s"}])"),
            "E0432 there is no influence \"fixtring\" | did you mean \"fixturing\"?"));
}

TEST_CASE("contradictions in a quantity are named (E0421)") {
  const auto offset = [](const std::string& members) {
    return faults(surface(R"("offset_um": {"value": 1, )" + members + "}"));
  };
  CHECK(has(offset(R"("half_width": 1)"), "E0421 a \"half_width\" needs a \"distribution\""));
  CHECK(has(offset(R"("half_width": 1, "u": 1, "distribution": "triangular")"),
            "E0421 \"u\" and \"half_width\" say the same thing"));
  CHECK(has(offset(R"("distribution": "triangular")"), "E0421 neither \"u\" nor \"half_width\""));
  CHECK(has(offset(R"("half_width": 1, "distribution": "normal")"), "no limits, so no \"half_width\""));
  CHECK(has(offset(R"("half_width": 1, "distribution": "trapezoidal")"), "needs \"top_share\""));
  CHECK(has(offset(R"("half_width": 1, "distribution": "curvilinear_trapezoid", "inexactness": 2)"),
            "is more than the half width 1"));
  CHECK(has(offset(R"("half_width": 1, "distribution": "rectangulr")"), "did you mean \"rectangular\"?"));
  CHECK(has(offset(R"("u": 1, "components": [{"u": 1}])"), "has \"components\" and an uncertainty of its own"));
  CHECK(has(offset(R"("half_width": 1, "distribution": "uniform")"), "write \"rectangular\""));
  CHECK(has(offset(R"("components": [])"), "lists no component of its uncertainty"));
  CHECK(has(offset(R"("halfwidth": 1)"), "did you mean \"half_width\"?"));
  CHECK(has(offset(R"("u": 1, "dof": 2)"), "must be greater than 2"));
  CHECK(has(offset(R"("half_width": 1, "distribution": "rectangular", "dof": 5)"), "unknown key \"dof\""));
  CHECK(offset(R"("half_width": 1, "distribution": "rectangular")").empty());
}

TEST_CASE("nothing may be said twice (E0422)") {
  const std::string cte = R"("material": {"cte_ppm_per_K": 11.5}, )";
  CHECK(has(faults(cte + R"("temperature": {"scale_C": 21, "scale_x_C": 22})"), "E0422 \"scale_x_C\" and \"scale_C\""));
  CHECK(has(faults(cte + R"("temperature": {"part_C": 21, "scale_C": 22, "part_minus_scale_K": 0})"),
            "E0422 \"part_minus_scale_K\""));
  CHECK(has(faults(cte + R"("temperature": {"scale_y_C": 22, "part_minus_scale_K": 0})"),
            "E0422 \"part_minus_scale_K\""));
  CHECK(has(
      faults(R"("scales": {"cte_ppm_per_K": 8}, "material": {"cte_ppm_per_K": 11, "cte_minus_scale_ppm_per_K": 3})"),
      "E0422"));
  CHECK(has(faults(surface(R"("offset_um": 1, "diameter_mm": 20)")), "E0422 \"offset_um\" and \"diameter_mm\""));
  CHECK(has(faults(surface(R"("diameter_mm": 20, "diameter_deviation_um": 1)")), "E0422"));
  CHECK(has(faults(R"("surfaces": {"bore": {"offset_um": 1}, "TOP": {}, "BORE": {"offset_um": 2}})"),
            "E0422 \"BORE\" and \"bore\""));
}

TEST_CASE("what is missing or mistyped is named with its place") {
  CHECK(has(faults(R"("temperature": {"part_C": 21})"), "E0404 temperatures need the coefficient of expansion"));
  CHECK(has(faults(R"("material": {"cte_minus_scale_ppm_per_K": 0})"), "E0404 a coefficient relative to the scales"));
  CHECK(has(faults(R"("material": {"cte_ppm_per_C": 11})"), "did you mean \"cte_ppm_per_K\"?"));
  CHECK(has(faults(R"("material": {"cte_ppm_per_K": 0.0115, "nam": "steel"})"), "did you mean \"name\"?"));
  CHECK(has(faults(surface(R"("offset_mm": 1)")), "did you mean \"offset_um\"?"));
  CHECK(has(faults(surface(R"("form": [{"amplitude_um": 1, "phase_deg": 0}])")), "needs \"undulations\""));
  CHECK(has(faults(surface(R"("form": [{"undulations": 2, "phase_deg": 0}])")), "needs \"amplitude_um\""));
  CHECK(has(faults(surface(R"("form": [{"undulations": 2, "amplitude_um": 1, "phase_deg": "rndom"}])")),
            "did you mean \"random\"?"));
  CHECK(has(faults(surface(R"("form": [{"undulations": 0, "amplitude_um": 1, "phase_deg": 0}])")), "E0406"));
  CHECK(has(faults(R"("material": {"cte_ppm_per_K": 11}, "temperature": {"part_C": 293})"),
            "must be between -50 and 150"));
  CHECK_THROWS_AS(parse_workpiece(SourceFile("m.json", R"({"schema": "abbe.machine/1", "name": "m"})")), UserError);
}

TEST_CASE("part and scales can be given by their difference") {
  const std::string cte = R"("material": {"cte_ppm_per_K": 11.5}, )";
  const Temperatures a = parse(cte + R"("temperature": {"part_C": 21, "part_minus_scale_K": 0.5})").temperatures(0);
  CHECK(a.part == 21);
  for (const double scale : a.scale) CHECK(scale == 20.5);
  const Temperatures b = parse(cte + R"("temperature": {"scale_C": 22, "part_minus_scale_K": -1})").temperatures(0);
  CHECK(b.part == 21);
  CHECK(b.scale[2] == 22);
  const Workpiece none = parse(R"("load_kg": 12.5)");
  CHECK(none.temperatures(0).part == 20);
  CHECK_FALSE(none.knows.part);
  CHECK(none.knows.load);
}

TEST_CASE("a temperature log runs straight between its lines and stays at its ends") {
  const TemperatureLog log =
      read_temperature_log(SourceFile("t.csv", "time_s,temp_part_C, temp_x_C\n0,20,19\n100,21,19\n200,21,20\n"));
  CHECK(log.at(TemperatureLog::part, -5) == 20);
  CHECK(log.at(TemperatureLog::part, 25) == doctest::Approx(20.25));
  CHECK(log.at(TemperatureLog::part, 100) == 21);
  CHECK(log.at(TemperatureLog::x, 150) == doctest::Approx(19.5));
  CHECK(log.at(TemperatureLog::x, 1e9) == 20);
  CHECK_FALSE(log.has(TemperatureLog::air));
}

TEST_CASE("a temperature log is a table as others are: byte order mark, signs, free text") {
  const TemperatureLog log = read_temperature_log(
      SourceFile("t.csv", "\xEF\xBB\xBF# logger 7\r\n\"time_s\",temp_air_C\r\n\r\n0,+20\r\n10, 21.5\r\n"));
  CHECK(log.time_s == std::vector<double>{0, 10});
  CHECK(log.temperature_C[TemperatureLog::air] == std::vector<double>{20, 21.5});
}

TEST_CASE("a log that cannot be read says where (E0425)") {
  const auto fault = [](const std::string& text) {
    try {
      read_temperature_log(SourceFile("t.csv", text));
    } catch (const UserError& error) {
      return render(error.diagnostics().front());
    }
    return std::string();
  };
  CHECK(has(fault("time_s,temp_prt_C\n0,20\n"), "t.csv:1:8: error E0425"));
  CHECK(has(fault("time_s,temp_prt_C\n0,20\n"), "did you mean 'temp_part_C'?"));
  CHECK(has(fault("temp_part_C,temp_x_C\n0,20\n"), "needs the column 'time_s'"));
  CHECK(has(fault("time_s,temp_part_C\n0,20;5\n"), "'20;5' is not a number"));
  for (const char* text : {"nan", "inf", "-inf", ""}) {
    CHECK(has(fault(std::string("time_s,temp_part_C\n0,20\n10,") + text + "\n"), "is not a number"));
    CHECK(has(fault(std::string("time_s,temp_part_C\n") + text + ",20\n10,21\n"), "is not a number"));
  }
  CHECK(has(fault("time_s,temp_part_C\n0\n"), "has 1 value, the header 2 columns"));
  CHECK(has(fault("time_s,temp_part_C\n5,20\n5,21\n"), "ascend in time"));
  CHECK(has(fault("time_s,time_s\n5,20\n"), "for the second time"));
  CHECK(has(fault("time_s,temp_part_C\n"), "has no rows"));
}

TEST_CASE("strain is the difference of part and scales, less what the compensation takes out") {
  // 1 K above 20 degrees C, 11.5 ppm/K, scales at 20: 11.5e-6; compensated with the right
  // coefficient: nothing.
  const Workpiece w = parse(
      R"("material": {"cte_ppm_per_K": 11.5}, "scales": {"cte_ppm_per_K": 8}, "temperature": {"part_C": 21, "scale_y_C": 22},
                               "compensation": {"cte_ppm_per_K": 10})");
  const ThermalDraw d = draw_thermal(w, {1, 0});
  const Vec3 off = strain(w, d, w.temperatures(0), false), on = strain(w, d, w.temperatures(0), true);
  CHECK(off.x == doctest::Approx(11.5e-6).scale(0));
  CHECK(off.y == doctest::Approx(11.5e-6 - 16e-6).scale(0));
  CHECK(on.x == doctest::Approx(1.5e-6).scale(0));
  CHECK(on.y == doctest::Approx(1.5e-6).scale(0));
}

TEST_CASE("the compensation goes by what each sensor says, and by what is assumed of part and scales") {
  // At 20 degrees C nothing expands: what the errors of the sensors take out is all that is left.
  const Workpiece w = parse(R"("material": {"cte_minus_scale_ppm_per_K": 1}, "scales": {"cte_ppm_per_K": 8},
                               "compensation": {"on": true, "sensor_K": {"value": 0, "u": 0.1}})");
  CHECK(w.assumed_part_cte_per_K == doctest::Approx(9e-6).scale(0));
  ThermalDraw d;
  d.part_sensor_K = 0.3, d.scale_sensor_K = {0.1, 0.2, -0.4};
  const Vec3 e = strain(w, d, {}, true);
  CHECK(e.x == doctest::Approx(-9e-6 * 0.3 + 8e-6 * 0.1).scale(0));
  CHECK(e.y == doctest::Approx(-9e-6 * 0.3 + 8e-6 * 0.2).scale(0));
  CHECK(e.z == doctest::Approx(-9e-6 * 0.3 - 8e-6 * 0.4).scale(0));
  CHECK(w.part_temperature_acts(true));
  CHECK(w.scale_temperature_acts(true));
  CHECK_FALSE(w.part_temperature_acts(false));
  CHECK_FALSE(w.scale_temperature_acts(false));
}

TEST_CASE("what is given relative to the scales shares their doubt") {
  const Workpiece w = parse(
      R"("material": {"cte_minus_scale_ppm_per_K": 1}, "scales": {"cte_ppm_per_K": {"value": 8, "u": 1}},
         "temperature": {"scale_C": {"value": 22, "u": 0.5}, "part_minus_scale_K": 0.1})");
  for (std::uint32_t machine = 0; machine < 5; ++machine) {
    const ThermalDraw d = draw_thermal(w, {1, machine});
    CHECK(d.scale_K[0] != 0);
    CHECK(d.part_K == d.scale_K[0]);
    CHECK(d.scale_cte_per_K != 8e-6);
    CHECK(d.part_cte_per_K - d.scale_cte_per_K == doctest::Approx(1e-6).scale(0));
  }
}

TEST_CASE("components of an uncertainty are independent, and all of them are in proportion to the unit") {
  Uncertain q;
  q.components = {{Distribution::normal, 1, 0}, {Distribution::normal, 1, 0}};
  constexpr int n = 2000;
  double squares = 0;
  for (std::uint32_t machine = 0; machine < n; ++machine) {
    const double d = deviation(q, "q", {1, machine});
    squares += d * d / n;
  }
  CHECK(std::fabs(squares / 2 - 1) < 4 * std::sqrt(2.0 / n));
  for (const Distribution kind : {Distribution::trapezoidal, Distribution::curvilinear_trapezoid}) {
    Uncertain wide;
    wide.components = {{kind, 2, 0.5}};
    CHECK((1e-3 * wide).u() == doctest::Approx(1e-3 * wide.u()).scale(0));
  }
}

TEST_CASE("of a recorded part only what is not known of its form is still to be added") {
  const auto form = [](const std::string& amplitude, const std::string& phase) {
    return parse(R"("surfaces": {"A": {"form": [{"undulations": 2, "amplitude_um": )" + amplitude +
                 R"(, "phase_deg": )" + phase + "}]}}");
  };
  CHECK_FALSE(form("2", "15").has_form(true));
  CHECK(form("2", "15").has_form(false));
  CHECK(form(R"({"value": 2, "u": 0.1})", "15").has_form(true));
  CHECK(form("2", R"("random")").has_form(true));
}

TEST_CASE("another uncertain quantity changes no number of the others") {
  const std::string part =
      R"("material": {"cte_ppm_per_K": {"value": 11.5, "u": 1}}, "temperature": {"part_C": {"value": 21, "u": 0.3})";
  const Workpiece one = parse(part + "}"), more = parse(part + R"(, "scale_C": {"value": 20, "u": 0.2}})");
  for (std::uint32_t m = 0; m < 5; ++m) {
    const ThermalDraw a = draw_thermal(one, {1, m}), b = draw_thermal(more, {1, m});
    CHECK(a.part_cte_per_K == b.part_cte_per_K);
    CHECK(a.part_K == b.part_K);
    CHECK(b.scale_K[0] == b.scale_K[2]);
    CHECK(b.scale_K[0] != 0);
  }
}
