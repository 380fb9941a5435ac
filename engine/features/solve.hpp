// Between fit.hpp and the kinds: the careful solver with a start, and the texts of its refusals.
#pragma once

#include <string_view>

#include "engine/features/fit.hpp"

namespace abbe {

/// As fit_points, but only the minimum next to `start` is looked for. `start` matters to surfaces of
/// revolution; lines and planes have one minimum.
FitSolution fit_points_from(const FitProblem&, const Element& start);

/// The element with its direction turned to the side of another one: points do not say which way a normal or an axis
/// points. A cone's axis points to its open side by itself, and stays.
Element turned_to(Shape, Element, const Vec3& direction);

/// The reason in plain words, as static text, of a FitError code.
const char* reason_of(std::string_view code);

}  // namespace abbe
