// VECBLD: the first feature's point with a direction built of its neighbours: the normal of the
// least-squares plane through the points of all the features, turned to the side of the nominal.
#include "engine/features/constructions/tools.hpp"
#include "engine/features/fit.hpp"

namespace abbe {
namespace {

const char* vector_applies(Shape result, Shapes) { return result == Shape::point ? nullptr : "VECBLD makes a point"; }

Outcome<Element> build_vector(Shape, Shapes shapes, Elements from, const Element& nominal, const Arguments&) {
  FitProblem problem{.shape = Shape::plane, .points = {}, .normal = {}};
  for (std::size_t k = 0; k < from.size(); ++k) problem.points.push_back(location_of(shapes[k], from[k]));
  const FitSolution plane = fit_points(problem);
  if (plane.error) return cannot("the points of the features do not determine a plane");
  return {in_sense_of(nominal, {.point = problem.points[0], .direction = plane.element.direction})};
}

}  // namespace

extern const Construction vector_method{
    .word = "VECBLD",
    .signature = "from:feature,from:feature,from:feature,{ from:feature }",
    .help = "the first point, with the normal of the plane through all the points as its vector",
    .example = "CONST/POINT,F(P),VECBLD,FA(A),FA(B),FA(C)",
    .source = "ISO 22093:2011, CONST VECBLD",
    .applies = vector_applies,
    .construct = build_vector,
};

}  // namespace abbe
