// Which way the surface faces where a touch gives no vector: the nominal of the feature says.
#pragma once

#include "engine/base/arguments.hpp"
#include "engine/features/element.hpp"

namespace abbe {

/// The outward normal of the nominal surface nearest to `point`, same frame, mm; a unit vector. Fails where
/// the nominal leaves it open.
Outcome<Vec3> nominal_normal(Shape, const Element& nominal, bool inner, const Vec3& point);

}  // namespace abbe
