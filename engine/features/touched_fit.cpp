#include "engine/features/touched_fit.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "engine/features/feature.hpp"
#include "engine/features/solve.hpp"
#include "engine/math/scatter.hpp"

namespace abbe {
namespace {

/// What no metrologist would tell apart, far below what coordinates are written with.
constexpr double kSameFit_mm = 1e-7;
/// Of the extent of the points: what form and written decimals may leave. An element that misses its touches by more is not
/// the one that was touched, wherever it faces.
constexpr double kTouched = 0.01;
/// Mean square of the cosine between a vector and the surface: vectors that are 30 degrees off. Across the axis of a bore it
/// is one half at most.
constexpr double kFacing = 0.75;

/// Surfaces that points alone may place in several ways.
bool may_lie_otherwise(Shape shape) {
  return shape == Shape::cylinder || shape == Shape::cone || shape == Shape::torus;
}

double extent_of(const std::vector<Vec3>& points, const Vec3& middle) {
  double squares = 0;
  for (const Vec3& p : points) squares += dot(p - middle, p - middle);
  return std::sqrt(squares / double(points.size()));
}

/// The axis to which all normals of a cylinder or a cone have one angle; nothing where they are all alike.
std::optional<Vec3> axis_of(const std::vector<Vec3>& normals) {
  constexpr double kAlike = 1e-3;
  const Eigen3<double> scatter = scatter_about(normals, mean_of(normals));
  if (scatter.value[1] < kAlike) return std::nullopt;
  return least_direction(scatter);
}

bool faces(Shape shape, const Element& e, const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  const FeatureKind& kind = feature_kind(shape);
  double squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const Outcome<Vec3> normal = kind.normal(e, points[i])) {
      const double cosine = dot(normal.value, normals[i]);
      squares += cosine * cosine;
    }
  return squares >= kFacing * double(points.size());
}

/// The best so far: what faces as it was touched before what does not, then what fits clearly better.
class Choice {
 public:
  Choice(Shape shape, const std::vector<Vec3>& points, const std::vector<Vec3>& normals)
      : shape_(shape), points_(points), normals_(normals), most_mm_(kTouched * extent_of(points, mean_of(points))) {}

  void offer(FitSolution solution) {
    const bool meant = !solution.error && may_lie_otherwise(shape_) && solution.rms <= most_mm_ &&
        faces(shape_, solution.element, points_, normals_);
    if (best_ && !best_->error && (solution.error || (meant_ && !meant))) return;
    const bool better = !best_ || best_->error || (meant && !meant_) || solution.rms < best_->rms - kSameFit_mm;
    if (better) best_ = std::move(solution), meant_ = meant;
  }

  /// Nothing fits better than exactly.
  bool settled() const { return !best_->error && best_->rms <= kSameFit_mm && (meant_ || !may_lie_otherwise(shape_)); }
  FitSolution take() { return std::move(*best_); }

 private:
  Shape shape_;
  const std::vector<Vec3>&points_, &normals_;
  double most_mm_;
  std::optional<FitSolution> best_;
  bool meant_ = false;
};

}  // namespace

FitSolution fit_touched(Shape shape, const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                        const Element& nominal) {
  FitProblem problem{shape, points, std::nullopt};
  if (shape == Shape::circle) problem.normal = nominal.direction;
  Choice choice(shape, points, normals);
  choice.offer(fit_points_from(problem, nominal));
  if (may_lie_otherwise(shape)) {
    Element start = nominal;
    start.point = mean_of(points);
    if (!choice.settled()) choice.offer(fit_points_from(problem, start));
    const std::optional<Vec3> axis = axis_of(normals);
    if (axis) start.direction = *axis;
    if (axis && !choice.settled()) choice.offer(fit_points_from(problem, start));
  }
  if (!choice.settled()) choice.offer(fit_points(problem));
  FitSolution solution = choice.take();
  solution.element = turned_to(shape, solution.element, nominal.direction);
  return solution;
}

}  // namespace abbe
