// Everything that the geometry kernels compute for a few machines, in whatever namespace `abbe`
// stands for (level_v*_test.cpp).
#pragma once

#include <vector>

#include "engine/machine/geometry.hpp"

namespace abbe {

inline std::vector<double> level_sample() {
  Machine machine;
  machine.harmonics = 5;
  for (int k = 0; k < 3; ++k)
    machine.axes[k] = {600.0 + 130 * k, k == 2 ? -1 : 1, {-20.0 + k, 37.0 * k, 11.0 - 5 * k}, k == 1};
  machine.ram_chain = {Axis::x, Axis::z};
  machine.table_chain = {Axis::y};
  for (ComponentSpec& component : machine.components) component = {0.5, 0.2, 1e-3, {}};
  const int lanes = 37;
  std::vector<GeometryCoefficients> drawn;
  std::vector<const GeometryCoefficients*> pointers;
  for (int i = 0; i < lanes; ++i) drawn.push_back(draw_geometry(machine, 5, static_cast<std::uint32_t>(i)));
  for (const GeometryCoefficients& one : drawn) pointers.push_back(&one);

  std::vector<double> columns(9 * lanes);
  double* c = columns.data();
  double* enc[3] = {c, c + lanes, c + 2 * lanes};
  double* tip[3] = {c + 3 * lanes, c + 4 * lanes, c + 5 * lanes};
  double* d[3] = {c + 6 * lanes, c + 7 * lanes, c + 8 * lanes};
  std::vector<int> lane(lanes);
  for (int i = 0; i < lanes; ++i) {
    lane[i] = i;
    for (int k = 0; k < 3; ++k) enc[k][i] = machine.axes[k].direction * (3.7 * i + k), tip[k][i] = k - 0.1 * i;
  }
  GeometryBlock(machine, pointers).add_error(lanes, lane.data(), enc, tip, d);
  for (const GeometryCoefficients& one : drawn) columns.insert(columns.end(), one.begin(), one.end());
  return columns;
}

}  // namespace abbe
