#include "engine/diagnose/findings/carried.hpp"

#include <doctest/doctest.h>

#include "engine/diagnose/findings/known_effect.hpp"

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("a size beside the range is possible where its uncertainty reaches the range, and is then the end of it") {
  const Effect& bending = *find_effect("probe.stylus_bending");
  const auto force = [&](double value, double u) {
    return nearest_possible(bending, EffectSetting{"probe.stylus_bending", {{"force_N", {value, u, ""}}}});
  };
  const auto value = [](const EffectSetting& setting) { return setting.parameters.at("force_N").value; };
  CHECK(value(force(0.08, 0.02)) == 0.08);
  CHECK(value(force(-0.01, 0.02)) == 0);
  CHECK(plausible(bending, force(-0.01, 0.02)));
  CHECK(value(force(-0.0002, 0.00001)) == -0.0002);  // no force pulls, however small it is
  CHECK_FALSE(plausible(bending, force(-0.0002, 0.00001)));
  CHECK(value(force(2.5, 0.1)) == 2.5);
  CHECK_FALSE(plausible(bending, force(2.5, 0.1)));
}

TEST_CASE("an uncertainty is no larger than the range of its parameter") {
  const Effect& dirt = *find_effect("noise.outliers");
  CHECK(nearest_possible(dirt, EffectSetting{"noise.outliers", {{"share", {0.3, 5, ""}}}}).parameters.at("share").u ==
        0.5);
}

TEST_CASE("sizes that do not go together are made smaller until they do") {
  const Effect& scale = *find_effect("machine.scale_interpolation");
  const EffectSetting steep{
      "machine.scale_interpolation",
      {{"amplitude_um", {2.4, 0.3, ""}}, {"second_um", {0.6, 0.3, ""}}, {"period_um", {20, 0, ""}}}};
  const EffectSetting possible = nearest_possible(scale, steep);
  const double first = possible.parameters.at("amplitude_um").value, second = possible.parameters.at("second_um").value;
  CHECK(2 * 3.14159265358979 * (first + 2 * second) / 20 < 1);
  CHECK(first == doctest::Approx(2.1).epsilon(0.02));
  CHECK(second / first == doctest::Approx(0.25));
}

TEST_CASE("of a sudden change it is said when it begins in the machine file") {
  const auto said_of = [](const char* name, double t0_s) {
    std::vector<DiagnosedParameter> size = {{.name = "amplitude_um", .unit = "um", .value = 4, .u = 0.2},
                                            {.name = "t0_s", .unit = "s", .value = t0_s, .u = 1}};
    Diagnosis out;
    const std::string said = carry(Machine{}, *find_effect(name), size, out);
    CHECK(out.model_effects.size() == 1);
    return said;
  };
  CHECK(said_of("probe.step", 742).find("begins 742 s") != std::string::npos);
  CHECK(said_of("probe.step", 742).find("set t0_s to 0") != std::string::npos);
  CHECK(said_of("machine.step", 742).find("has none of it") != std::string::npos);
  CHECK(said_of("probe.step", 0) == "");
}

TEST_CASE("a sudden change of a later file begins in the machine file as long after the start as it did in that") {
  for (const double begun_s : {700.0, 800.0}) {  // between two files it began before the start of the later one
    std::vector<DiagnosedParameter> size = {{.name = "amplitude_um", .unit = "um", .value = 4, .u = 0.2},
                                            {.name = "t0_s", .unit = "s", .value = 742, .u = 1}};
    Diagnosis out;
    const std::string said = carry(Machine{}, *find_effect("probe.step"), size, out, begun_s);
    CHECK(out.model_effects.front().parameters.at("t0_s").value == std::max(0.0, 742 - begun_s));
    CHECK((said.find("begins 42 s after the start of a program, as in the file in which it came") !=
           std::string::npos) == (begun_s == 700));
    CHECK(size[1].value == 742);
  }
}

TEST_CASE("of what is there in another placement of the part it is said that a program is run in the first") {
  for (const double setup : {0.0, 1.0, 2.0}) {
    std::vector<DiagnosedParameter> size = {{.name = "bow_um", .unit = "um", .value = 4, .u = 0.2},
                                            {.name = "setup", .unit = "code", .value = setup}};
    Diagnosis out;
    const std::string said = carry(Machine{}, *find_effect("part.clamping"), size, out);
    CHECK((said.find("there in setup 2 alone") != std::string::npos) == (setup == 2));
  }
}
