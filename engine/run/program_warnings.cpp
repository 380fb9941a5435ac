#include "engine/run/program_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/features/nominal_normal.hpp"
#include "engine/math/units.hpp"

namespace abbe {

namespace {

/// Those of the first statements, each of which is named once however often it is run.
class Warnings {
 public:
  Warnings(const plan::Plan& plan, const SourceFile& source) : plan_(plan), source_(source) {}

  void add(int operation, Code code, std::string message, std::string help) {
    const Span span = plan_.operations[static_cast<std::size_t>(operation)].span;
    if (!named_.insert({code, span.begin}).second || ++count_[code] > kMost) return;
    list_.push_back(diagnostic_at(source_, span, code, std::move(message), std::move(help)));
  }
  std::vector<Diagnostic> take() { return std::move(list_); }

 private:
  static constexpr std::size_t kMost = 10;  ///< of a kind
  const plan::Plan& plan_;
  const SourceFile& source_;
  std::set<std::pair<Code, std::uint32_t>> named_;
  std::map<Code, std::size_t> count_;
  std::vector<Diagnostic> list_;
};

/// Touches outside are errors; where a move leads nothing is measured, but a real machine stops there.
void warn_of_far_moves(const Executor::Observed& observed, const Machine& machine, Warnings& out) {
  for (const Executor::Stop& stop : observed.stops) {
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
      const double reading = stop.reading_mm[static_cast<int>(axis)];
      if (stop.touch || machine[axis].reaches(reading)) continue;
      out.add(
          stop.operation, Code::W0309,
          fmt::format("this move leads outside the travel of machine '{}': it needs the {} scale at {:.3f} mm, which "
                      "runs from {:g} to {:g} mm",
                      machine.name, "xyz"[static_cast<int>(axis)], reading, machine[axis].lowest_mm(),
                      machine[axis].highest_mm()),
          "correct the point, or move the part with a `$$! place dx dy dz` line");
      break;
    }
  }
}

/// Whether all touches come from the side opposite to the nominal one.
bool from_the_other_side(const plan::FeatureDef& def, const Executor::Measured& measured) {
  constexpr double kOpposite = -0.9;  // a dummy nominal that stands askew says nothing
  return !measured.targets.empty() &&
      std::all_of(measured.targets.begin(), measured.targets.end(), [&](const Target& touch) {
        const Outcome<Vec3> facing = nominal_normal(*def.kind, measured.nominal, def.inner, touch.point);
        return facing && dot(facing.value, touch.normal) < kOpposite;
      });
}

void warn_of_sides(const Executor::Observed& observed, const plan::Plan& plan, Warnings& out) {
  for (const Executor::Measured& measured : observed.measured) {
    const plan::FeatureDef& def = plan[measured.feature];
    if (def.kind->spread == 0 || !from_the_other_side(def, measured)) continue;
    if (def.kind->flat)
      out.add(
          measured.operation, Code::W0310,
          fmt::format("F({}) was touched from behind: its direction stays that of FEAT, into the material", def.label),
          "turn the vector in FEAT round, or those in PTMEAS");
    else
      out.add(measured.operation, Code::W0310,
              fmt::format("F({}) is {} in FEAT, and its touches come from {}: material conditions go by FEAT",
                          def.label, def.inner ? "INNER" : "OUTER", def.inner ? "outside" : "inside"),
              fmt::format("write {} in FEAT, or turn the vectors in PTMEAS", def.inner ? "OUTER" : "INNER"));
  }
}

/// Of the reference: the operations of its touches, in the order in which they were made.
std::vector<int> touch_operations(const std::vector<Executor::Stop>& stops) {
  std::vector<int> operations;
  for (const Executor::Stop& stop : stops)
    if (stop.touch) operations.push_back(stop.operation);
  return operations;
}

/// The angle between the vector of each touch and the normal of the surface there: that of the element which the
/// error-free machine found, because a FEAT may be a dummy. Nothing of points and lines, where only the vectors tell how
/// the surface lies.
std::vector<double> angles_rad(const FeatureKind& kind, const Executor::Measured& measured) {
  std::vector<double> angles;
  if (kind.acts_as == Shape::point || kind.acts_as == Shape::line) return angles;
  for (const Target& touch : measured.targets) {
    const Outcome<Vec3> normal = kind.normal(measured.actual, touch.point);
    angles.push_back(normal ? std::acos(std::min(1.0, std::fabs(dot(normal.value, touch.normal)))) : 0);
  }
  return angles;
}

/// Errors move a touch along its vector: where that lies along the surface they are not those of the surface, and u is
/// wrong. Radial vectors on a cone are meant, up to a countersink of 120 degrees.
void warn_of_vectors(const Executor::Observed& observed, const plan::Plan& plan, Warnings& out) {
  constexpr double kMeant_rad = 61 * kDegree;
  const std::vector<int> operations = touch_operations(observed.stops);
  std::size_t first = 0;  // of the touches of a feature
  for (const Executor::Measured& measured : observed.measured) {
    const plan::FeatureDef& def = plan[measured.feature];
    const std::vector<double> angles = angles_rad(*def.kind, measured);
    const auto beside = [](double angle) { return angle > kMeant_rad; };
    if (const auto found = std::find_if(angles.begin(), angles.end(), beside); found != angles.end()) {
      const auto touch = static_cast<std::size_t>(found - angles.begin());
      const auto count = std::count_if(found, angles.end(), beside);
      out.add(operations.at(first + touch), Code::W0312,
              fmt::format("the vector of touch {} of F({}) lies {:.0f} degrees from the normal of its surface{}",
                          touch + 1, def.label, in_degrees(*found),
                          count > 1 ? fmt::format(", the first of {} such vectors", count) : ""),
              "write the normal of the surface in PTMEAS: errors act along the vector of a touch, and u is wrong");
    }
    first += measured.targets.size();
  }
}

void warn_of_thick_balls(const Executor::Observed& observed, const plan::Plan& plan, Warnings& out) {
  for (const Executor::Measured& measured : observed.measured) {
    const plan::FeatureDef& def = plan[measured.feature];
    const bool round =
        def.kind->shape == Shape::circle || def.kind->shape == Shape::cylinder || def.kind->shape == Shape::sphere;
    if (!round || !def.inner || measured.radius_mm < measured.actual.size) continue;
    out.add(measured.operation, Code::W0311,
            fmt::format("a ball of {:g} mm does not fit into F({}), which is {:g} mm wide", 2 * measured.radius_mm,
                        def.label, 2 * measured.actual.size),
            "select a thinner stylus");
  }
}

std::map<int, int> first_evaluations(const plan::Plan& plan) {
  std::map<int, int> operations;  // by characteristic
  for (std::size_t k = 0; k < plan.operations.size(); ++k)
    if (const auto* evaluate = std::get_if<plan::Evaluate>(&plan.operations[k].action))
      operations.emplace(evaluate->characteristic.value, static_cast<int>(k));
  return operations;
}

/// Form, orientation, location and run-out of the nominal part are 0 but for rounded numbers. What is far from that
/// was taken of another datum or angle than is meant, or FEAT lies elsewhere than the touches.
void warn_of_zones(const Executor::Observed& observed, const plan::Plan& plan, Warnings& out) {
  constexpr double kRounded_mm = 1;  // taught touches too: as far from the drawing as a part may be
  const std::map<int, int> evaluations = first_evaluations(plan);
  for (const Value& v : observed.nominal_values) {
    const plan::CharacteristicDef& def = plan[v.characteristic];
    const plan::ToleranceDef& tolerance = plan[def.tolerance];
    const bool zone = tolerance.kind->unit == Unit::mm && !v.limits.lower && v.limits.upper;
    if (!zone || v.value <= std::max(kRounded_mm, *v.limits.upper)) continue;
    out.add(evaluations.at(v.characteristic.value), Code::W0313,
            fmt::format("even of the nominal part {} of FA({}) is {:.3f} mm", tolerance.kind->word,
                        plan[def.features.front()].label, v.value),
            "check the datum and what is asked of it, and that FEAT says what PTMEAS touches");
  }
}

}  // namespace

std::vector<Diagnostic> program_warnings(const Executor::Observed& observed, const plan::Plan& plan,
                                         const Machine& machine, const SourceFile& source) {
  Warnings out(plan, source);
  warn_of_far_moves(observed, machine, out);
  warn_of_sides(observed, plan, out);
  warn_of_vectors(observed, plan, out);
  warn_of_thick_balls(observed, plan, out);
  warn_of_zones(observed, plan, out);
  return out.take();
}

}  // namespace abbe
