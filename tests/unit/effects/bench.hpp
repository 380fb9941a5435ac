// What the tests of the effects share: scenes of a touch, and an effect called with named
// parameters.
#pragma once

#include <doctest/doctest.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "engine/effects/effect.hpp"

namespace abbe::effects_test {

using Parameters = std::initializer_list<std::pair<std::string_view, double>>;

/// Parameter values in the order of the effect: what is named here, and the standard value of
/// everything else.
inline std::vector<double> values_of(const Effect& effect, Parameters named) {
  std::vector<double> theta;
  for (const EffectParameter& p : effect.parameters) theta.push_back(p.standard);
  for (const auto& [name, value] : named) {
    bool known = false;
    for (std::size_t i = 0; i < theta.size(); ++i)
      if (effect.parameters[i].name == name) theta[i] = value, known = true;
    if (!known) FAIL("no parameter " << std::string(name));
  }
  return theta;
}

inline Vec3 displacement_mm(const Effect& effect, const TouchScene& scene, Parameters named,
                            const std::vector<double>& z = {}) {
  const std::vector<double> theta = values_of(effect, named);
  std::vector<double> draws = z;
  draws.resize(static_cast<std::size_t>(effect.draws));
  return effect.displace(scene, theta.data(), draws.data());
}

/// n . d in um: what a reading shows; positive: the surface seems too far out.
inline double reading_um(const Effect& effect, const TouchScene& scene, Parameters named,
                         const std::vector<double>& z = {}) {
  return 1e3 * dot(scene.normal, displacement_mm(effect, scene, named, z));
}

/// R_WR of head angles: Rz(B) Ry(-A).
inline Mat3 head_pose(double a_rad, double b_rad) { return rotation({0, 0, 1}, b_rad) * rotation({0, 1, 0}, -a_rad); }

/// A touch along the normal with a straight stylus.
inline TouchScene touch(const Vec3& normal, double length_mm = 50, double a_rad = 0, double b_rad = 0) {
  TouchScene scene;
  scene.normal = normal;
  scene.travel = -normal;
  scene.speed_mm_s = 8;
  StylusScene& s = scene.stylus;
  s.R_WR = head_pose(a_rad, b_rad);
  s.head_a_rad = a_rad, s.head_b_rad = b_rad;
  s.indexed = true;
  s.to_head = s.R_WR.cz;
  s.length_mm = length_mm;
  s.tip_from_mount_mm = -length_mm * s.to_head;
  s.radius_mm = 1;
  s.shaft_diameter_mm = 2;
  s.young_MPa = 620e3;
  return scene;
}

/// A touch at a place on the part, whose normal there is that in W.
inline TouchScene touch_on_part(const Vec3& on_part, const Vec3& normal) {
  TouchScene scene = touch(normal);
  scene.on_part = on_part;
  scene.normal_on_part = normal;
  return scene;
}

}  // namespace abbe::effects_test
