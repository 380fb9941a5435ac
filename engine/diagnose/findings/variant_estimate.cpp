#include "engine/diagnose/findings/variant_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "engine/diagnose/levels.hpp"
#include "engine/math/normal.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

namespace {

/// The part of the information on some columns that others do not share, of the whole; none where there is no
/// information.
double own_share(const Matrix& g, const std::vector<Eigen::Index>& columns, const std::vector<Eigen::Index>& others) {
  const Matrix all = g(columns, columns);
  if (all.trace() * kWidest * kWidest < 1) return 0;  // nothing beside what it is believed to be before
  if (others.empty()) return 1;
  const Matrix cross = g(others, columns), theirs = g(others, others);
  return (all - cross.transpose() * Cholesky(theirs, 1 / (kWidest * kWidest)).solve(cross)).trace() / all.trace();
}

/// Columns that say something of their own: of parameters that do the same, those of the first, `later` after the others.
/// Draws are no parameters.
std::vector<Eigen::Index> telling(const Variant& variant, const Matrix& g, const std::set<int>& later) {
  std::map<std::pair<bool, int>, std::vector<Eigen::Index>> by_parameter;
  for (std::size_t k = 0; k < variant.columns.size() && !variant.joined; ++k) {
    const int parameter = variant.columns[k].parameter;
    by_parameter[{later.contains(parameter), parameter}].push_back(static_cast<Eigen::Index>(k));
  }
  std::vector<Eigen::Index> kept;
  for (const auto& [parameter, columns] : by_parameter)
    if (own_share(g, columns, kept) > kInseparable) kept.insert(kept.end(), columns.begin(), columns.end());
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// Takes out of a motion, directions by phases, and of its covariance what the touches say nothing of: a direction
/// whose uncertainty is far larger than that of another, and not small beside the rest of the motion. Its noise would
/// hide a motion that is told well. Whether every direction is told.
bool keep_told_directions(Matrix& motion, Matrix& covariance) {
  constexpr double kSmall = 0.5, kFar = 5, kNone = 1e-12;
  const Eigen::Index directions = motion.rows(), phases = motion.cols();
  for (;;) {
    Matrix of_directions = Matrix::Zero(directions, directions);
    for (Eigen::Index f = 0; f < phases; ++f)
      of_directions += covariance.block(f * directions, f * directions, directions, directions);
    // Those that were taken out, or that no touch sees at all, have no variance.
    const auto [variance, axes] = spectrum(of_directions);
    const double largest = variance(directions - 1);
    Eigen::Index first = 0;
    while (first < directions - 1 && variance(first) <= kNone * largest) ++first;
    const Vector worst = axes.col(directions - 1);
    const Matrix keep = Matrix::Identity(directions, directions) - worst * worst.transpose();
    if (first == directions - 1 || largest <= kFar * kFar * variance(first) ||
        std::sqrt(largest) <= kSmall * (keep * motion).norm())
      return first == 0;
    motion = keep * motion;
    for (Eigen::Index f = 0; f < phases; ++f) {
      auto rows = covariance.middleRows(f * directions, directions);
      rows = Matrix(keep * rows);
      auto columns = covariance.middleCols(f * directions, directions);
      columns = Matrix(columns * keep);
    }
  }
}

}  // namespace

VariantEstimate::VariantEstimate(const Effect& effect, const Variant& variant, const Information& info)
    : effect_(effect),
      variant_(variant),
      mean_(Vector::Zero(info.u.size())),
      covariance_(Matrix::Zero(info.u.size(), info.u.size())) {
  for (const Column& c : variant.columns)
    directions_ = std::max(directions_, c.part % 3 > 0 ? 3 : 1), phases_ = std::max(phases_, c.part / 3 + 1);
  std::set<int> later;
  for (const Column& c : variant.columns)
    if (c.assumed) later.insert(c.parameter);
  solve(info, later);
  // What a parameter cannot be, one that does the same to these touches may: a force is never negative, its change is.
  std::set<int> impossible;
  for (std::size_t k = 0; k < variant.columns.size(); ++k) {
    const int p = variant.columns[k].parameter;
    if (p < 0 || directions_ * phases_ > 1) continue;
    const EffectParameter& parameter = effect.parameters[p];
    const auto at = static_cast<Eigen::Index>(k);
    const double size = variant.columns[k].unit * mean_(at),
                 u = variant.columns[k].unit * std::sqrt(covariance_(at, at));
    if (size + kNormal95 * u < parameter.low || size - kNormal95 * u > parameter.high) impossible.insert(p);
  }
  if (!impossible.empty()) {
    later.merge(impossible);
    solve(info, later);
  }
  if (const std::optional<int> one = one_for_all(info)) solve(info, {}, one);
}

std::optional<int> VariantEstimate::one_for_all(const Information& info) const {
  constexpr double kCertain = 5;  // standard deviations of all together
  if (directions_ * phases_ > 1 || variant_.joined) return std::nullopt;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < mean_.size(); ++k)
    if (covariance_(k, k) > 0) kept.push_back(k);
  if (kept.size() < 2) return std::nullopt;
  const auto explains = [&](Eigen::Index k) { return info.u(k) * info.u(k) / info.g(k, k); };
  for (const Eigen::Index k : kept)
    if (std::abs(mean_(k)) > kNormal95 * std::sqrt(covariance_(k, k))) return std::nullopt;
  if (mean_.dot(info.u) < kCertain * kCertain) return std::nullopt;
  return variant_
      .columns[static_cast<std::size_t>(*std::max_element(
          kept.begin(), kept.end(), [&](Eigen::Index a, Eigen::Index b) { return explains(a) < explains(b); }))]
      .parameter;
}

Vector VariantEstimate::shift_um() const { return variant_.signature * mean_; }

void VariantEstimate::solve(const Information& info, const std::set<int>& later, std::optional<int> only) {
  mean_.setZero(), covariance_.setZero();
  std::vector<Eigen::Index> kept = telling(variant_, info.g, later);
  if (only) std::erase_if(kept, [&](Eigen::Index k) { return variant_.columns[k].parameter != *only; });
  const Eigen::Map<const Eigen::Array<Eigen::Index, Eigen::Dynamic, 1>> at(kept.data(), std::ssize(kept));
  const Cholesky root(info.g(at, at), 1 / (kWidest * kWidest));
  mean_(at) = root.solve(Vector(info.u(at)));
  covariance_(at, at) = root.inverse();
}

std::optional<VariantEstimate::Motion> VariantEstimate::motion(int parameter) const {
  Matrix m = Matrix::Zero(directions_, phases_);
  std::vector<Eigen::Index> column(static_cast<std::size_t>(directions_ * phases_), -1);
  double unit = 0;
  for (std::size_t k = 0; k < variant_.columns.size(); ++k) {
    const Column& c = variant_.columns[k];
    if (c.parameter != parameter || covariance_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) == 0)
      continue;
    unit = c.unit;
    m(c.part % 3, c.part / 3) = unit * mean_(static_cast<Eigen::Index>(k));
    column[c.part % 3 + directions_ * (c.part / 3)] = static_cast<Eigen::Index>(k);
  }
  if (unit == 0) return std::nullopt;
  Motion out;
  out.covariance = Matrix::Zero(m.size(), m.size());
  for (Eigen::Index i = 0; i < m.size(); ++i)
    for (Eigen::Index j = 0; j < m.size(); ++j)
      if (column[i] >= 0 && column[j] >= 0) out.covariance(i, j) = unit * unit * covariance_(column[i], column[j]);
  out.whole = keep_told_directions(m, out.covariance);
  const auto [squares, axes] = spectrum(m * m.transpose());
  out.size = std::sqrt(squares(directions_ - 1));
  out.along = axes.col(directions_ - 1);
  out.phase = (m.transpose() * out.along).normalized();
  Eigen::Index largest = 0;
  out.along.cwiseAbs().maxCoeff(&largest);
  const bool turn = phases_ > 1 ? out.along(largest) < 0 : out.phase(0) < 0;
  if (turn) out.along = -out.along, out.phase = -out.phase;
  return out;
}

namespace {

/// Variance along a direction and phase.
double variance(const Matrix& covariance, const Vector& along, const Vector& phase) {
  Vector v(along.size() * phase.size());
  for (Eigen::Index f = 0; f < phase.size(); ++f) v.segment(f * along.size(), along.size()) = phase(f) * along;
  return v.dot(covariance * v);
}

/// Variance of a unit vector's tip across it, in the units of the coefficients, for directions; and for phases.
double across_directions(const Matrix& covariance, const Vector& along, const Vector& phase) {
  double sum = -variance(covariance, along, phase);
  for (Eigen::Index d = 0; d < along.size(); ++d) sum += variance(covariance, Vector::Unit(along.size(), d), phase);
  return std::max(0.0, sum);
}
double across_phases(const Matrix& covariance, const Vector& along, const Vector& phase) {
  double sum = -variance(covariance, along, phase);
  for (Eigen::Index f = 0; f < phase.size(); ++f) sum += variance(covariance, along, Vector::Unit(phase.size(), f));
  return std::max(0.0, sum);
}

}  // namespace

std::optional<Estimate> VariantEstimate::size(int parameter) const {
  const std::optional<Motion> m = motion(parameter);
  if (!m) return std::nullopt;
  const double u = std::sqrt(variance(m->covariance, m->along, m->phase));
  if (directions_ * phases_ == 1) return Estimate{m->size * m->along(0), u};
  // The length of an uncertain vector is biased upwards by what scatters across it. Taken out as a share, it leaves
  // something of a length that the scatter could make alone.
  const double across =
      across_directions(m->covariance, m->along, m->phase) + across_phases(m->covariance, m->along, m->phase);
  const double square = m->size * m->size;
  return Estimate{m->size * std::sqrt(square / (square + across)), u, true};
}

std::optional<SpannedDirection> VariantEstimate::direction() const {
  if (directions_ == 1) return std::nullopt;
  for (std::size_t p = 0; p < effect_.parameters.size(); ++p) {
    const std::optional<Motion> m = effect_.parameters[p].linear ? motion(static_cast<int>(p)) : std::nullopt;
    if (!m || m->size == 0) continue;
    return SpannedDirection{m->along(0), m->along(1), m->along(2),
                            std::sqrt(across_directions(m->covariance, m->along, m->phase) / 2) / m->size, m->whole};
  }
  return std::nullopt;
}

std::optional<Estimate> VariantEstimate::phase_deg(int parameter) const {
  const std::optional<Motion> m = phases_ > 1 ? motion(parameter) : std::nullopt;
  if (!m || m->size == 0) return std::nullopt;
  return Estimate{in_degrees(std::atan2(m->phase(1), m->phase(0))),
                  in_degrees(std::sqrt(across_phases(m->covariance, m->along, m->phase)) / m->size)};
}

}  // namespace abbe::diagnose
