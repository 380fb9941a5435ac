// What an error map that interpolates linearly leaves between its nodes.
//
//   d = amplitude 4 q (1 - q) e,     q = fractional part of (x - node) / spacing
//
// Linear interpolation of a curved error misses e'' h^2/8 in the middle between nodes h apart,
// nothing at the nodes, a parabola in between: scallops with cusps. `amplitude_um` is e'' h^2/8
// with the sign of the residual.
// Size: 0.05 to 1 um.
// Signature: period h along the axis.
// Confused with: the machine's short-wave errors, unless nodes are known.
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr double kSpacings_mm[] = {20, 25, 30, 40, 50, 60, 75, 80, 100, 200}, kNodes_mm[] = {0, 5, 10, 12.5, 25, 37.5};

constexpr EffectParameter kMapScallopsParameters[] = {
    {.name = "amplitude_um",
     .unit = "um",
     .help = "reading error left in the middle between two nodes",
     .typical = 0.3,
     .low = -20,
     .high = 20,
     .linear = true},
    {.name = "spacing_mm",
     .unit = "mm",
     .help = "distance of the nodes of the error map",
     .typical = 50,
     .low = 1,
     .high = 1000,
     .standard = 50,
     .sought = Sought::listed,
     .tried = kSpacings_mm},
    {.name = "node_mm",
     .unit = "mm",
     .help = "reading at one of the nodes",
     .typical = 0,
     .low = -5000,
     .high = 5000,
     .sought = Sought::listed,
     .tried = kNodes_mm},
    axis_parameter("the axis along which the map is interpolated: 0 x, 1 y, 2 z"),
    {.name = "direction",
     .unit = "code",
     .help = "direction of the error: 0 x, 1 y, 2 z; the axis itself: positioning",
     .high = 2,
     .choices = kAxisChoices},
};

Vec3 map_scallops(const TouchScene& scene, const double* theta, const double*) {
  const double nodes = (scene.reading[code(theta[3])] - theta[2]) / theta[1];
  const double q = nodes - std::floor(nodes);
  return theta[0] * kUm * 4 * q * (1 - q) * axis_vector(code(theta[4]));
}

}  // namespace

constinit const Effect kMapScallops{
    .name = "machine.map_scallops",
    .title = "residual of the error map between its nodes",
    .help =
        "The machine's compensation is exact at the nodes of its map and interpolates linearly "
        "between them; a curved error leaves a parabola in every gap, zero with a cusp at each "
        "node. It repeats with the spacing of the nodes.",
    .source = "error of linear interpolation, e'' h^2/8",
    .separate = "positions at the nodes against positions half-way; a grid shifted by half the spacing",
    .influence = "geometry",
    .stage = Stage::structure,
    .needs = 0u | Covariate::position,
    .parameters = kMapScallopsParameters,
    .displace = map_scallops,
};

}  // namespace abbe
