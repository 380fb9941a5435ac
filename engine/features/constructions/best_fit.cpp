// BF: the least-squares element through the points and centres of other features. A line or axis
// gives the point that is nearest to the nominal one of its feature, so that a line through bores or a
// bolt circle does not depend on how deep the bores were touched.
#include <vector>

#include "engine/features/constructions/tools.hpp"
#include "engine/features/feature.hpp"
#include "engine/features/solve.hpp"

namespace abbe {
namespace {

constexpr const char* kTooFew = "too few features for a best fit of this kind";

/// A fit error as text that outlives the fit.
const char* best_fit_reason(const FitError& error) {
  if (error.code == "too_few_points") return kTooFew;
  if (error.code == "identical_points") return "the points of the features are identical";
  if (error.code == "collinear_points") return "the points of the features lie on one line";
  if (error.code == "coplanar_points") return "the points of the features lie in one plane";
  if (error.code == "not_converged") return "the best fit through the features does not converge";
  return "the points of the features admit no best fit";
}

const char* best_fit_applies(Shape result, Shapes shapes) {
  for (const Shape shape : shapes)
    if (!has_centre(shape) && !has_axis(shape)) return "BF takes features with a point, a centre or an axis";
  const FeatureKind& kind = feature_kind(result);
  if (!kind.fit_points) return "BF does not make a feature of this kind";
  return static_cast<int>(shapes.size()) < kind.minimum_points ? kTooFew : nullptr;
}

Outcome<Element> construct_best_fit(Shape result, Shapes shapes, Elements from, const Element& nominal,
                                    const Arguments&) {
  FitProblem problem{.shape = result, .points = {}, .normal = {}};
  problem.points.reserve(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) problem.points.push_back(location_of(shapes[k], from[k]));
  const FitSolution fitted = fit_points(problem);
  if (fitted.error) return cannot(best_fit_reason(*fitted.error));
  Element made = fitted.element;
  if (result == Shape::point) made.direction = nominal.direction;
  return {turned_to(result, made, nominal.direction)};
}

}  // namespace

extern const Construction best_fit_method{
    .word = "BF",
    .signature = "from:feature,{ from:feature }",
    .help =
        "least-squares fit through the points and centres of features; a line or axis gives its point nearest to the nominal one",
    .example = "CONST/PLANE,F(P1),BF,FA(A),FA(B),FA(C)",
    .source = "ISO 22093:2011, CONST BF; orthogonal least squares as for measured features",
    .applies = best_fit_applies,
    .construct = construct_best_fit,
    .axes_are_points = true,
};

}  // namespace abbe
