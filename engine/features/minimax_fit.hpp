// The criteria of criterion.hpp for planes and surfaces of revolution: minimax problems, min over x of
// max_i f_i(x) with f = +-d (distances, minimum zone), rho (circumscribed) or -rho (inscribed). They are
// solved by linearising the f_i at the present element, solving the linear minimax problem exactly
// within a trust region (engine/math/minimax.hpp), and accepting the step when the true maximum falls (K.
// Madsen, J. Inst. Maths Applics 16, 1975, 321-328). Where N + 1 points define the element this converges
// quadratically.
#pragma once

#include <limits>
#include <vector>

#include "engine/features/criterion.hpp"
#include "engine/features/revolution.hpp"
#include "engine/math/minimax.hpp"

namespace abbe {

template <class Profile>
class MinimaxFit {
 public:
  MinimaxFit(FitCriterion criterion, std::span<const Vec3> points, const Element& start)
      : criterion_(criterion), start_(start) {
    for (const Vec3& p : points) mean_ += p / static_cast<double>(points.size());
    for (const Vec3& p : points) {
      points_.push_back(p - mean_);
      extent_ = std::max(extent_, norm(points_.back()));
    }
    surface_ = placed(Profile::kShape, start, mean_);
    anchor_near<Profile>(surface_, kOrigin);
  }

  void run(Element& element) {
    double worst = linearise(surface_);
    double trust = std::max(4 * (start_.high - start_.low), kFirstStep * extent_);
    for (int round = 0; round < kRounds && trust > kResolution * extent_; ++round) {
      double step[N];
      const double model = minimax_in_box<N>(scaled(worst, trust), step);
      if (!(model < -kResolution * extent_)) break;
      for (int k = 0; k < N; ++k) step[k] *= trust / reach(k);
      const Placed<double> before = surface_;
      move_by<Profile>(surface_, step);
      if (one_sided()) surface_.size[0] = before.size[0];
      anchor_near<Profile>(surface_, kOrigin);
      const double reached = largest(surface_), gain = worst - reached;
      if (gain < -0.25 * model) trust *= 0.25;
      if (gain > -0.75 * model) trust *= 2;
      if (gain > 0) {
        worst = linearise(surface_);
      } else {
        surface_ = before;
      }
    }
    report(element);
  }

 private:
  static constexpr int N = kUnknowns<Profile>;
  static constexpr int kRounds = 200;
  static constexpr double kResolution = 1e-14;
  static constexpr double kFirstStep = 1e-6;  ///< a perfect form must not hide that nothing holds the element
  static constexpr double kOrigin[3] = {0, 0, 0};

  bool one_sided() const { return criterion_ != FitCriterion::minimum_zone; }

  /// Derivatives and value of the distance of point p.
  void row_of(const Placed<double>& s, const Vec3& p, double (&row)[N + 1]) const {
    const double w[3] = {p.x, p.y, p.z};
    double q[3], ready[3] = {};
    s.coordinates(w, q);
    Profile::prepare(s.size, ready);
    distance_row<Profile>(q[0], q[1], q[2], ready, row);
  }

  /// The functions whose largest value is to be made small, at `s`; returns that value.
  double linearise(const Placed<double>& s) {
    rows_.clear();
    for (const Vec3& p : points_) {
      double row[N + 1];
      row_of(s, p, row);
      const double sign = criterion_ == FitCriterion::maximum_inscribed ? -1 : 1;
      if (one_sided()) row[N] += s.size[0], row[N - 1] = 0;  // the distance from the axis or centre
      add(row, sign);
      if (!one_sided()) add(row, -1);
    }
    return worst_of_rows();
  }
  double largest(const Placed<double>& s) {
    std::vector<MinimaxRow<N>> kept;
    kept.swap(rows_);
    const double value = linearise(s);
    rows_.swap(kept);
    return value;
  }
  void add(const double (&row)[N + 1], double sign) {
    MinimaxRow<N>& r = rows_.emplace_back();
    r.f = sign * row[N];
    for (int k = 0; k < N; ++k) r.g[k] = sign * row[k];
  }
  double worst_of_rows() const {
    double worst = -std::numeric_limits<double>::infinity();
    for (const auto& r : rows_) worst = std::max(worst, r.f);
    return worst;
  }

  /// How far unit change of unknown k moves the surface at the points, mm: 1 for shifts and sizes, the
  /// extent for angles.
  double reach(int k) const {
    constexpr int shifts = 2 * Profile::kAcross + Profile::kAlong, tilts = 2 * Profile::kTilt;
    const bool angle = (k >= shifts && k < shifts + tilts) || (Profile::kShape == Shape::cone && k == N - 1);
    return angle ? extent_ : 1;
  }

  /// The rows relative to `worst`, unknowns in units of the trust region.
  std::span<const MinimaxRow<N>> scaled(double worst, double trust) {
    model_ = rows_;
    for (auto& r : model_) {
      r.f -= worst;
      for (int k = 0; k < N; ++k) r.g[k] *= trust / reach(k);
    }
    return model_;
  }

  void report(Element& element) {
    if (one_sided()) {
      linearise(surface_);
      surface_.size[0] = std::fabs(worst_of_rows());
    }
    const double origin[3] = {mean_.x, mean_.y, mean_.z};
    bool turned = false;
    Element made = element_of(Profile::kShape, surface_, origin, &turned);
    made.low = made.begin = std::numeric_limits<double>::infinity();
    made.high = made.end = -made.low;
    for (const Vec3& p : points_) {
      double row[N + 1];
      row_of(surface_, p, row);
      made.low = std::min(made.low, row[N]), made.high = std::max(made.high, row[N]);
      const double along = dot(p + mean_ - made.point, made.direction);
      const double reached =
          Profile::kShape == Shape::plane ? norm(perpendicular_part(p + mean_ - made.point, made.direction)) : along;
      made.begin = std::min(made.begin, reached), made.end = std::max(made.end, reached);
    }
    if (Profile::kShape == Shape::plane) made.size = 0, made.begin = -made.end;
    if (Profile::kShape != Shape::plane && Profile::kShape != Shape::cylinder && Profile::kShape != Shape::cone)
      made.begin = made.end = 0;
    element = made;
  }

  FitCriterion criterion_;
  const Element& start_;
  Vec3 mean_;
  std::vector<Vec3> points_;  // about their mean
  double extent_ = 0;
  Placed<double> surface_;
  std::vector<MinimaxRow<N>> rows_, model_;
};

/// FeatureKind::refit of a surface that has a profile.
template <class Profile>
void refit_by(FitCriterion criterion, std::span<const Vec3> points, Element& element) {
  const Element start = element;
  MinimaxFit<Profile>(criterion, points, start).run(element);
}

}  // namespace abbe
