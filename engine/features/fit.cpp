#include "engine/features/fit.hpp"

#include <cmath>
#include <utility>

#include "engine/features/cloud.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/solve.hpp"

namespace abbe {
namespace {

/// The sense of a direction that the points leave open: the component of the largest magnitude is positive.
Element with_usual_sense(Shape shape, const Element& element) {
  const Vec3& d = element.direction;
  const double ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
  const Vec3 leading = ax >= ay && ax >= az ? Vec3{1, 0, 0} : ay >= az ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return turned_to(shape, element, leading);
}

FitSolution fit(const FitProblem& problem, const Element* start) {
  FitSolution solution;
  if ((solution.error = refusal(problem))) return solution;
  Cloud cloud = centred(problem.points);
  if ((solution.error = refusal(problem, cloud))) return solution;
  solution = feature_kind(problem.shape).fit_points(problem, std::move(cloud), start);
  if (!problem.normal) solution.element = with_usual_sense(problem.shape, solution.element);
  return solution;
}

}  // namespace

FitSolution fit_points(const FitProblem& problem) { return fit(problem, nullptr); }

FitSolution fit_points_from(const FitProblem& problem, const Element& start) { return fit(problem, &start); }

}  // namespace abbe
