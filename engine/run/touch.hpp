// One touch on many lanes: from the commanded point to the point that each machine reports.
//
// The machine drives its tip centre along -n, n being the commanded outward normal as this machine knows its
// own alignment, and stops where the tip meets the true surface, locally a plane. Its scales then read
//     measured = commanded + lambda n,     lambda = (r - n_true . (commanded - d - p_true)) / (n_true . n)
// with `measured = true + d`. So only the part of the error along the surface normal shows in a reading;
// across it a machine reports what it was commanded to. (The paper adds the whole vector d; for features
// fitted to surfaces the two agree to first order.)
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/machine/geometry.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

/// Three columns of numbers, one entry per touching lane.
struct Columns3 {
  std::array<std::vector<double>, 3> column;
  void resize(int n) {
    for (auto& c : column) c.resize(n);
  }
  void set(int i, const Vec3& v) { column[0][i] = v.x, column[1][i] = v.y, column[2][i] = v.z; }
  Vec3 get(int i) const { return {column[0][i], column[1][i], column[2][i]}; }
};

/// The inputs of one touch on n lanes, dense, and the errors that act on it. mm, frame W.
struct TouchBatch {
  int n = 0;
  Columns3 commanded;       ///< tip centre where the machine expects contact
  Columns3 normal;          ///< outward, as the machine knows it
  Columns3 surface;         ///< a point of the true surface
  Columns3 surface_normal;  ///< of the true surface there
  Columns3 reading;         ///< nominal scale readings
  Columns3 tip;             ///< tip centre from the mounting point
  Columns3 error;           ///< d: sum of all errors that act
  std::vector<double> radius;
  std::vector<int> lane;                      ///< lane of the block
  std::vector<std::uint32_t> machine, visit;  ///< for the random numbers
  std::vector<double> travel;                 ///< result: lambda

  void resize(int size);
};

/// Noise of the probe for the whole batch, added to `error`. R_WR per lane turns it from the probe's axes into W.
void add_probe_noise(TouchBatch&, const ProbeSpec&, std::uint64_t seed, std::uint32_t site,
                     const std::vector<Mat3>& R_WR);

/// Fills `travel` from everything else.
void find_contact(TouchBatch&);

}  // namespace abbe
