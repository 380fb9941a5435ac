// Form error of the part or of the artefact.
//
//   curved features:  r = sum_k a_k h_k(n_part)
//   faces, points:    r = a_s sin(2 pi p / wavelength) + a_c cos(2 pi p / wavelength)
//
// h_k are real harmonics of the normal in the part's frame, with a largest value of 1: the five of
// degree 2 and the seven of degree 3, so that a form is one however the part was put down. On a
// sphere they are its form, on a cylinder along the part's z ovality and three lobes. A face has
// one normal: its form is over the position p along an axis of the part, a wave. Which it is, is
// told by the touches (run/curved_features.hpp).
// r > 0 is material too much. The form is there in every repeat and moves with the part. Sizes:
// reference spheres 0.05 to 0.1 um, machined parts micrometres.
// Source: real solid harmonics on the unit sphere; ISO 12181 (lobes), ISO 12780 (waviness).
// Confused with: probe.tip_form and probe.pretravel_lobing, by definition so while the part is
// never turned against the probe.
#include <array>

#include "engine/effects/part/part.hpp"

namespace abbe {
namespace {

constexpr int kHarmonics = 12;
/// What is finer is smaller: as 1 / l^2 with the degree l, like the form of a smooth surface.
constexpr double kTypical_um = 0.5, kTypicalThird_um = 0.22, kMost_um = 500;
/// Most forms are of one kind: a chuck of three jaws makes three lobes, and a pressed ring is oval.
constexpr EffectParameter form(std::string_view name, std::string_view group, double typical_um,
                               std::string_view help) {
  return {.name = name,
          .unit = "um",
          .help = help,
          .typical = typical_um,
          .low = -kMost_um,
          .high = kMost_um,
          .linear = true,
          .group = group};
}
constexpr EffectParameter oval(std::string_view name, std::string_view help) {
  return form(name, "oval", kTypical_um, help);
}
constexpr EffectParameter lobed(std::string_view name, std::string_view help) {
  return form(name, "lobed", kTypicalThird_um, help);
}
constexpr EffectParameter wave(std::string_view name, std::string_view help) {
  return form(name, "wave", kTypical_um, help);
}

constexpr double kWavelengths_mm[] = {50, 70, 100, 140, 200, 280, 400};

constexpr EffectParameter kPartFormParameters[] = {
    oval("oval_um", "two lobes about the part's z: proud along x, low along y"),
    oval("oval_45_um", "two lobes about the part's z: proud at 45 degrees between x and y"),
    oval("oval_xz_um", "two lobes about the part's y: proud at 45 degrees between x and z"),
    oval("oval_yz_um", "two lobes about the part's x: proud at 45 degrees between y and z"),
    oval("egg_um", "proud by this at both poles of the part's z, low by half of it at the equator"),
    lobed("three_lobe_um", "three lobes about the part's z: one of them proud along x"),
    lobed("three_lobe_30_um", "three lobes about the part's z: one of them proud at 30 degrees from x"),
    lobed("three_lobe_xz_um", "three lobes about the part's y: one of them proud along x"),
    lobed("three_lobe_yz_um", "three lobes about the part's x: one of them proud along y"),
    lobed("pear_um", "proud by this at the part's +z pole, low by it at the other"),
    lobed("crossed_oval_um", "an oval that changes over: above the part's equator proud along x, below it along y"),
    lobed("crossed_oval_45_um", "the same, turned by 45 degrees"),
    wave("wave_um", "faces: wave over the position on the part, sine, zero at the part's origin"),
    wave("wave_cosine_um", "faces: wave over the position on the part, cosine, proud at the part's origin"),
    {.name = "wavelength_mm",
     .unit = "mm",
     .help = "length of the wave",
     .typical = 100,
     .low = 0.1,
     .high = 10000,
     .standard = 100,
     .sought = Sought::wavelength,
     .tried = kWavelengths_mm},
    axis_parameter("axis of the part along which the wave runs: 0 x, 1 y, 2 z"),
};

/// Harmonics of a unit normal, in the order of the parameters.
std::array<double, kHarmonics> harmonics(const Vec3& normal) {
  // what makes the largest values of x (1 - 5 z^2) and of z (x^2 - y^2) 1
  const double of_tilted = 3 * std::sqrt(15.0) / 16, of_crossed = 3 * std::sqrt(3.0) / 2;
  const auto [x, y, z] = normal;
  return {x * x - y * y,
          2 * x * y,
          2 * x * z,
          2 * y * z,
          (3 * z * z - 1) / 2,
          x * (x * x - 3 * y * y),
          y * (3 * x * x - y * y),
          of_tilted * x * (1 - 5 * z * z),
          of_tilted * y * (1 - 5 * z * z),
          z * (5 * z * z - 3) / 2,
          of_crossed * z * (x * x - y * y),
          of_crossed * z * 2 * x * y};
}

Vec3 part_form(const TouchScene& scene, const double* theta, const double*) {
  double r_um = 0;
  if (scene.curved) {
    const std::array<double, kHarmonics> h = harmonics(scene.normal_on_part);
    for (int k = 0; k < kHarmonics; ++k) r_um += theta[k] * h[static_cast<std::size_t>(k)];
  } else {
    const double* wave = theta + kHarmonics;  // sine, cosine, length, axis
    const double phase = 2 * kPi * scene.on_part[code(wave[3])] / wave[2];
    r_um = wave[0] * std::sin(phase) + wave[1] * std::cos(phase);
  }
  return along_normal(scene, r_um * kUm);
}

}  // namespace

constinit const Effect kPartForm{
    .name = "part.form",
    .title = "form error of the part",
    .help =
        "The surface is not the ideal one: a ball is oval or three-lobed, a plane is wavy. The "
        "same deviation returns in every repeat and goes with the part when it is turned. On a "
        "part whose form is the thing to measure this is no error; on an artefact that counts as "
        "perfect it is.",
    .source = "real harmonics of degree 2 and 3; ISO 12181 roundness, ISO 12780 straightness",
    .separate = "turn the part against the probe (multi-step reversal); measure it with another probe",
    .influence = "form error of the part",
    .stage = Stage::part,
    .needs = Covariate::normal | Covariate::part_frame,
    .parameters = kPartFormParameters,
    .lasting = true,
    .displace = part_form,
};

}  // namespace abbe
