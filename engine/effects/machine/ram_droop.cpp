// Bending of the ram with its extension.
//
//   d = (z/z_max)^3 [ droop e - compliance n_perp ]
//
// z: extension of the ram, the distance from its home end; z_max: the travel. A cantilever bends by
// F z^3/(3 E I). `droop_um`: sag at full extension of a lying or inclined ram under gravity; the
// true tip lies on the side -e and the machine reads +e. `compliance_um`: bending by the probing
// force; it acts across the ram, against the approach, so the machine moves on and the surface
// seems too far in.
// Size: 0.1 to 2 um.
// Confused with: squareness of the ram (rho 0.76 to 0.99) and its straightness: hardly nameable on
// an unknown machine.
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

// The ram of a machine here is vertical (docs/machine.md), and it bends across.
constexpr double kVertical[] = {2}, kAcross[] = {0, 1};

constexpr EffectParameter kRamDroopParameters[] = {
    {.name = "droop_um",
     .unit = "um",
     .help = "reading error by the sag at full extension of the ram",
     .typical = 1.5,
     .low = -200,
     .high = 200,
     .linear = true},
    {.name = "compliance_um",
     .unit = "um",
     .help = "bending at full extension by the probing force",
     .typical = 0.5,
     .low = -50,
     .high = 50,
     .linear = true},
    {.name = "direction",
     .unit = "code",
     .help = "direction of the reading error by sag: 0 x, 1 y, 2 z",
     .high = 2,
     .standard = 1,
     .choices = kAxisChoices,
     .sought = Sought::listed,
     .tried = kAcross},
    {.name = "axis",
     .unit = "code",
     .help = "axis of the ram: 0 x, 1 y, 2 z",
     .high = 2,
     .standard = 2,
     .choices = kAxisChoices,
     .sought = Sought::listed,
     .tried = kVertical},
};

Vec3 ram_droop(const TouchScene& scene, const double* theta, const double*) {
  const int ram = code(theta[3]);
  const double extension = std::fabs(scene.reading[ram]) / scene.travel_length_mm[ram];
  const Vec3 across = perpendicular_part(scene.normal, axis_vector(ram));
  const Vec3 full = theta[0] * kUm * axis_vector(code(theta[2])) - theta[1] * kUm * across;
  return extension * extension * extension * full;
}

}  // namespace

constinit const Effect kRamDroop{
    .name = "machine.ram_droop",
    .title = "bending of the ram",
    .help =
        "The farther the ram reaches out, the more it bends: by its weight if it lies or leans, "
        "and by the probing force. The error grows with the third power of the extension and looks "
        "much like a squareness error of the ram.",
    .source = "Euler-Bernoulli cantilever",
    .separate =
        "the same artefact at several extensions of the ram, with tilted placements; another "
        "probing force",
    .influence = "geometry",
    .stage = Stage::structure,
    .needs = Covariate::position | Covariate::normal,
    .parameters = kRamDroopParameters,
    .displace = ram_droop,
};

}  // namespace abbe
