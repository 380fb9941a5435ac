#include "engine/diagnose/baseline/rough_geometry.hpp"

#include <doctest/doctest.h>
#include <Eigen/QR>

#include <cmath>

#include "engine/machine/geometry.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr int kTouches = 120;

/// Touches of one face along the whole travel of x.
RecordedTouches along_x(const Machine& machine) {
  RecordedTouches t;
  for (int i = 0; i < kTouches; ++i) {
    RecordedTouch touch;
    touch.scene.reading = {machine[Axis::x].travel_mm * i / (kTouches - 1), 300, -300};
    touch.scene.normal = {1, 0, 0};
    t.touches.push_back(touch);
  }
  return t;
}

double at(int touch) { return -1 + 2.0 * touch / (kTouches - 1); }

/// A bend, and a ripple that no sum of the harmonics follows.
Vector bend() {
  Vector v(kTouches);
  for (int i = 0; i < kTouches; ++i) v(i) = at(i) * at(i);
  return v.array() - v.mean();
}
Vector ripple(const Machine& machine) {
  Matrix harmonics(kTouches, basis_size(machine.harmonics));
  Vector v(kTouches);
  for (int i = 0; i < kTouches; ++i) {
    const double u = at(i);
    harmonics(i, 0) = 1, harmonics(i, 1) = u, harmonics(i, 2) = u * u;
    for (int n = 1; n <= machine.harmonics; ++n)
      harmonics(i, 1 + 2 * n) = std::cos(n * kPi * u), harmonics(i, 2 + 2 * n) = std::sin(n * kPi * u);
    v(i) = std::sin((machine.harmonics + 0.5) * kPi * u);
  }
  return v - harmonics * harmonics.colPivHouseholderQr().solve(v);
}

double variance_of(const Matrix& columns, const Vector& combination) {
  return (columns.transpose() * combination).squaredNorm();
}

}  // namespace

TEST_CASE("of a machine that is known, what its harmonics could not follow is open, and little else") {
  const Machine machine = read_machine("coord3-mc16");
  const RecordedTouches t = along_x(machine);
  const std::size_t exx = 0;
  const Matrix whole = uneven_functions(t, machine)[exx], left = uneven_functions_left(t, machine)[exx];
  REQUIRE(whole.cols() > 0);
  // a fifth of the size, 4 % of the variance
  CHECK(variance_of(left, bend()) / variance_of(whole, bend()) == doctest::Approx(0.04).epsilon(0.1));
  CHECK(variance_of(left, ripple(machine)) / variance_of(whole, ripple(machine)) > 0.9);
  CHECK(variance_of(rough_geometry_left(t, machine), bend()) < 0.05 * variance_of(rough_geometry(t, machine), bend()));
}

TEST_CASE("a bad guide may have several bad error functions, at their full size") {
  const Machine machine = read_machine("coord3-mc16");
  const RecordedTouches t = along_x(machine);
  const std::vector<Matrix> uneven = uneven_functions(t, machine);
  REQUIRE(uneven.size() == kComponents + 3);
  Matrix sum = Matrix::Zero(kTouches, kTouches);
  for (std::size_t c = 0; c < kComponents; ++c)
    if (axis_of(static_cast<Component>(c)) == Axis::x) sum += uneven[c] * uneven[c].transpose();
  const Matrix& guide = uneven[kComponents];
  CHECK((guide * guide.transpose() - sum).norm() < 1e-4 * sum.norm());
}
