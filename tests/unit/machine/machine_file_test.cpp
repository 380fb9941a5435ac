#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "engine/base/diagnostic.hpp"
#include "engine/base/files.hpp"
#include "engine/base/source.hpp"
#include "engine/machine/machine.hpp"

namespace abbe {

namespace {

constexpr double kDegree = kPi / 180;

/// The smallest machine file, with something more in it.
std::string small_file(const std::string& more = "",
                       const std::string& specification = R"("mpe": {"a_um": 2, "k_um_per_m": 3})") {
  return R"({"name": "small", "axes": {"x": {"travel_mm": 500}, "y": {"travel_mm": 600}, "z": {"travel_mm": 400, "direction": -1}},
  "specification": {)" +
      specification + "}" + (more.empty() ? "" : ",\n" + more) + "}";
}

std::vector<Diagnostic> faults(const std::string& text) {
  try {
    parse_machine("m.json", text);
  } catch (const UserError& error) {
    return error.diagnostics();
  }
  return {};
}

void check_fault(const std::string& text, Code code, const std::string& mentioned) {
  CAPTURE(text);
  const std::vector<Diagnostic> found = faults(text);
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == code);
  CHECK(found[0].message.find(mentioned) != std::string::npos);
  CHECK(found[0].span.has_value());
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("the shipped machine of the paper holds Tables 1 and 2, in mm and rad") {
  const Machine m = read_machine("coord3-mc16");
  CHECK(m.name == "coord3-mc16");
  CHECK(m[Axis::x].travel_mm == 1600);
  CHECK(m[Axis::z].direction == -1);
  CHECK(m[Axis::y].offset_mm == Vec3{0, -1410, 1085});
  CHECK(m.home_offset() == Vec3{0, 0, 0});
  CHECK(m.ram_chain == std::vector<Axis>{Axis::x, Axis::y, Axis::z});
  CHECK(m.harmonics == 7);
  CHECK(m[Component::exx].linear == 0.8);
  CHECK(m[Component::exx].e_max == doctest::Approx(7e-3));
  CHECK(m[Component::ezy].curvature == 0.4);
  CHECK(m[Component::ecz].e_max == doctest::Approx(10e-6).scale(0));
  CHECK(m.specification.mpe.a_mm == doctest::Approx(5e-3));
  CHECK(m.specification.mpe.k == doctest::Approx(5e-6).scale(0));
  CHECK(m.head.sd_a_rad == doctest::Approx(0.83 / 3600 * kDegree).scale(0));
  CHECK(m.probe.sd_mm.y == doctest::Approx(0.5e-3));
  const NamedSensor& side = m.sensors.at("A90B90");
  CHECK(side.head_b_rad == doctest::Approx(90 * kDegree));
  CHECK(side.radius_mm == 2);
}

TEST_CASE("bounds on influences name a known one, once, with a source") {
  const Machine m = parse_machine("m.json", small_file(R"("bounds": [
    {"influence": "vibration and outliers", "at_most_um": 0.3, "source": "floor survey"}])"));
  REQUIRE(m.bounds.size() == 1);
  CHECK(m.bounds[0].influence == "vibration and outliers");
  CHECK(m.bounds[0].at_most_mm == doctest::Approx(0.0003).scale(0));
  CHECK(m.bounds[0].source == "floor survey");
  const auto one = [](const std::string& influence, const std::string& rest) {
    return R"({"influence": ")" + influence + R"(", )" + rest + "}";
  };
  const std::string good = R"("at_most_um": 1, "source": "s")";
  const auto file = [&](const std::string& list) { return small_file(R"("bounds": [)" + list + "]"); };
  check_fault(file(one("thermal drft", good)), Code::E0432, "thermal drft");
  CHECK(faults(file(one("thermal drft", good)))[0].help == "did you mean \"thermal drift\"?");
  check_fault(file(one("geometry", good)), Code::E0433, "part of every simulation");
  check_fault(file(one("operator", good) + "," + one("operator", good)), Code::E0433, "already");
  check_fault(file(one("operator", R"("at_most_um": 0, "source": "s")")), Code::E0406, "at_most_um");
  check_fault(file(one("operator", R"("at_most_um": 1)")), Code::E0404, "source");
  check_fault(file(one("operator", good + R"(, "u": 1)")), Code::E0402, "u");
}

TEST_CASE("every shipped machine reads, has its file's name, and stands at zero at home") {
  const std::vector<std::string> names = shipped_machines();
  CHECK(names.size() >= 3);
  CHECK(std::is_sorted(names.begin(), names.end()));
  for (const std::string& name : names) {
    const Machine m = read_machine(name);
    CHECK(m.name == name);
    CHECK(norm(m.home_offset()) == 0);
    CHECK(!m.sensors.empty());
    CHECK(read_source(ABBE_SOURCE_DIR "/examples/machines/" + name + ".json").text().size() > 500);
  }
  const Machine table = read_machine("moving-table-700");
  CHECK(table[Axis::y].table_side);
  CHECK(table.table_chain == std::vector<Axis>{Axis::y});
}

TEST_CASE("what may be left out has the documented default") {
  const Machine m = parse_machine("m.json", small_file());
  CHECK(m[Axis::x].direction == 1);
  CHECK(m.ram_chain.size() == 3);
  CHECK(m.home_offset() == Vec3{});
  CHECK(m[Component::eyy].linear == 0.8);
  CHECK(m[Component::eax].e_max == doctest::Approx(10e-6).scale(0));
  CHECK(m.specification.v_min == 1);
  CHECK(m.specification.v_max == 2);
  CHECK(m.specification.longest_share == 0.66);
  CHECK(m.head.sd_a_rad == 0);
  CHECK(m.probe.sd_mm.x == doctest::Approx(0.5e-3));
  CHECK(m.motion.probing_speed_mm_s == 5);
  CHECK(!m.known_state);
}

TEST_CASE("values are converted to mm and rad") {
  const Machine m = parse_machine(
      "m.json",
      small_file(
          R"("geometry": {"squareness_um_per_m": {"cwy": 12, "bwz": -3, "awz": 1}, "components": {"exy": {"e_max": 4}}},
    "head": {"l_r_mm": 45, "angle_sd_arcsec": {"A": 1, "B": 2}, "mounting": {"turn_deg": 90}},
    "sensors": {"S": {"tip_in_r_mm": [20, 5, -100], "diameter_mm": 3, "material": "ceramic"},
                "T": {"head_deg": [90, -45], "tip_in_r_mm": [0, 0, -50], "diameter_mm": 2, "material": "own", "young_GPa": 100, "cte_ppm_per_K": 9}},
    "effects": [{"name": "machine.scale", "parameters": {"scale_um_per_m": {"value": 2.5, "u": 0.5}, "axis": "x", "other": 3}}])"));
  CHECK(m.squareness_cwy_rad == doctest::Approx(12e-6).scale(0));
  CHECK(m.squareness_bwz_rad == doctest::Approx(-3e-6).scale(0));
  CHECK(m[Component::exy].e_max == doctest::Approx(4e-3));
  CHECK(m[Component::exy].curvature == 0.4);
  CHECK(m.head.mounting_rad == doctest::Approx(90 * kDegree));
  CHECK(m.head.sd_b_rad == doctest::Approx(2.0 / 3600 * kDegree).scale(0));
  CHECK(m.sensors.at("S").young_GPa == 350);
  CHECK(m.sensors.at("S").shaft_diameter_mm == 1.5);
  CHECK(m.sensors.at("T").head_b_rad == doctest::Approx(-45 * kDegree));
  CHECK(m.sensors.at("T").cte_ppm_per_K == 9);
  REQUIRE(m.effects.size() == 1);
  CHECK(m.effects[0].parameters.at("scale_um_per_m").u == 0.5);
  CHECK(m.effects[0].parameters.at("axis").word == "x");
  CHECK(m.effects[0].parameters.at("other").value == 3);
}

TEST_CASE("a known state is read as strictly as the rest of the file") {
  const auto list = [](int size, const std::string& number) {
    std::string out = "[" + number;
    for (int k = 1; k < size; ++k) out += ", " + number;
    return out + "]";
  };
  const int size = 18 * 5;  // coefficients of 18 error functions with one harmonic
  const std::string schema = R"("schema": "abbe.known_state/1")", mean = R"("mean": )" + list(size, "0.5"),
                    factor = R"("factor": [)" + list(size, "1e-20") + ", " + list(size, "-2") + "]";
  const auto with = [&](const std::string& state) {
    return small_file(R"("geometry": {"harmonics": 1}, "known_state": )" + state);
  };
  const Machine m =
      parse_machine("m.json", with("{" + schema + R"(, "geometry_scale": 1.1, )" + mean + "," + factor + "}"));
  REQUIRE(m.known_state);
  CHECK(m.known_state->mean == std::vector<double>(size, 0.5));
  REQUIRE(m.known_state->factor.size() == 2);
  CHECK(m.known_state->factor[1] == std::vector<double>(size, -2.0));

  const auto file = [&](const std::string& first, const std::string& second, const std::string& third) {
    return with("{" + first + ", " + second + ", " + third + "}");
  };
  CHECK(faults(file(schema, mean, factor)).empty());
  check_fault(with("3"), Code::E0405, "known_state");
  check_fault(file(schema, mean, factor + R"(, "means": 1)"), Code::E0402, "means");
  CHECK(faults(file(schema, mean, factor + R"(, "means": 1)"))[0].help == "did you mean \"mean\"?");
  check_fault(with("{" + mean + "," + factor + "}"), Code::E0404, "schema");
  check_fault(file(R"("schema": "abbe.known_state/2")", mean, factor), Code::E0407, "abbe.known_state/1");
  check_fault(with("{" + schema + "," + mean + "}"), Code::E0404, "factor");
  check_fault(file(schema, R"("mean": [1, 2])", factor), Code::E0706, "2 numbers");
  check_fault(file(schema, R"("mean": null)", factor), Code::E0405, "known_state.mean");
  CHECK(faults(file(schema, mean, R"("factor": [])")).empty());
  check_fault(file(schema, mean, R"("factor": [1])"), Code::E0405, "known_state.factor");
  check_fault(file(schema, mean, R"("factor": [[1]])"), Code::E0706, "1 numbers");
  check_fault(file(schema, replaced(mean, "0.5", "1e7"), factor), Code::E0406, "known_state.mean");
}

TEST_CASE("impossible machines are refused at the place of the mistake") {
  check_fault(replaced(small_file(), "500", "-500"), Code::E0406, "axes.x.travel_mm");
  check_fault(replaced(small_file(), "500", "1e300"), Code::E0406, "axes.x.travel_mm");
  check_fault(replaced(small_file(), "500", "1e12"), Code::E0406, "at most 100000");
  check_fault(replaced(small_file(), "small", ""), Code::E0406, "name");
  check_fault(small_file(R"("offsets_mm": {"x": [1e9, 0, 0]})"), Code::E0406, "offsets_mm.x");
  check_fault(small_file(R"("offsets_mm": {"mount": [0, 0, -1e6]})"), Code::E0406, "offsets_mm.mount");
  const std::string sd = R"("angle_sd_arcsec": {"A": 1, "B": 1})";
  check_fault(small_file(R"("head": {"mounting": {"turn_deg": 400}, )" + sd + "}"), Code::E0406, "turn_deg");
  check_fault(small_file(R"("head": {"l_r_mm": 1e7, )" + sd + "}"), Code::E0406, "l_r_mm");
  CHECK(faults(small_file(R"("head": {"l_r_mm": 0, "mounting": {"turn_deg": -360}, )" + sd + "}")).empty());
  check_fault(replaced(small_file(), "500", "1e-200"), Code::E0406, "axes.x.travel_mm");
  for (const char* direction : {"0", "2", "-0.5", "1.5"})
    check_fault(replaced(small_file(), "-1", direction), Code::E0406, "must be 1 or -1");
  CHECK(parse_machine("m.json", replaced(small_file(), "-1", "-1.0"))[Axis::z].direction == -1);
  check_fault(replaced(small_file(), "\"travel_mm\": 500", "\"travel\": 500, \"travel_mm\": 500"), Code::E0402,
              "travel");
  check_fault(small_file(R"("schema": "abbe.workpiece/1")"), Code::E0407, "abbe.workpiece/1");
  check_fault(
      R"({"axes": {"x": {"travel_mm": 1}, "y": {"travel_mm": 1}, "z": {"travel_mm": 1}}, "specification": {"mpe": {"a_um": 1, "k_um_per_m": 1}}})",
      Code::E0404, "name");
}

TEST_CASE("a chain has every axis once") {
  check_fault(small_file(R"("chain": {"ram_side": ["x", "z"]})"), Code::E0412, "\"y\" is missing");
  check_fault(small_file(R"("chain": {"ram_side": ["x", "y", "z"], "table_side": ["y"]})"), Code::E0412,
              "\"y\" stands more than once");
  check_fault(small_file(R"("chain": {"ram_side": ["x", "y", "z", "w"]})"), Code::E0412, "\"w\"");
  CHECK(faults(small_file(R"("chain": {"ram_side": ["z"], "table_side": ["y", "x"]})")).empty());
}

TEST_CASE("shares of an error function sum to 1") {
  const auto with = [](const std::string& component, const std::string& rest = "") {
    return small_file(R"("geometry": {"components": {"exx": {)" + component + "}}" + rest + "}");
  };
  check_fault(with(R"("s": 0.8, "c": 0.3)"), Code::E0413, "1.1");
  check_fault(with(R"("s": 0.8, "c": 0.1, "harmonics": [0.05])"), Code::E0413, "0.95");
  check_fault(with(R"("s": 0.8, "c": 0.1, "harmonics": [0.05, 0.05])", R"(, "harmonics": 1)"), Code::E0413,
              "1 harmonics");
  check_fault(with(R"("s": 0, "c": 0)", R"(, "harmonics": 0)"), Code::E0413, "empty");
  check_fault(with(R"("e_max": -1)"), Code::E0406, "e_max");
  check_fault(with(R"("s": -0.1)"), Code::E0406, "\"geometry.components.exx.s\"");
  check_fault(with(R"("harmonic": [0.1])"), Code::E0402, "harmonic");
  check_fault(small_file(R"("geometry": {"components": {"exq": {"s": 1}}})"), Code::E0402, "exq");
  CHECK(faults(with(R"("s": 0.8, "c": 0.1, "harmonics": [0.05, 0.05])")).empty());
}

TEST_CASE("a specification does not contradict itself") {
  check_fault(small_file("", R"("mpe": {"a_um": -1, "k_um_per_m": 3})"), Code::E0406, "a_um");
  check_fault(small_file("", R"("mpe": {"a_um": 1, "k_um_per_m": -3})"), Code::E0406, "k_um_per_m");
  check_fault(small_file("", R"("mpe": {"a_um": 0, "k_um_per_m": 0})"), Code::E0414, "both 0");
  check_fault(small_file("", R"("mpe": {"a_um": 1})"), Code::E0404, "k_um_per_m");
  check_fault(small_file("", R"("mpe": {"a_um": 1, "k_um_per_m": 1}, "v_min": 2)"), Code::E0414, "v_min");
  check_fault(small_file("", R"("mpe": {"a_um": 1, "k_um_per_m": 1}, "longest_share": 1.2)"), Code::E0406,
              "longest_share");
  check_fault(small_file("", R"("mpe": {"a_um": 1, "k_um_per_m": 1}, "longest_share": 0)"), Code::E0406,
              "longest_share");
}

TEST_CASE("sensors are possible things") {
  const auto with = [](const std::string& sensor) { return small_file(R"("sensors": {"S": {)" + sensor + "}}"); };
  check_fault(with(R"("tip_in_r_mm": [0, 0, -1], "diameter_mm": 0)"), Code::E0406, "sensors.S.diameter_mm");
  check_fault(with(R"("tip_in_r_mm": [0, 0], "diameter_mm": 1)"), Code::E0406, "3");
  check_fault(with(R"("diameter_mm": 1)"), Code::E0404, "tip_in_r_mm");
  const std::string ball = R"("tip_in_r_mm": [0, 0, -100], "diameter_mm": 4)";
  check_fault(with(ball + R"(, "shaft_diameter_mm": 50)"), Code::E0406, "thick");
  CHECK(faults(with(ball + R"(, "shaft_diameter_mm": 4)")).empty());
  check_fault(with(ball + R"(, "head_deg": [1000, 0])"), Code::E0406, "head_deg");
  CHECK(faults(with(ball + R"(, "head_deg": [-360, 360])")).empty());
  check_fault(with(R"("tip_in_r_mm": [0, 0, -1e6], "diameter_mm": 4)"), Code::E0406, "tip_in_r_mm");
  check_fault(with(R"("tip_in_r_mm": [0, 0, -1], "diameter_mm": 1, "material": "cramic")"), Code::E0406, "cramic");
  const std::string tip = R"({"tip_in_r_mm": [0, 0, -1], "diameter_mm": 1})";
  check_fault(small_file(R"("sensors": {"TIP": )" + tip + R"(, "tip": )" + tip + "}"), Code::E0403, "\"tip\"");
  CHECK(parse_machine("m.json", small_file(R"("sensors": {"Tip": )" + tip + "}")).sensors.contains("tIP"));
  check_fault(small_file(R"("probe": {"sd_um": [0.5, -0.5, 0.5]})"), Code::E0406, "sd_um");
  check_fault(small_file(R"("head": {"model": "PH10M"})"), Code::E0404, "angle_sd_arcsec");
}

TEST_CASE("all mistakes of a file are reported at once, by place") {
  const auto found =
      faults(small_file(R"("prob": {}, "head": {"angle_sd_arcsec": {"A": -1, "B": 0}}, "motion": {"speed_mm_s": 0})"));
  REQUIRE(found.size() == 3);
  CHECK(found[0].help.find("probe") != std::string::npos);
  CHECK(found[0].place.line == 3);
}

TEST_CASE("a machine is found by name or by path, or the nearest name is offered") {
  const std::string path = "machine_file_test.json";
  write_whole(path, small_file());
  CHECK(read_machine(path).name == "small");
  std::remove(path.c_str());
  try {
    read_machine("coord3-mc61");
    FAIL("a machine that does not exist was read");
  } catch (const UserError& error) {
    CHECK(error.diagnostics()[0].code == Code::E0411);
    CHECK(error.diagnostics()[0].help.find("coord3-mc16") != std::string::npos);
  }
  CHECK_THROWS_AS(read_machine("no/such/file.json"), UserError);
}

TEST_CASE("a machine without scale positions is usable, with a warning that names those missing") {
  const auto warned = [](const std::string& offsets) {
    const std::vector<Diagnostic> found = machine_warnings(parse_machine("m.json", small_file(offsets)));
    REQUIRE(found.size() == 1);
    CHECK(found[0].code == Code::W0417);
    return found[0].message;
  };
  CHECK(warned("").find("for x, y, z, mount: zero is taken") != std::string::npos);
  CHECK(warned(R"("offsets_mm": {"y": [0, 1, 0], "x": [0, 0, 0]})").find("for z, mount:") != std::string::npos);
  CHECK(machine_warnings(
            parse_machine(
                "m.json",
                small_file(R"("offsets_mm": {"x": [0, 0, 0], "y": [0, 1, 0], "z": [0, 0, 0], "mount": [0, 0, 0]})")))
            .empty());
  for (const std::string& name : shipped_machines()) CHECK(machine_warnings(read_machine(name)).empty());
}

TEST_CASE("test lengths shorter than those of the standard are suspect") {
  Machine machine = read_machine("coord3-mc16");
  machine.specification.longest_share = 0.5;
  const std::vector<Diagnostic> found = machine_warnings(machine);
  REQUIRE(found.size() == 1);
  CHECK(found[0].code == Code::W0419);
  CHECK(found[0].message.find("0.5 of its line, but ISO 10360-2 asks for 0.66") != std::string::npos);
  machine.specification.longest_share = 0.66;
  CHECK(machine_warnings(machine).empty());
}

TEST_CASE("a specification of 2009 states E150, R0 and what the probe does on a sphere") {
  const Machine m = parse_machine("m.json", small_file("", R"("standard": "ISO 10360-2:2009",
    "mpe": {"a_um": 2, "k_um_per_m": 3, "b_um": 3}, "e150_mpe": {"a_um": 2.5, "k_um_per_m": 4}, "r0_mpl_um": 1.8,
    "probing": {"p_form_mpe_um": 2.2, "p_size_mpe_um": 1.1})"));
  const Specification& spec = m.specification;
  CHECK(spec.mpe.at(100) == doctest::Approx(2.3e-3));
  CHECK(spec.mpe.at(1000) == 3e-3);
  REQUIRE((spec.e150_mpe && spec.r0_mpl_mm && spec.form_mpe_mm && spec.size_mpe_mm));
  CHECK(spec.e150_mpe->at(1000) == doctest::Approx(6.5e-3));
  CHECK(*spec.r0_mpl_mm == doctest::Approx(1.8e-3));
  CHECK(*spec.form_mpe_mm == doctest::Approx(2.2e-3));
  CHECK(*spec.size_mpe_mm == doctest::Approx(1.1e-3));
  const Specification plain = parse_machine("m.json", small_file()).specification;
  CHECK(!(plain.e150_mpe || plain.r0_mpl_mm || plain.form_mpe_mm || plain.size_mpe_mm));
}

TEST_CASE("limits that the edition does not know, or that contradict each other, are refused") {
  const std::string mpe = R"("mpe": {"a_um": 2, "k_um_per_m": 3})";
  const std::string old = R"("standard": "ISO 10360-2:2001", )" + mpe;
  check_fault(small_file("", old + R"(, "e150_mpe": {"a_um": 2, "k_um_per_m": 3})"), Code::E0414, "2009");
  check_fault(small_file("", old + R"(, "r0_mpl_um": 2)"), Code::E0414, "r0_mpl_um");
  check_fault(small_file("", R"("mpe": {"a_um": 2, "k_um_per_m": 3, "b_um": 1})"), Code::E0414, "b is 1 um");
  check_fault(small_file("", mpe + R"(, "probing": {"p_form_mpe_um": 0})"), Code::E0406, "p_form_mpe_um");
  check_fault(small_file("", mpe + R"(, "probing": {"p_form_um": 2})"), Code::E0402, "p_form_um");
}

}  // namespace abbe
