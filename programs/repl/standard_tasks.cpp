#include "programs/repl/standard_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/machine/acceptance/acceptance.hpp"
#include "engine/machine/geometry.hpp"
#include "engine/run/sensor.hpp"
#include "lang/compile.hpp"

namespace abbe {

namespace {

constexpr double kSphereRadius = 15, kLongestLength = 300, kShareOfTravel = 0.4;
constexpr std::array kAxisLetters = {'X', 'Y', 'Z'};

Vec3 middle_reading(const Machine& machine) {
  Vec3 middle;
  for (int k = 0; k < 3; ++k) middle[k] = machine.axes[k].direction * machine.axes[k].travel_mm / 2;
  return middle;
}

std::string touch(const Vec3& p, const Vec3& n) {
  return fmt::format("PTMEAS/CART,{},{},{},{},{},{}\n", p.x, p.y, p.z, n.x, n.y, n.z);
}

/// Two points that face away from each other along one axis, and the distance between them.
std::string length_task(int axis, double length) {
  std::string text;
  for (const int side : {-1, 1}) {
    Vec3 p{}, n{};
    p[axis] = side * length / 2;
    n[axis] = side;
    const std::string label = fmt::format("{}{}", kAxisLetters[axis], side < 0 ? "1" : "2");
    text += fmt::format("F({0})=FEAT/POINT,CART,{1},{2},{3},{4},{5},{6}\nMEAS/POINT,F({0}),1\n", label, p.x, p.y, p.z,
                        n.x, n.y, n.z) +
        touch(p, n) + "ENDMES\n";
  }
  return text +
      fmt::format("T({0})=TOL/DISTB,NOMINL,{1},-1,1,PT2PT\nOUTPUT/FA({0}1),FA({0}2),TA({0})\n", kAxisLetters[axis],
                  length);
}

/// The 25 touches of ISO 10360-5.
std::string sphere_task() {
  std::string text =
      fmt::format("F(SPHERE)=FEAT/SPHERE,OUTER,CART,0,0,0,{}\nMEAS/SPHERE,F(SPHERE),25\n", 2 * kSphereRadius);
  for (const Vec3& n : form_and_size_pattern()) text += touch(n * kSphereRadius, n);
  return text +
      "ENDMES\nT(SIZE)=TOL/DIAM,-1,1\nT(FORM)=TOL/CIRLTY,1\nOUTPUT/"
      "FA(SPHERE),TA(SIZE),TA(FORM)\n";
}

/// The tasks at `place` in machine coordinates, for a sensor that is filled in afterwards.
CompiledProgram standard_program(const Vec3& place, double length) {
  std::string text = "DMISMN/'standard tasks',5.2\nUNITS/MM,ANGDEC\nPRCOMP/ON\nSNSLCT/SA(CANDIDATE)\n";
  text += fmt::format("D(PLACE)=TRANS/XORIG,{},YORIG,{},ZORIG,{}\n", place.x, place.y, place.z);
  for (int axis = 0; axis < 3; ++axis) text += length_task(axis, length);
  SourceFile source("standard tasks", text + sphere_task() + "ENDFIL\n");
  Sink sink;
  lang::Compilation compilation = lang::compile(source, sink);
  ABBE_CHECK(!sink.has_errors() && compilation.plan.sensors.size() == 1);
  compilation.directives.place_mm = Vec3{};
  return {std::move(source), std::move(compilation), {}, false};
}

/// Nothing when the tip does not reach the place.
std::optional<TaskUncertainties> study_tasks(const CompiledProgram& program, const StudySettings& settings) {
  try {
    const RunReport report = study_program(program, settings, read_inputs(program, settings)).report;
    if (report.characteristics.size() != 5) return std::nullopt;
    const auto u95 = [&](std::size_t k) {
      const Interval& i = report.characteristics[k].summary.symmetric;
      return (i.high - i.low) / 2;
    };
    return TaskUncertainties{{u95(0), u95(1), u95(2)}, u95(3), report.characteristics[4].summary.symmetric.high};
  } catch (const UserError& error) {
    if (error.diagnostics().front().code == Code::E0302) return std::nullopt;
    throw;
  }
}

SensorFigures geometry_of(const plan::SensorDef& def, const Machine& machine, const SourceFile& source) {
  SensorFigures figures;
  figures.label = def.label;
  figures.tip_from_mount_mm = resolve_sensor(def, machine, source).tip_from_mount_mm;
  for (int k = 0; k < 3; ++k) {
    Vec3 lever = axis_lever(machine, static_cast<Axis>(k)).at(middle_reading(machine), figures.tip_from_mount_mm);
    lever[k] = 0;
    figures.lever_mm[static_cast<std::size_t>(k)] = norm(lever);
  }
  return figures;
}

/// Without the sign that rounding leaves on a zero.
double without_dust(double mm) { return std::fabs(mm) < 0.005 ? 0 : mm; }

std::string micrometres(double mm) { return fmt::format("{:.2f}", 1000 * mm); }

}  // namespace

double standard_length_mm(const Machine& machine) {
  double length = kLongestLength;
  for (const MachineAxis& axis : machine.axes) length = std::min(length, kShareOfTravel * axis.travel_mm);
  return std::floor(length);
}

std::vector<SensorFigures> sensor_figures(const std::vector<plan::SensorDef>& candidates, const Machine& machine,
                                          const SourceFile& source, const StudySettings& settings) {
  std::vector<SensorFigures> out;
  Vec3 place = middle_reading(machine) + machine.home_offset();
  for (const plan::SensorDef& def : candidates) {
    out.push_back(geometry_of(def, machine, source));
    place = place + out.back().tip_from_mount_mm / static_cast<double>(candidates.size());
  }
  CompiledProgram program = standard_program(place, standard_length_mm(machine));
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    program.compilation.plan.sensors[0] = candidates[k];
    program.compilation.plan.sensors[0].span = {};
    out[k].tasks = study_tasks(program, settings);
  }
  return out;
}

std::string sensor_table(const std::vector<SensorFigures>& sensors) {
  std::string out = fmt::format(
      "{:<16}{:^30}{:^24}{:^27}{:>9}{:>9}\n{:<16}{:>10}{:>10}{:>10}{:>8}{:>8}{:>8}{:>9}{:>9}{:>9}{:"
      ">9}{:>9}\n",
      "", "tip from mount, mm", "Abbe levers, mm", "u95 of lengths, um", "size", "form", "sensor", "x", "y", "z",
      "of X", "of Y", "of Z", "X", "Y", "Z", "um", "um");
  for (const SensorFigures& s : sensors) {
    out += fmt::format("{:<16}{:>10.2f}{:>10.2f}{:>10.2f}{:>8.0f}{:>8.0f}{:>8.0f}", s.label,
                       without_dust(s.tip_from_mount_mm.x), without_dust(s.tip_from_mount_mm.y),
                       without_dust(s.tip_from_mount_mm.z), s.lever_mm[0], s.lever_mm[1], s.lever_mm[2]);
    if (s.tasks)
      out += fmt::format("{:>9}{:>9}{:>9}{:>9}{:>9}\n", micrometres(s.tasks->length_mm[0]),
                         micrometres(s.tasks->length_mm[1]), micrometres(s.tasks->length_mm[2]),
                         micrometres(s.tasks->size_mm), micrometres(s.tasks->form_mm));
    else
      out += "   does not reach the place of the tasks\n";
  }
  return out;
}

}  // namespace abbe
