#include "engine/machine/error_state.hpp"

#include <doctest/doctest.h>

namespace abbe {

TEST_CASE("the error state runs from home to the ends of the travels, z fastest") {
  const Machine machine = read_machine("coord3-mc16");
  const GeometryCoefficients none(kComponents * basis_size(machine.harmonics));
  const ErrorState state = error_state(machine, none, {0, 0, -300}, 3);
  CHECK(state.reading_mm[0] == std::vector<double>{0, 800, 1600});
  CHECK(state.reading_mm[2] == std::vector<double>{0, -400, -800});
  CHECK(state.d_mm == std::vector<Vec3>(27));
}

TEST_CASE("the error state is what the kernel of the touches adds, on either side of the chain") {
  constexpr int n = 4;
  const Vec3 tip{30, -20, -300};
  for (const char* name : {"coord3-mc16", "moving-table-700"}) {
    const Machine machine = read_machine(name);
    const GeometryCoefficients geometry = draw_geometry(machine, 1, 7);
    const ErrorState state = error_state(machine, geometry, tip, n);
    const GeometryCoefficients* const one[] = {&geometry};
    const GeometryBlock block(machine, one);
    for (int ix = 0; ix < n; ++ix)
      for (int iy = 0; iy < n; ++iy)
        for (int iz = 0; iz < n; ++iz) {
          const double enc[] = {state.reading_mm[0][ix], state.reading_mm[1][iy], state.reading_mm[2][iz]};
          double d[3] = {};
          const double* const at[] = {&enc[0], &enc[1], &enc[2]};
          const double* const from_mount[] = {&tip.x, &tip.y, &tip.z};
          double* const out[] = {&d[0], &d[1], &d[2]};
          const int lane = 0;
          block.add_error(1, &lane, at, from_mount, out);
          CHECK(norm(state.at(ix, iy, iz) - Vec3{d[0], d[1], d[2]}) < 1e-12);
        }
    CHECK(norm(state.at(n - 1, n - 1, n - 1)) > 1e-4);
    CHECK(norm(state.at(0, 0, 0)) < 1e-15);
  }
}

}  // namespace abbe
