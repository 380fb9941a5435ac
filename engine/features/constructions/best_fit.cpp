// BF: the least-squares element through the points and centres of other features.
#include <vector>

#include "engine/features/constructions/tools.hpp"
#include "engine/features/fit.hpp"

namespace abbe {
namespace {

/// A fit error as text that outlives the fit.
const char* reason_of(const FitError& error) {
  if (error.code == "too_few_points") return "too few features for a best fit of this kind";
  if (error.code == "identical_points") return "the points of the features are identical";
  if (error.code == "collinear_points") return "the points of the features lie on one line";
  if (error.code == "coplanar_points") return "the points of the features lie in one plane";
  if (error.code == "not_converged") return "the best fit through the features does not converge";
  return "the points of the features admit no best fit";
}

Outcome<Element> construct_best_fit(Shape result, Shapes shapes, Elements from, const Element& nominal,
                                    const Arguments&) {
  for (const Shape shape : shapes)
    if (!has_centre(shape))
      return cannot("BF takes points, circles, spheres and tori: features with a centre");
  FitProblem problem{.shape = result, .points = {}, .normal = {}};
  problem.points.reserve(from.size());
  for (const Element& e : from) problem.points.push_back(e.point);
  const FitSolution fitted = fit_points(problem);
  if (fitted.error) return cannot(reason_of(*fitted.error));
  Element made = fitted.element;
  if (result == Shape::point) made.direction = nominal.direction;
  const bool turned = dot(made.direction, nominal.direction) < 0;
  // A cone's direction is settled by its apex. Residuals of a plane are signed along its normal.
  if (result == Shape::cone || !turned) return {made};
  made = in_sense_of(nominal, made);
  if (result == Shape::plane) {
    const double low = made.low;
    made.low = -made.high, made.high = -low;
  }
  return {made};
}

}  // namespace

extern const Construction best_fit_method{
    .word = "BF",
    .signature = "from:feature,{ from:feature }",
    .help = "least-squares fit through the points and centres of features",
    .example = "CONST/PLANE,F(P1),BF,FA(A),FA(B),FA(C)",
    .source = "ISO 22093:2011, CONST BF; orthogonal least squares as for measured features",
    .construct = construct_best_fit,
};

}  // namespace abbe
