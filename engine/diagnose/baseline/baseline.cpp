#include "engine/diagnose/baseline/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/diagnose/baseline/rough_geometry.hpp"
#include "engine/diagnose/model/projection.hpp"
#include "engine/machine/geometry.hpp"
#include "engine/machine/screening.hpp"

namespace abbe::diagnose {

namespace {

/// Standard deviation of a qualified tip centre, over that of the probe: a sphere of eight touches (3 / 8 of
/// the variance of one).
constexpr double kQualificationShare = 0.6;
/// Machines that the covariance of the coefficients is taken from.
constexpr int kEnsemble = 800;

/// Sensitivities of the touches to every coefficient: a block of perturbed machines, the k-th with coefficient k of 1.
Matrix perturbed_machines(const RecordedTouches& t, const Machine& machine) {
  const int size = kComponents * basis_size(machine.harmonics);
  std::vector<GeometryCoefficients> perturbed(size, GeometryCoefficients(size, 0.0));
  std::vector<const GeometryCoefficients*> lanes;
  for (int k = 0; k < size; ++k) perturbed[k][k] = 1, lanes.push_back(&perturbed[k]);
  const GeometryBlock block(machine, lanes);
  std::vector<int> lane(size);
  std::iota(lane.begin(), lane.end(), 0);
  Matrix out(t.touches.size(), size);
  std::vector<double> enc[3], tip[3], d[3];
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const TouchScene& s = t.touches[i].scene;
    for (int k = 0; k < 3; ++k) {
      enc[k].assign(size, s.reading[k]);
      tip[k].assign(size, s.stylus.tip_from_mount_mm[k]);
      d[k].assign(size, 0.0);
    }
    const double* const encoders[3] = {enc[0].data(), enc[1].data(), enc[2].data()};
    const double* const tips[3] = {tip[0].data(), tip[1].data(), tip[2].data()};
    double* const errors[3] = {d[0].data(), d[1].data(), d[2].data()};
    block.add_error(size, lane.data(), encoders, tips, errors);
    for (int k = 0; k < size; ++k) out(i, k) = kUmPerMm * dot(s.normal, {d[0][k], d[1][k], d[2][k]});
  }
  return out;
}

/// Mean and covariance of the coefficients over screened machines. The 18 functions are drawn independently,
/// so their covariances are taken apart; what the screening couples between them is small and would drown in
/// the noise of the sample.
KnownGeometry ensemble(const Machine& machine, std::uint64_t seed, int threads) {
  const VirtualMachines sample = screened_machines(machine, seed, kEnsemble, threads);
  const int basis = basis_size(machine.harmonics), size = kComponents * basis;
  Matrix values(sample.size(), size);
  for (int i = 0; i < sample.size(); ++i)
    for (int k = 0; k < size; ++k) values(i, k) = sample.geometry[i][k];
  KnownGeometry out{values.colwise().mean(), Matrix::Zero(size, size)};
  values.rowwise() -= out.mean.transpose();
  for (int c = 0; c < kComponents; ++c) {
    const Matrix part = values.middleCols(c * basis, basis);
    out.factor.block(c * basis, c * basis, basis, basis) =
        factor_of(part.transpose() * part / double(sample.size() - 1));
  }
  return out;
}

/// Grows a matrix by columns.
class Columns {
 public:
  explicit Columns(Eigen::Index rows) : rows_(rows) {}
  Vector& add() { return list_.emplace_back(Vector::Zero(rows_)); }
  void add(const Matrix& m) {
    for (Eigen::Index k = 0; k < m.cols(); ++k) list_.emplace_back(m.col(k));
  }
  int count() const { return static_cast<int>(list_.size()); }
  Matrix joined() const {
    Matrix m(rows_, list_.size());
    for (std::size_t k = 0; k < list_.size(); ++k) m.col(k) = list_[k];
    return m;
  }

 private:
  Eigen::Index rows_;
  std::vector<Vector> list_;
};

/// The six unknowns of each placement of the part, about the middle of its touches.
void add_poses(const RecordedTouches& t, Columns& free) {
  std::map<int, std::vector<int>> setups;
  for (std::size_t i = 0; i < t.touches.size(); ++i) setups[t.touches[i].scene.setup].push_back(static_cast<int>(i));
  for (const auto& [setup, rows] : setups) {
    Vec3 middle;
    double extent = 1;
    for (const int i : rows) middle += t.touches[i].scene.point / double(rows.size());
    for (const int i : rows) extent = std::max(extent, norm(t.touches[i].scene.point - middle));
    for (int k = 0; k < 3; ++k) {
      Vector& shift = free.add();
      for (const int i : rows) shift(i) = t.touches[i].scene.normal[k];
      Vector& turn = free.add();
      for (const int i : rows) {
        const Vec3 arm = (t.touches[i].scene.point - middle) / extent;
        turn(i) = cross(arm, t.touches[i].scene.normal)[k];
      }
    }
  }
}

/// By touch: the surface that has a place of its own where nobody knows it.
std::vector<int> unknown_surfaces(const RecordedTouches& t, Surfaces surfaces) {
  if (surfaces == Surfaces::unknown) return surface_points(t);
  std::vector<int> features;
  for (const RecordedTouch& touch : t.touches) features.push_back(touch.scene.feature);
  return features;
}

/// Errors of the head by indexing visit, and of the qualified tip by stylus and orientation.
void add_head(const RecordedTouches& t, const Machine& machine, Columns& random) {
  std::map<int, std::vector<int>> visits;
  std::map<std::tuple<int, double, double, int>, std::vector<int>> qualified;
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const TouchScene& s = t.touches[i].scene;
    if (s.stylus.indexed) visits[s.visit].push_back(static_cast<int>(i));
    qualified[{s.stylus.ordinal, s.stylus.head_a_rad, s.stylus.head_b_rad, s.qualification}].push_back(
        static_cast<int>(i));
  }
  const auto along = [&](int i, const Vec3& shift_mm) { return kUmPerMm * dot(t.touches[i].scene.normal, shift_mm); };
  for (const auto& [visit, rows] : visits) {
    std::vector<std::pair<double, Vec3 RecordedTouch::*>> angles;
    if (machine.head.sd_a_rad > 0) angles.emplace_back(machine.head.sd_a_rad, &RecordedTouch::per_rad_a_mm);
    if (machine.head.sd_b_rad > 0) angles.emplace_back(machine.head.sd_b_rad, &RecordedTouch::per_rad_b_mm);
    if (rows.size() == 1 && !angles.empty()) {  // the two angles move one touch as one of their joint size does
      double square = 0;
      for (const auto& [sd, per_rad] : angles) square += std::pow(sd * along(rows[0], t.touches[rows[0]].*per_rad), 2);
      random.add()(rows[0]) = std::sqrt(square);
      continue;
    }
    for (const auto& [sd, per_rad] : angles) {
      Vector& column = random.add();
      for (const int i : rows) column(i) = sd * along(i, t.touches[i].*per_rad);
    }
  }
  const double probe_um = kUmPerMm * norm(machine.probe.sd_mm) / std::sqrt(3.0);
  for (const auto& [which, rows] : qualified) {
    for (int k = 0; k < 3; ++k) {
      Vector& column = random.add();
      for (const int i : rows) column(i) = kQualificationShare * probe_um * t.touches[i].scene.normal[k];
    }
  }
}

/// Rows with one stylus have a common noise, where there are enough of them to estimate it.
void group_noise(const RecordedTouches& t, const Machine& machine, Baseline& out) {
  constexpr int kEnough = 40;
  LinearModel& m = out.model;
  std::map<std::pair<double, double>, std::vector<int>> styli;
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const StylusScene& s = t.touches[i].scene.stylus;
    styli[{std::round(s.length_mm), s.radius_mm}].push_back(static_cast<int>(i));
  }
  const bool apart =
      std::all_of(styli.begin(), styli.end(), [](const auto& s) { return int(s.second.size()) >= kEnough; });
  m.noise_group.assign(t.touches.size(), 0);
  m.noise_groups = 0;
  for (const auto& [stylus, rows] : styli) {
    if (apart || m.noise_groups == 0) {
      ++m.noise_groups;
      out.noise_names.push_back(apart ? std::string(t.touches[rows[0]].scene.stylus.name) : "");
    }
    for (const int i : rows) m.noise_group[i] = m.noise_groups - 1;
  }
  m.noise_um.resize(t.touches.size());
  constexpr double kLeast_um = 0.01;
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const Vec3 n = transpose(t.touches[i].scene.stylus.R_WR) * t.touches[i].scene.normal;
    const Vec3 sd = machine.probe.sd_mm;
    m.noise_um(i) = std::max(kLeast_um, kUmPerMm * norm(Vec3{n.x * sd.x, n.y * sd.y, n.z * sd.z}));
  }
}

}  // namespace

Baseline baseline_of(const RecordedTouches& t, const Machine& machine, const BaselineOptions& options) {
  const auto n = static_cast<Eigen::Index>(t.touches.size());
  Baseline out;
  LinearModel& m = out.model;
  Columns free(n), random(n);
  add_poses(t, free);
  if (options.surfaces != Surfaces::calibrated) free.add(indicator(unknown_surfaces(t, options.surfaces)));
  out.geometry_um = perturbed_machines(t, machine);
  const KnownGeometry known = options.known ? *options.known
      : options.sampled                     ? *options.sampled
                                            : ensemble(machine, options.seed, options.threads);
  out.mean = known.mean;
  out.factor = known.factor;
  out.surfaces = options.surfaces;
  const Matrix geometry = out.geometry_um * known.factor;
  random.add(geometry);
  m.random_group.assign(random.count(), 0);
  add_head(t, machine, random);
  m.random_group.resize(random.count(), 1);
  m.free = free.joined();
  m.random = random.joined();
  if (!options.known) {
    RoughGeometry rough = rough_geometry(t, machine);
    m.rough = std::move(rough.um);
    out.rough_factor = std::move(rough.harmonics);
    m.uneven = uneven_functions(t, machine);
  } else {
    m.scale_spread = 0.3;  // an earlier recording has found the scale
    // what that left open may be wrong by some tens of per cent, not by a multiple: that is another machine
    m.largest_scale = 2;
    const RoughGeometry rough = rough_geometry_left(t, machine);
    m.rough = side_by_side(geometry, rough.um);
    out.rough_factor = side_by_side(known.factor, rough.harmonics);
    m.uneven = uneven_functions_left(t, machine);
  }
  m.y.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) m.y(i) = kUmPerMm * t.touches[i].residual_mm;
  m.y -= out.geometry_um * out.mean;
  group_noise(t, machine, out);
  m.follows.assign(n, 0);
  for (Eigen::Index i = 1; i < n; ++i) {
    const TouchScene &a = t.touches[i - 1].scene, &b = t.touches[i].scene;
    m.follows[i] = a.stylus.ordinal == b.stylus.ordinal && a.setup == b.setup && a.run == b.run &&
        m.noise_group[i] == m.noise_group[i - 1];
  }
  return out;
}

KnownGeometry posterior(const Baseline& b, const Hyperparameters& h, Errors errors) {
  const LinearModel m = errors == Errors::rough ? rougher(b.model) : b.model;
  const Matrix& factor = errors == Errors::rough ? b.rough_factor : b.factor;
  const Projection project(m, h);
  const Matrix z = project(m.random);
  Matrix precision = z.transpose() * z;
  for (Eigen::Index k = 0; k < precision.rows(); ++k)
    precision(k, k) += m.random_group[k] == 0 ? 1 / (h.scale * h.scale) : 1;
  const Cholesky root(precision);
  const Vector mean = root.solve(Vector(z.transpose() * project(m.y)));
  const Eigen::Index size = factor.cols();
  return {b.mean + factor * mean.head(size), no_wider(factor * factor_of(root.inverse().topLeftCorner(size, size)))};
}

}  // namespace abbe::diagnose
