#include "engine/features/feature.hpp"
#include "engine/features/minimax_fit.hpp"
#include "engine/features/nominal.hpp"
#include "engine/features/nominal_normal.hpp"
#include "engine/features/pattern.hpp"
#include "engine/features/straight_fit.hpp"

namespace abbe {
namespace {

/// A plane as a profile: the distance is the height. The size, of no influence, is held at 1.
struct PlaneProfile {
  static constexpr Shape kShape = Shape::plane;
  static constexpr bool kAcross = false, kAlong = true, kTilt = true;
  static constexpr int kSizes = 1;
  static void prepare(const double*, double*) {}
  static ProfileSlopes<double> slopes(double, double h, const double*) { return {h, 0, 1, {0, 0}}; }
};

Outcome<PatternTouch> touch_plane(const Element& e, bool, int k, int n) {
  const Across across(e.direction);
  const PatternGrid grid(k, n);
  return {{e.point + grid.a * across.a + grid.b * across.b, e.direction}};
}

}  // namespace

extern const FeatureKind plane_kind{
    .shape = Shape::plane,
    .flat = true,
    .word = "PLANE",
    .signature = ABBE_LOCATION "," ABBE_DIRECTION,
    .help = "a plane: a point and the normal out of the material",
    .example = "F(PL1)=FEAT/PLANE,CART,0,0,0,0,0,1",
    .source = "ISO 22093:2011, FEAT/PLANE; total least squares (Pearson 1901)",
    .nominal = located,
    .written = written_location,
    .normal = along_direction,
    .pattern = {.help = "rows over a square of 20 mm about the point, along x and y of the system",
                .touch = touch_plane},
    .minimum_points = 3,
    .fit_lanes = fit_plane_lanes,
    .refit = refit_by<PlaneProfile>,
    .fit_points = fit_plane_points,
    .spread = 2,
    .fit_names = {.element = "plane", .point = "point", .direction = "normal"},
};

}  // namespace abbe
