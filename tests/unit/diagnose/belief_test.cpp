#include "engine/diagnose/findings/belief.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using namespace abbe::diagnose;

TEST_CASE("a gain on touches left out counts beyond its standard error, and where they lie closer") {
  const auto of = [](double gain, double se) { return Improvement{"leave-one-setup-out", gain, se}; };
  CHECK_FALSE(predicts_better(std::nullopt));
  CHECK_FALSE(predicts_better(of(1.4, 4.2)));
  CHECK_FALSE(predicts_better(of(-3, 1)));
  CHECK(predicts_better(of(5.2, 2.2)));
  Improvement farther = of(5.2, 2.2);
  farther.rms_before_um = 0.55, farther.rms_after_um = 0.56;
  CHECK_FALSE(predicts_better(farther));
}

TEST_CASE("of several sizes one must be other than 0, of one that is what was found") {
  const Effect& clamping = *find_effect("part.clamping");
  const auto size = [](const char* name, double low, double high) {
    return DiagnosedParameter{.name = name, .unit = "um", .low = low, .high = high};
  };
  CHECK(none_is_sure(clamping, {size("bow_um", -26, 27), size("twist_um", -1, 17)}));
  CHECK_FALSE(none_is_sure(clamping, {size("bow_um", -26, 27), size("twist_um", 1, 17)}));
  CHECK_FALSE(none_is_sure(clamping, {size("bow_um", -2, 2), size("neutral_mm", -3, 4)}));
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
