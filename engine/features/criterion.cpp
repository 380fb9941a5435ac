#include "engine/features/criterion.hpp"

#include "engine/base/ids.hpp"
#include "engine/features/shape_traits.hpp"
#include "engine/features/solve.hpp"

namespace abbe {

const char* criterion_refusal(const FeatureKind& kind, FitCriterion criterion) {
  if (criterion == FitCriterion::least_squares) return nullptr;
  if (!kind.refit) return "only least squares is available for it";
  if (criterion == FitCriterion::minimum_zone || has_diameter(kind.acts_as)) return nullptr;
  return "nothing can be inscribed in it or circumscribed about it";
}

const char* refit(const FeatureKind& kind, FitCriterion criterion, std::span<const Vec3> points, Element& element) {
  ABBE_CHECK(!criterion_refusal(kind, criterion));
  if (criterion == FitCriterion::least_squares) return nullptr;
  const Element least_squares = element;
  kind.refit(criterion, points, element);
  constexpr double kEndless = 2;  // points all round it hold it next to the least-squares element
  if (criterion == FitCriterion::maximum_inscribed && !(element.size < kEndless * least_squares.size))
    return "all points lie on less than half of it: there is no largest inscribed one";
  element.second = least_squares.second;
  element = turned_to(kind.shape, element, least_squares.direction);
  return nullptr;
}

}  // namespace abbe
