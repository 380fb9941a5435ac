// The parts that the arguments of FEAT statements share: a location in Cartesian or polar coordinates, a
// direction, a diameter.
#pragma once

#include "engine/features/feature.hpp"

namespace abbe {

// Signature of a location: x,y,z, or POL with radius, angle and height along z of the current frame.
#define ABBE_LOCATION "( CART,x:length,y:length,z:length ; POL,r:length,a:angle,h:length )"
#define ABBE_DIRECTION "i:number,j:number,k:number"

/// FeatureKind::nominal and FeatureKind::written of what has a location and a direction only: points and planes.
Outcome<Element> located(const Arguments&);
FeatArguments written_location(const Element&);

Vec3 location(const Arguments&);
/// The unit vector along (i, j, k); fails when its length is zero or not finite.
Outcome<Vec3> direction(const Arguments&);
/// Half of the diameter under `name`, mm; fails unless it is positive.
Outcome<double> radius(const Arguments&, const char* name);

}  // namespace abbe
