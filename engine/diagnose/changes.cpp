// The menu of changes that separate effects (catalogue, "Sep."), and their programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/diagnose/next_measurement.hpp"
#include "engine/machine/head.hpp"
#include "engine/run/motion.hpp"
#include "engine/run/scene_terms.hpp"

namespace abbe::diagnose {

namespace {

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

template <class Value>
double median_of(const Case& c, Value value) {
  std::vector<double> v;
  for (const RecordedTouch& t : c.touches.touches) v.push_back(value(t.scene));
  return median(std::move(v));
}

/// The stylus of a touch on a head that is turned elsewhere.
void turn_head(const Machine& machine, double a_rad, double b_rad, TouchScene& s, RecordedTouch& t) {
  const Mat3 R_old = s.stylus.R_WR, R_new = head_rotation(a_rad, b_rad);
  const Vec3 head{0, 0, -machine.head.l_r_mm}, tip_in_r = transpose(R_old) * (s.stylus.tip_from_mount_mm - head);
  const Vec3 tip = R_new * tip_in_r + head;
  s.reading -= tip - s.stylus.tip_from_mount_mm;
  s.stylus.tip_from_mount_mm = tip;
  s.stylus.R_WR = R_new;
  s.stylus.to_head = -unit(R_new * tip_in_r);
  s.stylus.head_a_rad = a_rad;
  s.stylus.head_b_rad = b_rad;
  t.per_rad_a_mm = head_derivative_a(a_rad, b_rad, tip_in_r);
  t.per_rad_b_mm = head_derivative_b(a_rad, b_rad, tip_in_r);
  set_levers(machine, s);
}

/// A stylus of another length along the same direction.
void change_length(const Machine& machine, double length_mm, TouchScene& s) {
  const Vec3 by = (s.stylus.length_mm - length_mm) * s.stylus.to_head;
  s.stylus.tip_from_mount_mm += by;
  s.reading -= by;
  s.stylus.length_mm = length_mm;
  s.stylus.ordinal += 100;
  set_levers(machine, s);
}

/// The part turned by a quarter about the vertical through the middle of the touches.
void turn_part(const Machine& machine, const Vec3& middle, TouchScene& s) {
  const Mat3 R = rotation({0, 0, 1}, kPi / 2);
  const Vec3 from = s.point;
  s.point = middle + R * (s.point - middle);
  s.normal = R * s.normal;
  s.travel = R * s.travel;
  s.reading += s.point - from;
  s.setup += 1000;
  set_levers(machine, s);
}

}  // namespace

std::vector<Change> changes_for(const Case& c) {
  std::vector<Change> list;
  const Machine& machine = *c.machine;
  const double speed = median_of(c, [](const TouchScene& s) { return s.speed_mm_s; });
  const double other_speed = speed > 5 ? speed / 3 : 3 * speed;
  list.push_back({fmt::format("repeat with probing speed {:.3g} mm/s", other_speed), "", fmt::format("FEDRAT/MESVEL,MMPS,{:.3g}", other_speed),
                  0u | Covariate::speed, 0, [=](RecordedTouch& t) { t.scene.speed_mm_s = other_speed; }});
  const double acceleration = median_of(c, [](const TouchScene& s) { return s.acceleration_mm_s2; });
  list.push_back({fmt::format("repeat with acceleration {:.3g} mm/s2", acceleration / 3), "", fmt::format("ACLRAT/MESACL,MMPSS,{:.3g}", acceleration / 3),
                  0u | Covariate::acceleration, 0, [=](RecordedTouch& t) { t.scene.acceleration_mm_s2 = acceleration / 3; }});
  const double length = median_of(c, [](const TouchScene& s) { return s.stylus.length_mm; });
  const double other_length = length > 60 ? length / 3 : 2 * length;
  list.push_back({fmt::format("repeat with a stylus of {:.0f} mm", other_length), fmt::format("mount a stylus of {:.0f} mm and qualify it", other_length), "",
                  0u | Covariate::sensor, 5, [=, &machine](RecordedTouch& t) { change_length(machine, other_length, t.scene); }});
  if (std::any_of(c.touches.touches.begin(), c.touches.touches.end(), [](const RecordedTouch& t) { return t.scene.stylus.indexed; }))
    list.push_back({"repeat with the head turned by B + 60 degrees", "qualify the stylus in the new orientation", "", 0u | Covariate::head, 3,
                    [&machine](RecordedTouch& t) {
                      turn_head(machine, t.scene.stylus.head_a_rad, t.scene.stylus.head_b_rad + kPi / 3, t.scene, t);
                      t.scene.visit += 1000;
                    }});
  Vec3 middle;
  for (const RecordedTouch& t : c.touches.touches) middle += t.scene.point / double(c.touches.touches.size());
  list.push_back({"repeat with the part turned by 90 degrees about the vertical", "turn the part by 90 degrees about the vertical and align it again", "",
                  0u | Covariate::part_frame, 10, [=, &machine](RecordedTouch& t) { turn_part(machine, middle, t.scene); }});
  list.push_back({"repeat with part and scales at a temperature 2 K higher", "let part, machine and room settle 2 K higher; log the temperatures", "",
                  Covariate::part_temperature | Covariate::scale_temperature | Covariate::air_temperature, 240, [](RecordedTouch& t) {
                    t.scene.temperature.part += 2;
                    for (double& s : t.scene.temperature.scale) s += 2;
                    t.scene.temperature.air += 2;
                  }});
  list.push_back({"repeat the whole sequence once more", "", "", 0u | Covariate::time, 0, [](RecordedTouch&) {}});
  list.push_back({"repeat with 200 kg more on the table", "put 200 kg beside the part", "", 0u | Covariate::load, 15, [](RecordedTouch& t) { t.scene.load_kg += 200; }});
  return list;
}

std::string dmis_program(const Case& c, const Change& change, const std::vector<RecordedTouch>& touches) {
  std::string out = fmt::format("DMISMN/'{}',5.2\nUNITS/MM,ANGDEC\n", change.text);
  if (!change.instruction.empty()) out += fmt::format("$$ before it: {}\nTEXT/OPER,'{}'\n", change.instruction, change.instruction);
  out += "MODE/PROG,MAN\nD(0)=DATSET/MCS\nSNSET/APPRCH,5\nSNSET/RETRCT,5\n";
  if (!change.statement.empty()) out += change.statement + "\n";
  std::string sensor;
  const Vec3 shift = c.touches.touches.front().scene.point -
                     (*c.recording->rows[c.touches.touches.front().row].target_mm - c.touches.touches.front().scene.stylus.radius_mm * c.touches.touches.front().scene.normal);
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const TouchScene& s = touches[k].scene;
    if (s.stylus.name != sensor) out += fmt::format("SNSLCT/SA({})\n", sensor = std::string(s.stylus.name));
    const Vec3 p = s.point - shift, n = s.normal, clear = p + (s.stylus.radius_mm + 20) * n;
    const std::string point = fmt::format("{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f}", p.x, p.y, p.z, n.x, n.y, n.z);
    out += fmt::format("F(P{0})=FEAT/POINT,CART,{1}\nGOTO/{2:.4f},{3:.4f},{4:.4f}\nMEAS/POINT,F(P{0}),1\nPTMEAS/CART,{1}\nENDMES\nOUTPUT/FA(P{0})\n", k + 1, point,
                       clear.x, clear.y, clear.z);
  }
  return out + "ENDFIL\n";
}

}  // namespace abbe::diagnose
