// Points in which round features are met: a line with a circle or sphere, a plane with a
// circle, two circles. There are two; the one nearer to the nominal point is meant.
//
// A circle is met in its own plane: a line or another circle is looked at as its projection there, so
// that features measured at slightly different heights meet all the same.
#pragma once

#include "engine/features/constructions/tools.hpp"

namespace abbe {

/// Whether two features of these shapes, in either order, meet so. A line and a cylinder do not: there their
/// axes meet (intersection.cpp).
bool meets_round(Shapes);

/// The point; precondition: meets_round. Fails where there is none.
Outcome<Element> round_intersection(Shapes, Elements, const Element& nominal);

}  // namespace abbe
