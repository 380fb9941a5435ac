// Deflection of the structure by acceleration, and its ringing.
//
//   d = theta(t) k x lever,     w_d = w sqrt(1 - zeta^2)
//   theta(t) = c acc_i exp(-zeta w t) [ cos(w_d t) + zeta/sqrt(1 - zeta^2) sin(w_d t) ]
//
// While axis i accelerates, its carriage turns about direction k by c acc_i (quasi-static: c = m l
// / k_theta). When the approach becomes steady the load is gone and the carriage rings from there,
// free and starting at rest: t is the time at constant speed before the touch. At t = 0 (or where a
// recording does not tell it) the quasi-static deflection stands. acc_i: acceleration along the
// travel.
// Size: 1 to 10 um at high acceleration; 10 to 50 Hz.
// Confused with: machine.backlash (rho 0.7 to 0.99).
#include "engine/effects/machine/machine.hpp"
#include "engine/effects/terms.hpp"

namespace abbe {
namespace {

constexpr EffectParameter kDynamicsParameters[] = {
    {.name = "rotation_urad_per_m_s2",
     .unit = "urad/(m/s^2)",
     .help = "turn of the carriage per acceleration along its axis",
     .typical = 4,
     .low = -500,
     .high = 500,
     .linear = true},
    axis_parameter("the axis that accelerates: 0 x, 1 y, 2 z"),
    {.name = "about",
     .unit = "code",
     .help = "the direction about which its carriage turns: 0 X, 1 Y, 2 Z; yaw of x or y is 2",
     .high = 2,
     .standard = 2,
     .choices = kAxisChoices},
    {.name = "frequency_Hz",
     .unit = "Hz",
     .help = "natural frequency of the structure",
     .typical = 20,
     .low = 2,
     .high = 500,
     .standard = 20},
    {.name = "damping_ratio",
     .unit = "1",
     .help = "damping over critical damping",
     .typical = 0.03,
     .low = 0,
     .high = 0.9,
     .standard = 0.03},
};

/// What is left of an initial deflection of 1 after `time_s`.
double free_response(double time_s, double frequency_Hz, double zeta) {
  if (time_s <= 0) return 1;
  const double w = 2 * kPi * frequency_Hz, root = std::sqrt(1 - zeta * zeta), angle = w * root * time_s;
  return std::exp(-zeta * w * time_s) * (std::cos(angle) + zeta / root * std::sin(angle));
}

Vec3 dynamics(const TouchScene& scene, const double* theta, const double*) {
  const int axis = code(theta[1]);
  const double along_m_s2 = 1e-3 * scene.acceleration_mm_s2 * approach(scene)[axis];
  const double angle = theta[0] * kUrad * along_m_s2 * free_response(scene.settled_s, theta[3], theta[4]);
  return angle * cross(axis_vector(code(theta[2])), scene.lever_mm[axis]);
}

}  // namespace

constinit const Effect kDynamics{
    .name = "machine.dynamics",
    .title = "deflection and ringing by acceleration",
    .help =
        "Acceleration tilts the carriages, and they ring when it ends. A probe that triggers soon "
        "after sees the tilt times the arm to the tip: an error that follows acceleration, sense "
        "and arm, and fades with the approach distance.",
    .source =
        "Pereira & Hocken, Precision Engineering 31 (2007); damped oscillator released from its "
        "static deflection",
    .separate = "a second acceleration, or a longer approach at constant speed",
    .influence = "dynamics and backlash",
    .stage = Stage::dynamics,
    .needs = Covariate::position | Covariate::direction | Covariate::acceleration,
    .parameters = kDynamicsParameters,
    .displace = dynamics,
};

}  // namespace abbe
