#include "engine/diagnose/baseline/rough_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/model/explanation.hpp"
#include "engine/lanes/random.hpp"
#include "engine/machine/geometry.hpp"

namespace abbe::diagnose {

namespace {

/// So many knots follow the shortest length; half as far apart they follow what harmonics cannot.
constexpr int kKnots = 17, kFineKnots = 33;
/// Lengths of the covariance, in halves of the travel.
constexpr double kLengths[] = {0.25, 0.6, 1.5};
constexpr double kShortLengths[] = {0.25};
/// Standard deviation of a function over its largest value: of a smooth random function of bounded range.
constexpr double kShareOfLargest = 0.3;
/// What an earlier recording leaves open of a rough function, of its size: it was fitted by harmonics, at
/// other touches than these.
constexpr double kNotFollowed = 0.2;

double covariance(double a, double b, std::span<const double> lengths, double line) {
  double sum = 0;
  for (const double length : lengths) {
    const double h = std::sqrt(5.0) * std::abs(a - b) / length;
    sum += (1 + h + h * h / 3) * std::exp(-h) / double(lengths.size());
  }
  return sum + line * line * a * b;
}

/// The functions of u in [-1, 1] that the harmonics of the specification are made of.
Vector harmonics(const Machine& machine, double u) {
  const int size = basis_size(machine.harmonics);
  const double reading_mm = machine[Axis::x].direction * (1 + u) / 2 * machine[Axis::x].travel_mm;
  Vector out(size);
  for (int k = 0; k < size; ++k) {
    GeometryCoefficients unit(static_cast<std::size_t>(kComponents * size), 0.0);
    unit[k] = 1;
    out(k) = error_at(machine, unit, static_cast<Component>(0), reading_mm);
  }
  return out;
}

/// Functions of u in [-1, 1] with unit-size coefficients: at u, less their values at home.
class Functions {
 public:
  Functions(std::span<const double> lengths, double line, int knots = kKnots)
      : lengths_(lengths), line_(line), knots_(knots) {
    Matrix k(knots, knots);
    for (int i = 0; i < knots; ++i)
      for (int j = 0; j < knots; ++j) k(i, j) = covariance(knot(i), knot(j), lengths, line);
    root_ = inverse_root(k + 1e-9 * Matrix::Identity(knots, knots));
    home_ = row(-1);
  }
  int count() const { return knots_; }
  Vector at(double u) const { return row(u) - home_; }

 private:
  double knot(int i) const { return -1 + 2.0 * i / (knots_ - 1); }
  Vector row(double u) const {
    Vector k(knots_);
    for (int i = 0; i < knots_; ++i) k(i) = covariance(u, knot(i), lengths_, line_);
    return root_ * k;
  }
  std::span<const double> lengths_;
  double line_;
  int knots_;
  Matrix root_;
  Vector home_;
};

/// The profile of a wavy rail as `machine.straightness_angle_coupling` draws it, its amplitudes as one over the number of
/// waves, or its slope, whose amplitudes are alike; rms 1, less the value at home.
class RailWaves {
 public:
  enum class Of { profile, slope };
  RailWaves(Of of, int harmonics) : amplitudes_(harmonics) {
    for (int n = 1; n <= harmonics; ++n) amplitudes_(n - 1) = of == Of::profile ? 1.0 / n : 1;
    amplitudes_.normalize();
    home_ = row(-1);
  }
  int count() const { return 2 * static_cast<int>(amplitudes_.size()); }
  Vector at(double u) const { return row(u) - home_; }

 private:
  Vector row(double u) const {
    Vector out(count());
    for (Eigen::Index k = 0; k < amplitudes_.size(); ++k) {
      const double angle = double(k + 1) * kPi * u;
      out(2 * k) = amplitudes_(k) * std::cos(angle), out(2 * k + 1) = amplitudes_(k) * std::sin(angle);
    }
    return out;
  }
  Vector amplitudes_, home_;
};

/// The sums of harmonics that come nearest to functions over the travel: basis x functions.
Matrix nearest_harmonics(const Machine& machine, const Functions& functions) {
  constexpr int kPoints = 201;
  Matrix rows(kPoints, functions.count()), basis(kPoints, basis_size(machine.harmonics));
  for (int i = 0; i < kPoints; ++i) {
    const double u = -1 + 2.0 * i / (kPoints - 1);
    rows.row(i) = functions.at(u);
    basis.row(i) = harmonics(machine, u);
  }
  return least_squares(basis, rows);
}

/// What of functions is no sum of harmonics.
class BeyondHarmonics {
 public:
  BeyondHarmonics(const Machine& machine, std::span<const double> lengths)
      : machine_(machine), functions_(lengths, 0, kFineKnots), followed_(nearest_harmonics(machine, functions_)) {
    home_ = row(-1);
  }
  int count() const { return functions_.count(); }
  Vector at(double u) const { return row(u) - home_; }

 private:
  Vector row(double u) const { return functions_.at(u) - followed_.transpose() * harmonics(machine_, u); }
  const Machine& machine_;
  Functions functions_;
  Matrix followed_;
  Vector home_;
};

/// Of an error function whose functions have coefficients of 1, mm or rad.
double size_of(const Machine& machine, int component) {
  const MachineAxis& a = machine[axis_of(static_cast<Component>(component))];
  return machine.components[component].e_max * a.travel_mm * kMPerMm * kShareOfLargest;
}

/// The columns of each of the 18 error functions.
template <class F>
std::vector<Matrix> error_functions(const RecordedTouches& t, const Machine& machine, const F& functions) {
  std::vector<Matrix> out(kComponents, Matrix::Zero(static_cast<Eigen::Index>(t.touches.size()), functions.count()));
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const TouchScene& s = t.touches[i].scene;
    for (int axis = 0; axis < 3; ++axis) {
      const MachineAxis& a = machine[static_cast<Axis>(axis)];
      const Vector f = functions.at(2 * std::abs(s.reading[axis]) / a.travel_mm - 1);
      for (int c = 0; c < kComponents; ++c) {
        if (axis_of(static_cast<Component>(c)) != static_cast<Axis>(axis)) continue;
        AxisErrors unit;
        unit.value[c] = size_of(machine, c);
        const double um =
            kUmPerMm * dot(s.normal, geometric_error(machine, unit, s.reading, s.stylus.tip_from_mount_mm));
        out[c].row(static_cast<Eigen::Index>(i)) = um * f;
      }
    }
  }
  return out;
}

Matrix together(const std::vector<Matrix>& functions) {
  return side_by_side(functions.front().rows(), pointers_to(functions));
}

/// Of each axis, what a wavy rail makes of the two straightnesses, and of the two angles across them, each time without the
/// other: that straightness and angle have waves is no physics left out, that they have the same ones is.
std::vector<Matrix> wavy_rails(const RecordedTouches& t, const Machine& machine) {
  const std::vector<Matrix> shifted = error_functions(t, machine, RailWaves(RailWaves::Of::profile, machine.harmonics)),
                            tilted = error_functions(t, machine, RailWaves(RailWaves::Of::slope, machine.harmonics));
  constexpr int kOfAxis = 6, kTilts = 3;
  std::vector<Matrix> out;
  for (int axis = 0; axis < 3; ++axis) {
    const int first = kOfAxis * axis, one = (axis + 1) % 3, other = (axis + 2) % 3;
    out.push_back(compressed(side_by_side(shifted[first + one], shifted[first + other])));
    out.push_back(compressed(side_by_side(tilted[first + kTilts + one], tilted[first + kTilts + other])));
  }
  return out;
}

/// The same of what an earlier recording leaves open: a share of every shape, and all that its harmonics
/// could not follow.
std::vector<Matrix> left_open(const RecordedTouches& t, const Machine& machine, std::span<const double> lengths) {
  std::vector<Matrix> out = error_functions(t, machine, Functions(lengths, 0));
  const std::vector<Matrix> beyond = error_functions(t, machine, BeyondHarmonics(machine, lengths));
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = side_by_side(kNotFollowed * out[c], beyond[c]);
  return out;
}

/// What these functions are as harmonics, in columns like those of all error functions side by side.
Matrix as_harmonics(const Machine& machine, const Matrix& nearest) {
  Matrix out = Matrix::Zero(kComponents * nearest.rows(), kComponents * nearest.cols());
  for (int c = 0; c < kComponents; ++c)
    out.block(c * nearest.rows(), c * nearest.cols(), nearest.rows(), nearest.cols()) = size_of(machine, c) * nearest;
  return out;
}

/// Each function by itself, and all functions of an axis together.
std::vector<Matrix> functions_and_guides(const std::vector<Matrix>& functions) {
  std::vector<Matrix> out;
  for (const Matrix& m : functions) out.push_back(compressed(m));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Matrix> guide;
    for (int c = 0; c < kComponents; ++c)
      if (axis_of(static_cast<Component>(c)) == static_cast<Axis>(axis)) guide.push_back(out[c]);
    out.push_back(compressed(together(guide)));
  }
  return out;
}

/// Standard normal, of one machine: functions x error functions.
Matrix normal_draws(std::uint64_t seed, std::uint32_t machine, Eigen::Index functions) {
  constexpr std::uint32_t stream = stream_of("rough geometry");
  const int pairs = static_cast<int>((functions * kComponents + 1) / 2);
  const std::vector<std::uint32_t> machines(static_cast<std::size_t>(pairs), machine);
  std::vector<std::uint32_t> visit(static_cast<std::size_t>(pairs));
  std::iota(visit.begin(), visit.end(), 0);
  std::vector<double> z(2 * static_cast<std::size_t>(pairs));
  normal_pairs(pairs, seed, machines.data(), stream, 0, visit.data(), 0, z.data(), z.data() + pairs);
  return Eigen::Map<const Matrix>(z.data(), functions, kComponents);
}

}  // namespace

RoughGeometry rough_geometry(const RecordedTouches& t, const Machine& machine) {
  constexpr double kLine = 2;
  const Functions functions(kLengths, kLine);
  return {together(error_functions(t, machine, functions)),
          as_harmonics(machine, nearest_harmonics(machine, functions))};
}

RoughMachines rough_machines(const Machine& machine, std::uint64_t seed, int count, int threads) {
  RoughMachines out{machine, {}};
  out.machine.harmonics = std::max(machine.harmonics, kKnots - 1);
  Machine straight = out.machine;  // but for its squarenesses
  for (ComponentSpec& component : straight.components) component.e_max = 0;
  const GeometryCoefficients known = draw_geometry(straight, seed, 0);
  const Matrix nearest = nearest_harmonics(out.machine, Functions(kLengths, 0));
  const Specification& spec = machine.specification;
  VirtualMachines& all = out.machines;
  all.index.resize(count), all.v.resize(count), all.geometry.resize(count, known);
  std::iota(all.index.begin(), all.index.end(), 0);
  on_threads(count, threads, [&](int i) {
    Matrix functions = nearest * normal_draws(seed, all.index[i], nearest.cols());  // basis x error functions
    for (int c = 0; c < kComponents; ++c) functions.col(c) *= size_of(machine, c);
    const double share = uniform_pair({seed, all.index[i], stream_of("rough geometry"), 1, 0, 0}).a;
    all.v[i] = 1 / (share / spec.v_min + (1 - share) / spec.v_max);
    const GeometryCoefficients drawn(functions.data(), functions.data() + functions.size());
    const double v = virtual_acceptance_test(out.machine, drawn).v;
    const double factor = std::isfinite(v) ? v / all.v[i] : 0;  // of a machine without errors there is nothing to size
    for (std::size_t k = 0; k < drawn.size(); ++k) all.geometry[i][k] += factor * drawn[k];
  });
  return out;
}

std::vector<Matrix> uneven_functions(const RecordedTouches& t, const Machine& machine) {
  std::vector<Matrix> out = functions_and_guides(error_functions(t, machine, Functions(kShortLengths, 0)));
  for (Matrix& rail : wavy_rails(t, machine)) out.push_back(std::move(rail));
  return out;
}

RoughGeometry rough_geometry_left(const RecordedTouches& t, const Machine& machine) {
  const Functions functions(kLengths, 0);
  const Matrix nearest =
      side_by_side(kNotFollowed * nearest_harmonics(machine, functions),  // of the columns of left_open
                   Matrix::Zero(basis_size(machine.harmonics), kFineKnots));
  return {together(left_open(t, machine, kLengths)), as_harmonics(machine, nearest)};
}

std::vector<Matrix> uneven_functions_left(const RecordedTouches& t, const Machine& machine) {
  std::vector<Matrix> out = functions_and_guides(left_open(t, machine, kShortLengths));
  for (const Matrix& rail : wavy_rails(t, machine)) out.push_back(kNotFollowed * rail);
  return out;
}

}  // namespace abbe::diagnose
