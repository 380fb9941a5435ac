// What the machine file says of scatter and of uncertain sizes is in the baseline as large as it says.
#include "engine/diagnose/baseline/machine_effects.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose/scattered.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// The baseline of scattered touches with a probe of 0.5 um, and with these effects in the machine file.
Baseline with_effects(const RecordedTouches& t, const std::vector<EffectSetting>& effects) {
  const auto rows = static_cast<Eigen::Index>(t.touches.size());
  Baseline b;
  b.model.y = Vector::Zero(rows);
  b.model.random.resize(rows, 0);
  b.model.noise_um = Vector::Constant(rows, 0.5);
  add_uncertainties(EffectSet(effects, EffectUse::left_in, "m.json"), t, b);
  return b;
}

}  // namespace

TEST_CASE("scatter in the machine file is noise of every touch, as its own standard deviation") {
  const RecordedTouches t = scattered(40);
  const double step_um = 3;
  const Baseline rounded = with_effects(t, {{"noise.resolution", {{"resolution_um", {step_um, 0, ""}}}}});
  const Baseline shaken = with_effects(t, {{"noise.vibration", {{"sd_um", {0.8, 0, ""}}}}});
  for (Eigen::Index i = 0; i < 40; ++i) {
    // JCGM 100 F.2.2.1: a step over the root of twelve
    CHECK(rounded.model.noise_um(i) == doctest::Approx(std::hypot(0.5, step_um / std::sqrt(12.0))).epsilon(1e-4));
    CHECK(shaken.model.noise_um(i) == doctest::Approx(std::hypot(0.5, 0.8)).epsilon(1e-6));
  }
  CHECK(rounded.model.random.cols() == 0);
}

TEST_CASE("outliers in the machine file make no touch less certain") {
  const Baseline b =
      with_effects(scattered(40), {{"noise.outliers", {{"share", {0.3, 0, ""}}, {"size_um", {50, 0, ""}}}}});
  CHECK((b.model.noise_um.array() == 0.5).all());
  CHECK(b.model.random.cols() == 0);
}

TEST_CASE("an uncertain size is one column, what is drawn at every visit one for each visit that keeps its scale") {
  RecordedTouches t = scattered(45, 15);
  const Baseline radius = with_effects(t, {{"probe.tip_radius", {{"amplitude_um", {2, 0.3, ""}}}}});
  REQUIRE(radius.model.random.cols() == 1);
  CHECK((radius.model.random.col(0).cwiseAbs().array() - 0.3).abs().maxCoeff() < 1e-9);
  const Baseline indexed = with_effects(t, {{"head.reindexing", {{"sd_urad", {0.5, 0, ""}}}}});
  // two angles in three visits; in the first the stylus stands along one of the axes, and does not move
  REQUIRE(indexed.model.random.cols() == 5);
  CHECK(indexed.model.random_group == std::vector<int>(5, 1));
  for (Eigen::Index k = 0; k < 5; ++k) CHECK((indexed.model.random.col(k).array() != 0).count() <= 15);
}
