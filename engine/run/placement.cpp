#include "engine/run/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/run/reference_run.hpp"

namespace abbe {

Placement find_placement(const plan::Plan& plan, const Machine& machine, const SourceFile& source) {
  const RunOptions options;
  const Executor::Observed observed = run_alone(Executor(plan, machine, options, source)).second;
  double low = INFINITY, high = -INFINITY;
  for (const auto& stop : observed.stops) {
    if (!stop.touch) continue;
    low = std::min(low, stop.reading_mm.z);
    high = std::max(high, stop.reading_mm.z);
  }
  const MachineAxis& z = machine[Axis::z];
  const double first = z.lowest_mm(), last = z.highest_mm();
  if (low > high || (z.reaches(low) && z.reaches(high)) || high - low > z.travel_mm) return {};
  const double shift = std::round((first + last) / 2 - (low + high) / 2);
  if (std::fabs(shift) > 2 * z.travel_mm) return {};
  Placement placement;
  placement.shift_mm.z = shift;
  placement.message = diagnostic(
      Code::W0303,
      fmt::format(
          "the touches need z readings from {:.0f} to {:.0f} mm, machine '{}' has {:.0f} to {:.0f}: the program's machine "
          "coordinates were shifted by {:+.0f} mm in z, to the middle of the travel",
          low, high, machine.name, first, last, shift),
      fmt::format("say where the part stands with a line such as `$$! place 0 0 {:.0f}` (mm)", shift));
  return placement;
}

}  // namespace abbe
