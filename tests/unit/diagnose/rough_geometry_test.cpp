#include "engine/diagnose/baseline/rough_geometry.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "engine/diagnose/baseline/baseline.hpp"
#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/model/evidence.hpp"
#include "engine/machine/geometry.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr int kOnGuide = 120;

/// Touches of one face along the whole travel of x.
RecordedTouches along_x(const Machine& machine) {
  RecordedTouches t;
  for (int i = 0; i < kOnGuide; ++i) {
    RecordedTouch touch;
    touch.scene.reading = {machine[Axis::x].travel_mm * i / (kOnGuide - 1), 300, -300};
    touch.scene.normal = {1, 0, 0};
    t.touches.push_back(touch);
  }
  return t;
}

double at(int touch) { return -1 + 2.0 * touch / (kOnGuide - 1); }

/// A bend, and a ripple that no sum of the harmonics follows.
Vector bend() {
  Vector v(kOnGuide);
  for (int i = 0; i < kOnGuide; ++i) v(i) = at(i) * at(i);
  return v.array() - v.mean();
}
Vector ripple(const Machine& machine) {
  Matrix harmonics(kOnGuide, basis_size(machine.harmonics));
  Vector v(kOnGuide);
  for (int i = 0; i < kOnGuide; ++i) {
    const double u = at(i);
    harmonics(i, 0) = 1, harmonics(i, 1) = u, harmonics(i, 2) = u * u;
    for (int n = 1; n <= machine.harmonics; ++n)
      harmonics(i, 1 + 2 * n) = std::cos(n * kPi * u), harmonics(i, 2 + 2 * n) = std::sin(n * kPi * u);
    v(i) = std::sin((machine.harmonics + 0.5) * kPi * u);
  }
  return v - harmonics * least_squares(harmonics, v);
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
  CHECK(variance_of(rough_geometry_left(t, machine).um, bend()) <
        0.05 * variance_of(rough_geometry(t, machine).um, bend()));
}

TEST_CASE("what rough functions are as harmonics does what they do, but for what no harmonics follow") {
  const Machine machine = read_machine("coord3-mc16");
  const RecordedTouches t = along_x(machine);
  const int size = kComponents * basis_size(machine.harmonics);
  const KnownGeometry sampled{Vector::Zero(size), Matrix::Identity(size, size)};
  for (const bool is_known : {false, true}) {
    CAPTURE(is_known);
    const Baseline b = baseline_of(t, machine, {.known = is_known ? &sampled : nullptr, .sampled = &sampled});
    const Matrix followed = b.geometry_um * b.rough_factor;
    REQUIRE(followed.cols() == b.model.rough.cols());
    CHECK(variance_of(followed, ripple(machine)) < 1e-6 * variance_of(b.model.rough, ripple(machine)));
    CHECK(variance_of(followed, bend()) == doctest::Approx(variance_of(b.model.rough, bend())).epsilon(1e-3));
  }
}

TEST_CASE("a bad guide may have several bad error functions, at their full size") {
  const Machine machine = read_machine("coord3-mc16");
  const RecordedTouches t = along_x(machine);
  const std::vector<Matrix> uneven = uneven_functions(t, machine);
  constexpr int kGuides = 3, kRails = 2 * 3;
  REQUIRE(uneven.size() == kComponents + kGuides + kRails);
  Matrix sum = Matrix::Zero(kOnGuide, kOnGuide);
  for (std::size_t c = 0; c < kComponents; ++c)
    if (axis_of(static_cast<Component>(c)) == Axis::x) sum += uneven[c] * uneven[c].transpose();
  const Matrix& guide = uneven[kComponents];
  CHECK((guide * guide.transpose() - sum).norm() < 1e-4 * sum.norm());
}

namespace {

/// Touches along x of faces towards all sides, with a short and a long stylus, and what a rail of these waves does to
/// them: what its profile does, and what its slope does, um.
struct OnRail {
  RecordedTouches t;
  Vector shifted, tilted;
};
OnRail on_wavy_rail(const Machine& machine, double bearing_base_mm) {
  const double travel = machine[Axis::x].travel_mm;
  const auto profile = [&](double x) { return 2 * std::sin(2 * kPi * x / travel) + std::cos(4 * kPi * x / travel); };
  OnRail out;
  std::vector<double> shifted, tilted;
  for (const double length : {50.0, 350.0})
    for (const int faces : {0, 1, 2})
      for (int i = 0; i < kOnGuide; ++i) {
        RecordedTouch touch;
        const double x = travel * i / (kOnGuide - 1);
        touch.scene.reading = {x, 300, -300};
        touch.scene.normal[faces] = 1;
        touch.scene.stylus.tip_from_mount_mm = {0, 0, -length};
        touch.scene.travel_length_mm = {travel, machine[Axis::y].travel_mm, machine[Axis::z].travel_mm};
        touch.scene.lever_mm[0] =
            axis_lever(machine, Axis::x).at(touch.scene.reading, touch.scene.stylus.tip_from_mount_mm);
        out.t.touches.push_back(touch);
        const double front = profile(x + bearing_base_mm / 2), back = profile(x - bearing_base_mm / 2);
        const Vec3 rail{0, 1, 1};  // the same in both directions
        const Vec3 slope = (front - back) / bearing_base_mm * rail;
        shifted.push_back((front + back) / 2 * rail[faces]);
        tilted.push_back(dot(touch.scene.normal, cross(cross(Vec3{1, 0, 0}, slope), touch.scene.lever_mm[0])));
      }
  out.t.known = out.t.varying = static_cast<unsigned>(Covariate::position);
  const auto n = static_cast<Eigen::Index>(shifted.size());
  out.shifted = Eigen::Map<const Vector>(shifted.data(), n);
  out.tilted = Eigen::Map<const Vector>(tilted.data(), n);
  return out;
}

/// What speaks for a coupling of straightness and angle in these touches, nats.
double belief_in_coupling(const OnRail& rail, const Vector& y, std::vector<Matrix> uneven) {
  const Eigen::Index n = y.size();
  LinearModel m;
  m.y = y;
  for (Eigen::Index i = 0; i < n; ++i) m.y(i) += 0.3 * std::sin(1e3 * double(i * i));
  m.free = m.random = Matrix::Ones(n, 1);
  m.random_group.assign(1, 0);
  m.uneven = std::move(uneven);
  m.noise_um = Vector::Constant(n, 0.3);
  m.noise_group.assign(static_cast<std::size_t>(n), 0);
  m.follows.assign(static_cast<std::size_t>(n), 0);
  Hyperparameters h;
  h.noise = Vector::Ones(1);
  std::vector<int> rows(static_cast<std::size_t>(n));
  std::iota(rows.begin(), rows.end(), 0);
  const Explanations coupling = named_explanations(rail.t, rows, {"machine.straightness_angle_coupling"});
  return EvidenceSearch(m, h, coupling).evidence().log_bayes[0];
}

}  // namespace

TEST_CASE("waves of straightness or of angles alone are no coupling of both") {
  const Machine machine = read_machine("coord3-mc16");
  const OnRail rail = on_wavy_rail(machine, 300);
  const std::vector<Matrix> uneven = uneven_functions(rail.t, machine);
  CHECK(belief_in_coupling(rail, rail.shifted, {}) > 100);
  CHECK(belief_in_coupling(rail, rail.shifted, uneven) < 2);
  const Vector tilted = 0.4 * rail.tilted;  // as large as angles of this machine may be
  CHECK(belief_in_coupling(rail, tilted, {}) > 100);
  CHECK(belief_in_coupling(rail, tilted, uneven) < 2);
  CHECK(belief_in_coupling(rail, rail.shifted + rail.tilted, uneven) > 20);
}
