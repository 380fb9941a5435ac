#include "engine/diagnose/findings/variant_estimate.hpp"

#include <doctest/doctest.h>

using namespace abbe;
using namespace abbe::diagnose;

namespace {

/// What a jump of the part was estimated as, um, by touches of this information along x, y and z.
struct Jump {
  Jump(const Eigen::Vector3d& um, const Eigen::Vector3d& information) {
    effect = find_effect("part.shift");
    for (int axis = 0; axis < 3; ++axis) variant.columns.push_back({0, axis, unit_um});
    info.g = information.asDiagonal();
    info.u = info.g * um / unit_um;
  }
  VariantEstimate estimate() const { return {*effect, variant, info}; }

  static constexpr double unit_um = 2;
  const Effect* effect = nullptr;
  Variant variant;
  Information info;
};

}  // namespace

TEST_CASE("of parameters that do the same the one that needs no assumed value tells it") {
  const Effect& expansion = *find_effect("thermal.part_expansion");
  Variant v;
  v.columns = {{0, 0, 1, true}, {1, 0, 0.1}};
  Information info;
  info.g = Matrix::Constant(2, 2, 100);
  info.u = Vector::Constant(2, 300);
  const VariantEstimate told(expansion, v, info);
  CHECK_FALSE(told.size(0));
  REQUIRE(told.size(1));
  CHECK(told.size(1)->value == doctest::Approx(0.3).epsilon(0.01));
  v.columns[0].assumed = false;
  CHECK(VariantEstimate(expansion, v, info).size(0));
  CHECK_FALSE(VariantEstimate(expansion, v, info).size(1));
}

TEST_CASE("of parameters that do nearly the same one tells what none does by itself") {
  const Effect& bending = *find_effect("probe.stylus_bending");
  Variant v;
  v.columns = {{0, 0, 1}, {1, 0, 1}};
  const auto estimated = [&](double correlation, double first) {
    Information info;
    info.g.resize(2, 2);
    info.g << 100, 100 * correlation, 100 * correlation, 100;
    info.u = info.g * (Vector(2) << first, 0.8).finished();
    return VariantEstimate(bending, v, info);
  };
  const VariantEstimate alike = estimated(0.98, 0.5);
  CHECK_FALSE(alike.size(0));
  REQUIRE(alike.size(1));
  CHECK(alike.size(1)->value == doctest::Approx(0.98 * 0.5 + 0.8).epsilon(0.01));
  const VariantEstimate apart = estimated(0.5, 0.5);
  CHECK((apart.size(0) && apart.size(1)));
}

TEST_CASE("a motion is told by the directions that the touches see") {
  const Jump jump({0.0, 30.0, 500.0}, {400.0, 400.0, 1e-4});
  const VariantEstimate e = jump.estimate();
  REQUIRE(e.size(0));
  CHECK(e.size(0)->value == doctest::Approx(30).epsilon(0.01));
  CHECK(e.size(0)->u == doctest::Approx(0.1).epsilon(0.01));
  REQUIRE(e.direction());
  CHECK(e.direction()->y == doctest::Approx(1));
  CHECK_FALSE(e.direction()->whole);
}

TEST_CASE("a motion that is seen from everywhere is told as it is") {
  const Jump jump({3.0, 0.0, 4.0}, {400.0, 300.0, 200.0});
  const VariantEstimate e = jump.estimate();
  CHECK(e.size(0)->value == doctest::Approx(5).epsilon(0.01));
  CHECK(e.direction()->x == doctest::Approx(0.6).epsilon(0.01));
  CHECK(e.direction()->z == doctest::Approx(0.8).epsilon(0.01));
  CHECK(e.direction()->whole);
}

TEST_CASE("what no touch sees at all is not told, and makes nothing else less sure") {
  Jump jump({2.0, 1.5, 0.0}, {2.0, 1.0, 1.0});
  jump.variant.columns.pop_back();
  jump.info.g = Matrix(jump.info.g.topLeftCorner(2, 2)), jump.info.u = Vector(jump.info.u.head(2));
  const VariantEstimate e = jump.estimate();
  REQUIRE(e.direction());
  CHECK_FALSE(e.direction()->whole);
  CHECK(e.direction()->x == doctest::Approx(0.8).epsilon(0.05));
  CHECK(e.direction()->y == doctest::Approx(0.6).epsilon(0.05));
}

TEST_CASE("a motion that is hardly seen, from everywhere alike, keeps all its directions") {
  const Jump jump({2.0, 1.5, -1.5}, {2.0, 1.0, 1.5});
  REQUIRE(jump.estimate().direction());
  CHECK(jump.estimate().direction()->whole);
  CHECK(jump.estimate().direction()->u > 0.3);
}
