#include "engine/machine/geometry.hpp"

#include <algorithm>
#include <cmath>

#include "engine/lanes/elementary.hpp"
#include "engine/lanes/for_lanes.hpp"
#include "engine/lanes/random.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

// The largest absolute value is sought on a grid. 32 points per period of the highest harmonic miss
// the top of that harmonic by at most 1 - cos(pi / 32) = 0.5 % of its amplitude.
constexpr int kPointsPerPeriod = 32;

/// The basis functions on a grid over u in [-1, 1], [basis][point].
struct Grid {
  explicit Grid(int harmonics)
      : points(kPointsPerPeriod * std::max(harmonics, 1) + 1), value(basis_size(harmonics) * points) {
    const int n = points;
    double* const v = value.data();
    for_lanes(n, [=](int i) {
      const double u = 2.0 * i / (n - 1) - 1;
      v[i] = 1;
      v[n + i] = u;
      v[2 * n + i] = 2 * u * u - 1;
    });
    for (int k = 1; k <= harmonics; ++k) {
      double* const row = v + (1 + 2 * k) * n;
      for_lanes(n, [=](int i) {
        const SinCos f = sin_cos_pi(k * v[n + i]);
        row[i] = f.cos;
        row[n + i] = f.sin;
      });
    }
  }
  int points;
  std::vector<double> value;
};

double largest_absolute(const double* f, int n) {
  constexpr int kWays = 8;  // independent chains of comparisons
  double largest[kWays] = {};
  int i = 0;
  for (; i + kWays <= n; i += kWays)
    for (int k = 0; k < kWays; ++k) {
      const double value = std::fabs(f[i + k]);
      largest[k] = value > largest[k] ? value : largest[k];
    }
  for (; i < n; ++i) largest[0] = std::max(largest[0], std::fabs(f[i]));
  return *std::max_element(largest, largest + kWays);
}

/// The shape of one error function (paper eq. 13, 14), zero at home, not yet scaled.
void draw_shape(const ComponentSpec& spec, int harmonics, RandomAddress address, double* c) {
  std::vector<double> share(harmonics), phase(harmonics);
  double sum = 0;
  for (int n = 1; n <= harmonics; ++n) {
    address.draw = static_cast<std::uint32_t>(n);
    const UniformPair u = uniform_pair(address);
    share[n - 1] = u.a;
    phase[n - 1] = 2 * u.b;  // half turns
    sum += u.a;
  }
  const double left = 1 - spec.linear - spec.curvature;
  for (double& a : share) a *= left / sum;
  if (!spec.harmonics.empty()) {
    std::fill(share.begin(), share.end(), 0.0);
    std::copy(spec.harmonics.begin(), spec.harmonics.end(), share.begin());
  }
  c[1] = spec.linear;
  c[2] = spec.curvature;
  double home = -c[1] + c[2];
  for (int n = 1; n <= harmonics; ++n) {
    const SinCos p = sin_cos_pi(phase[n - 1]);
    c[1 + 2 * n] = share[n - 1] * p.cos;
    c[2 + 2 * n] = -share[n - 1] * p.sin;
    home += n % 2 ? -c[1 + 2 * n] : c[1 + 2 * n];
  }
  c[0] = -home;
}

double largest_on_grid(const Grid& grid, int harmonics, const double* c, double* f) {
  const int n = grid.points;
  const double* const v = grid.value.data();
  const double c0 = c[0], c1 = c[1], c2 = c[2];
  for_lanes(n, [=](int i) { f[i] = c0 + c1 * v[n + i] + c2 * v[2 * n + i]; });
  for (int k = 1; k <= harmonics; ++k) {
    const double a = c[1 + 2 * k], b = c[2 + 2 * k];
    const double* const row = v + (1 + 2 * k) * n;
    for_lanes(n, [=](int i) { f[i] += a * row[i] + b * row[n + i]; });
  }
  return largest_absolute(f, n);
}

/// Adds slope * reading to the error function with coefficients c.
void add_linear(const MachineAxis& axis, double slope, double* c) {
  const double half = 0.5 * slope * axis.direction * axis.travel_mm;
  c[0] += half;
  c[1] += half;
}

void add_squareness(const Machine& machine, GeometryCoefficients& coefficients) {
  const std::pair<Component, double> terms[] = {{Component::exy, machine.squareness_cwy_rad},
                                                {Component::exz, machine.squareness_bwz_rad},
                                                {Component::eyz, machine.squareness_awz_rad}};
  for (const auto& [component, squareness] : terms) {
    const MachineAxis& axis = machine[axis_of(component)];
    add_linear(axis, axis.table_side ? -squareness : squareness,
               &coefficients[static_cast<int>(component) * basis_size(machine.harmonics)]);
  }
}

/// u in [-1, 1] of a scale reading.
double normalised(const MachineAxis& axis, double reading_mm) {
  return 2 * axis.direction * reading_mm / axis.travel_mm - 1;
}

Vec3 translation(const AxisErrors& e, Axis axis) {
  const double* v = e.value + 6 * static_cast<int>(axis);
  return {v[0], v[1], v[2]};
}
Vec3 rotation(const AxisErrors& e, Axis axis) {
  const double* v = e.value + 6 * static_cast<int>(axis);
  return {v[3], v[4], v[5]};
}
Vec3 along(Axis axis, double length) {
  Vec3 v;
  v[static_cast<int>(axis)] = length;
  return v;
}

}  // namespace

Vec3 Machine::home_offset() const {
  Vec3 sum = mount_offset_mm;
  for (const Axis axis : ram_chain) sum += (*this)[axis].offset_mm;
  return sum;
}

bool Machine::has_head() const {
  return head.present || std::any_of(sensors.begin(), sensors.end(), [](const auto& named) {
           return named.second.head_a_rad != 0 || named.second.head_b_rad != 0;
         });
}

GeometryCoefficients draw_geometry(const Machine& machine, std::uint64_t seed, std::uint32_t machine_index) {
  const int size = basis_size(machine.harmonics);
  const Grid grid(machine.harmonics);
  std::vector<double> scratch(grid.points);
  GeometryCoefficients coefficients(kComponents * size);
  for (int k = 0; k < kComponents; ++k) {
    const auto component = static_cast<Component>(k);
    const ComponentSpec& spec = machine[component];
    RandomAddress address{seed, machine_index, stream_of("geometry"), static_cast<std::uint32_t>(k), 0, 0};
    double* const c = &coefficients[k * size];
    draw_shape(spec, machine.harmonics, address, c);
    const double e_tot =
        spec.e_max * machine[axis_of(component)].travel_mm * kMPerMm * (2 * uniform_pair(address).a - 1);
    const double scale = e_tot / largest_on_grid(grid, machine.harmonics, c, scratch.data());
    for (int b = 0; b < size; ++b) c[b] *= scale;
  }
  add_squareness(machine, coefficients);
  return coefficients;
}

double error_at(const Machine& machine, const GeometryCoefficients& coefficients, Component component,
                double reading_mm) {
  const double u = normalised(machine[axis_of(component)], reading_mm);
  const double* c = &coefficients[static_cast<int>(component) * basis_size(machine.harmonics)];
  double sum = c[0] + c[1] * u + c[2] * (2 * u * u - 1);
  for (int n = 1; n <= machine.harmonics; ++n)
    sum += c[1 + 2 * n] * std::cos(n * kPi * u) + c[2 + 2 * n] * std::sin(n * kPi * u);
  return sum;
}

AxisLever axis_lever(const Machine& machine, Axis axis) {
  AxisLever lever;
  if (!machine[axis].table_side) {
    lever.offset_mm = machine.mount_offset_mm;
    for (auto later = machine.ram_chain.rbegin(); later != machine.ram_chain.rend() && *later != axis; ++later) {
      lever.offset_mm += machine[*later].offset_mm;
      lever.reach += along(*later, 1);
    }
    return lever;
  }
  lever.sign = -1;
  lever.offset_mm = machine.home_offset();
  for (const Axis carried : machine.ram_chain) lever.reach += along(carried, 1);
  for (const Axis below : machine.table_chain) {
    lever.offset_mm -= machine[below].offset_mm;
    lever.reach += along(below, 1);
    if (below == axis) break;
  }
  return lever;
}

Vec3 geometric_error(const Machine& machine, const AxisErrors& errors, const Vec3& enc_mm, const Vec3& tip_from_mount) {
  Vec3 d;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    const AxisLever lever = axis_lever(machine, axis);
    d += lever.sign * (translation(errors, axis) + cross(rotation(errors, axis), lever.at(enc_mm, tip_from_mount)));
  }
  return d;
}

Vec3 geometric_error_exact(const Machine& machine, const AxisErrors& errors, const Vec3& enc_mm,
                           const Vec3& tip_from_mount) {
  const auto joint = [&](Axis axis, double sign) {
    const Vec3 w = rotation(errors, axis);
    const Mat3 small{{1, w.z, -w.y}, {-w.z, 1, w.x}, {w.y, -w.x, 1}};
    const Vec3 moved = along(axis, sign * enc_mm[static_cast<int>(axis)]);
    return Rigid{small, machine[axis].offset_mm + moved + translation(errors, axis)};
  };
  Rigid X_0M, X_0T;
  Vec3 table_offset;
  for (const Axis axis : machine.ram_chain) X_0M = X_0M * joint(axis, 1);
  for (const Axis axis : machine.table_chain) X_0T = X_0T * joint(axis, -1), table_offset += machine[axis].offset_mm;
  const Vec3 tip_in_0 = X_0M * (machine.mount_offset_mm + tip_from_mount);
  const Vec3 tip_in_W = inverse(X_0T) * tip_in_0 + table_offset;
  return tip_in_W - (enc_mm + machine.home_offset() + tip_from_mount);
}

}  // namespace abbe
