// Every effect of the registry is found again by its own sensitivity: a recording with the effect at one size
// is explained, by least squares, by the change that a small size makes. What simulates is what diagnoses.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/unit/run/plan_builder.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

/// Two stylus systems in four orientations at three heights, each touching a ball all round, at two speeds.
plan::Plan rich_program() {
  PlanBuilder b;
  const std::vector<plan::SensorId> sensors{b.sensor(0, 0, 60), b.sensor(45, 60, 120), b.sensor(90, -30, 120),
                                            b.sensor(0, 90, 60)};
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    b.append(plan::SelectSensor{sensors[s]});
    b.append(plan::SetMotion{plan::MotionSetting::measuring_speed, s % 2 ? 3.0 : 8.0, false});
    for (int ball = 0; ball < 3; ++ball) {
      constexpr double kRadius = 12.5;
      const Vec3 centre{500.0 + 300 * ball, 300.0 + 150 * ball, -600.0 + 120 * ball};
      const plan::FeatureId sphere = b.feature(Shape::sphere, {.point = centre, .size = kRadius});
      b.append(plan::BeginMeasure{sphere});
      for (int k = 0; k < 12; ++k) {
        const double z = 1 - (k + 0.5) / 8, r = std::sqrt(1 - z * z), a = 2.4 * k;
        const Vec3 n{r * std::cos(a), r * std::sin(a), z};
        b.append(plan::Touch{sphere, constant(centre + kRadius * n), constant(n), true});
      }
      b.append(plan::EndMeasure{sphere});
    }
  }
  return b.plan;
}

/// Errors along the normals with an effect's first parameter at `size`; the others at what a user gets who gives none.
std::vector<double> errors(const Effect& effect, double size) {
  static const plan::Plan plan = rich_program();
  static const Machine plain = read_machine("coord3-mc16");
  static const VirtualMachines one = screened_machines(plain, 1, 1, 1);
  static const Workpiece warm = parse_workpiece(SourceFile(
      "warm.json",
      R"({"schema": "abbe.workpiece/1", "name": "warm", "material": {"cte_ppm_per_K": 11.5}, "scales": {"cte_ppm_per_K": 8},
      "temperature": {"part_C": 23, "scale_C": 22, "air_C": 24, "table_top_minus_bottom_K": 0.4, "bridge_gradient_K": 0.3,
      "legs_difference_K": 0.2}, "load_kg": 200})"));
  Machine machine = plain;
  EffectSetting setting{std::string(effect.name), {}};
  setting.parameters[std::string(effect.parameters[0].name)].value = size;
  machine.effects = {setting};
  RunOptions options;
  options.workpiece = &warm;
  std::vector<double> r;
  for (const RecordingRow& row : record_plan(plan, machine, one, options, no_source()).recording.rows)
    r.push_back(dot(*row.normal, row.position_mm - *row.target_mm));
  return r;
}

}  // namespace

TEST_CASE("every effect is found again by its own sensitivity run") {
  for (const Effect* effect : effects()) {
    CAPTURE(effect->name);
    const EffectParameter& size = effect->parameters[0];
    // a ratio or a share: it changes the noise, and a small one is not a tenth of a large one
    if (!size.linear) continue;
    const double truth = size.typical, step = size.typical / 10;
    const std::vector<double> without = errors(*effect, 0), with = errors(*effect, truth),
                              perturbed = errors(*effect, step);
    double sensitivity_sq = 0, projection = 0, rest_sq = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
      const double s = (perturbed[i] - without[i]) / step;
      sensitivity_sq += s * s;
      projection += s * (with[i] - without[i]);
    }
    // A DMIS program always approaches along the normal: there is no cosine error to find.
    if (effect->name == "probe.cosine_error") {
      CHECK(sensitivity_sq == 0);
      continue;
    }
    CHECK(sensitivity_sq > 0);
    const double found = projection / sensitivity_sq;
    for (std::size_t i = 0; i < with.size(); ++i) {
      const double rest = (with[i] - without[i]) - found * (perturbed[i] - without[i]) / step;
      rest_sq += rest * rest;
    }
    CHECK(found == doctest::Approx(truth).epsilon(1e-6));
    CHECK(rest_sq < 1e-10 * truth * truth * sensitivity_sq);
  }
}
