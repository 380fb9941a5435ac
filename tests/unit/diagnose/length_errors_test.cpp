#include "engine/diagnose/baseline/length_errors.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace abbe;
using namespace abbe::diagnose;

namespace {

Machine machine() {
  Machine m;
  m.specification.mpe = {0.002, 0.004e-3};  // 2 um + 4 um/m
  m.probe.sd_mm = {0.0005, 0.0005, 0.0005};
  return m;
}

RecordedTouch touch(double x_mm, double normal_x, double residual_mm) {
  RecordedTouch t;
  t.scene.point = {x_mm, 0, 0};
  t.scene.normal = {normal_x, 0, 0};
  t.scene.stylus.tip_ordinal = 1;
  t.residual_mm = residual_mm;
  return t;
}

/// Three bars of 500 mm, too long by this.
RecordedTouches bars(double error_mm) {
  RecordedTouches t;
  for (int k = 0; k < 3; ++k) {
    t.touches.push_back(touch(0, -1, error_mm / 2));
    t.touches.push_back(touch(500, 1, error_mm / 2));
    for (std::size_t i = t.touches.size() - 2; i < t.touches.size(); ++i) t.touches[i].scene.run = k + 1;
  }
  return t;
}

Vector residuals_um(const RecordedTouches& t) {
  Vector r(static_cast<Eigen::Index>(t.touches.size()));
  for (std::size_t i = 0; i < t.touches.size(); ++i) r(static_cast<Eigen::Index>(i)) = 1e3 * t.touches[i].residual_mm;
  return r;
}

LengthError worst(const RecordedTouches& t) {
  return worst_length(t, residuals_um(t), machine().specification).value_or(LengthError{});
}
bool beyond(const RecordedTouches& t) {
  return beyond_specification(worst_length(t, residuals_um(t), machine().specification), machine()).has_value();
}

}  // namespace

TEST_CASE("a length is wrong by what its ends are too far out along it") {
  const LengthError outside = worst(bars(0.010));
  CHECK(outside.length_mm == doctest::Approx(500));
  CHECK(outside.error_mm == doctest::Approx(0.010));
  CHECK(outside.mpe_mm == doctest::Approx(0.004));
  // faces that look the same way: what both have in common is no error of the length
  RecordedTouches steps = bars(0.010);
  for (RecordedTouch& t : steps.touches) t.scene.normal = {1, 0, 0};
  CHECK(worst(steps).error_mm == doctest::Approx(0));
}

TEST_CASE("lengths of two runs, two setups or across the normals are none") {
  RecordedTouches t = bars(0.010);
  for (std::size_t i = 0; i < t.touches.size(); ++i) t.touches[i].scene.setup = static_cast<int>(i);
  CHECK(worst(t).mpe_mm == 0);
  t = bars(0.010);
  for (RecordedTouch& touch : t.touches) touch.scene.normal = {std::cos(0.02), std::sin(0.02), 0};  // 1.1 degrees
  CHECK(worst(t).mpe_mm == 0);
}

TEST_CASE("where the part stood is no error of a length") {
  RecordedTouches t = bars(0);
  LinearModel m;
  m.y.resize(6), m.free.resize(6, 2);
  for (Eigen::Index i = 0; i < 6; ++i) {
    Vec3& normal = t.touches[static_cast<std::size_t>(i)].scene.normal;
    normal = {normal.x * std::cos(0.01), std::sin(0.01), 0};  // 0.6 degrees
    m.free.row(i) << normal.x, normal.y;
    m.y(i) = 2000 * normal.y;  // the part stood 2 mm beside its targets
  }
  CHECK(worst_length(t, m.y, machine().specification)->error_mm == doctest::Approx(0.04).epsilon(0.001));
  CHECK(worst_length(t, without_placement(m), machine().specification)->error_mm == doctest::Approx(0));
}

TEST_CASE("one and a half MPE and four deviations of two touches are within the specification") {
  const double limit_mm = 1.5 * 0.004 + 4 * 0.0005 * std::sqrt(2.0);
  CHECK(!beyond(bars(0.99 * limit_mm)));
  CHECK(beyond(bars(1.01 * limit_mm)));
  CHECK(beyond(bars(-1.01 * limit_mm)));
  RecordedTouches dirty = bars(0);  // one bad touch spoils one length
  dirty.touches[0].residual_mm = 1;
  CHECK(!beyond(dirty));
}

TEST_CASE("a gross touch does not move the placement that is taken out") {
  LinearModel m;
  m.y = Vector::Zero(40);
  m.free = Matrix::Ones(40, 1);
  for (Eigen::Index i = 0; i < 40; ++i) m.y(i) = i % 2 == 0 ? 0.5 : -0.5;
  const Vector clean = without_placement(m);
  m.y(7) += 500;
  const Vector dirty = without_placement(m);
  CHECK(dirty(7) == doctest::Approx(499.5).epsilon(2e-3));
  for (Eigen::Index i = 0; i < 7; ++i) CHECK(std::abs(dirty(i) - clean(i)) < 0.6);
}
