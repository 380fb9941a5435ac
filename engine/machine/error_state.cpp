#include "engine/machine/error_state.hpp"

namespace abbe {

ErrorState error_state(const Machine& machine, const GeometryCoefficients& geometry, const Vec3& tip_mm, int readings) {
  ErrorState out{tip_mm, {}, {}};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < readings; ++i)
      out.reading_mm[axis].push_back(machine.axes[axis].direction * machine.axes[axis].travel_mm * i / (readings - 1));
  for (const double x : out.reading_mm[0])
    for (const double y : out.reading_mm[1])
      for (const double z : out.reading_mm[2]) {
        const Vec3 enc_mm{x, y, z};
        AxisErrors errors;
        for (int k = 0; k < kComponents; ++k) {
          const auto component = static_cast<Component>(k);
          errors.value[k] = error_at(machine, geometry, component, enc_mm[static_cast<int>(axis_of(component))]);
        }
        out.d_mm.push_back(geometric_error(machine, errors, enc_mm, tip_mm));
      }
  return out;
}

}  // namespace abbe
