#include "engine/diagnose/findings/belief.hpp"

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

TEST_CASE("a gain on touches left out counts beyond its standard error, and where they lie closer") {
  const auto of = [](double gain, double se) { return Improvement{"leave-one-setup-out", gain, se}; };
  CHECK_FALSE(shown(std::nullopt));
  CHECK_FALSE(shown(of(1.4, 4.2)));
  CHECK_FALSE(shown(of(-3, 1)));
  CHECK(shown(of(5.2, 2.2)));
  Improvement farther = of(5.2, 2.2);
  farther.rms_before_um = 0.55, farther.rms_after_um = 0.56;
  CHECK_FALSE(shown(farther));
}

TEST_CASE("a machine that is none of its specification counts as a mismatch, named or not") {
  Diagnosis in_order;
  in_order.baseline.geometry_scale = 3.5;  // no recording without a mismatch was seen to ask for as much
  CHECK_FALSE(is_mismatch(in_order));
  Diagnosis large = in_order;
  large.baseline.geometry_scale = kOutOfSpecification;
  CHECK(is_mismatch(large));
  large.baseline.known = true;  // times what its file leaves uncertain: that has a limit of its own
  CHECK_FALSE(is_mismatch(large));
  large.beyond_known = large.baseline.geometry_scale;
  CHECK(is_mismatch(large));
  large.judged = Judged::hidden_by_unknowns;
  CHECK_FALSE(is_mismatch(large));
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
