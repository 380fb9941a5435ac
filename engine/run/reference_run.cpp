#include "engine/run/reference_run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/math/units.hpp"
#include "engine/run/program_warnings.hpp"

namespace abbe {

namespace {

/// What else may be wrong where a touch is outside the travel: offsets of which one is left out or has the other sign.
std::string where_home_is(const Machine& machine) {
  const Vec3 home = machine.home_offset();
  if (norm(home) < kUm) return "";
  return fmt::format(
      "; at readings of 0 the head's mount stands at {:g}, {:g}, {:g} mm, the sum of the offsets_mm on the ram side",
      home.x, home.y, home.z);
}

/// A touch is its statement; of a default touch there is none.
std::string name_of(const Executor::Stop& stop, const plan::Plan& plan) {
  const auto& touch = std::get<plan::Touch>(plan.operations[stop.operation].action);
  if (touch.pattern_count == 0) return "this touch";
  const auto shown = [](double mm) { return std::round(1000 * mm) / 1000 + 0.0; };  // no -0.000
  const Vec3& at = stop.surface_mm;
  return fmt::format("default touch {} of F({}), at {:.3f}, {:.3f}, {:.3f} mm in the coordinate system there,",
                     touch.pattern_index + 1, plan[touch.feature].label, shown(at.x), shown(at.y), shown(at.z));
}

/// Every touch of the error-free machine must lie inside the travel.
void check_travel(const std::vector<Executor::Stop>& stops, const plan::Plan& plan, const Machine& machine,
                  const SourceFile& source) {
  constexpr std::size_t kShown = 10;
  std::vector<Diagnostic> errors;
  std::size_t outside = 0;
  for (const Executor::Stop& stop : stops) {
    if (!stop.touch) continue;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
      const double reading = stop.reading_mm[static_cast<int>(axis)];
      if (machine[axis].reaches(reading)) continue;
      if (++outside > kShown) break;
      errors.push_back(diagnostic_at(
          source, plan.operations[stop.operation].span, Code::E0302,
          fmt::format(
              "{} is outside the travel of machine '{}': it needs the {} scale at {:.3f} mm, which runs from {:g} to {:g} mm",
              name_of(stop, plan), machine.name, "xyz"[static_cast<int>(axis)], reading, machine[axis].lowest_mm(),
              machine[axis].highest_mm()),
          "move the part with a `$$! place dx dy dz` line, correct the point, or choose a larger machine" +
              where_home_is(machine)));
      break;
    }
  }
  if (outside > kShown) errors.back().help += fmt::format(" ({} touches in all are outside)", outside);
  if (!errors.empty()) throw UserError(std::move(errors));
}

bool evaluates(const plan::Operation& operation) { return std::holds_alternative<plan::Evaluate>(operation.action); }

}  // namespace

std::pair<Lane, Executor::Observed> run_alone(const Executor& executor) {
  Block block = executor.make_block({}, 0, 0);
  Executor::Observed observed = executor.observe(block);
  observed.nominal_values = block.lanes[block.lanes[block.reference()].nominal].values;
  return {std::move(block.lanes[block.reference()]), std::move(observed)};
}

ReferenceRun reference_run(Executor& executor, const plan::Plan& plan, const Machine& machine,
                           const SourceFile& source) {
  auto [lane, observed] = run_alone(executor);
  if (!lane.trap.reason.empty()) {
    const plan::Operation& stopped = plan.operations[lane.trap.operation];
    throw UserError(diagnostic_at(
        source, stopped.span, Code::E0304, "not even an error-free machine can go on here: " + lane.trap.reason,
        fmt::format("correct the statement; `abbe run --only-valid` leaves {} out",
                    evaluates(stopped) ? "this characteristic" : "it and all that rests on it")));
  }
  check_travel(observed.stops, plan, machine, source);
  std::vector<Diagnostic> warnings = program_warnings(observed, plan, machine, source);
  executor.know(std::move(observed.fits));
  executor.place_part(observed.frames.of_part(executor.machine_frame()));
  executor.find_curved(observed.curved);
  return {std::move(lane), std::move(observed.outputs), std::move(warnings)};
}

}  // namespace abbe
