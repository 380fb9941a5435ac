// Geometric errors of virtual machines: the 18 error functions of each, and what they do to the tip
// (docs/physics.md, "Geometry").
//
// Each error function is a linear combination of fixed basis functions of the normalised reading u in [-1, 1]:
//   1, u, 2u^2 - 1, cos(n pi u), sin(n pi u) for n = 1..N
// so a virtual machine is a table of coefficients, evaluated exactly: no interpolation. u = -1 is home, where
// the scale reads 0.
//
// Frames. {0} is the base. W is the machine coordinate system: it rides with the part, and coincides with {0}
// while the table-side axes are at home. A ram-side axis j carries the tip: d += e_j + w_j x l_j, with l_j
// from its frame to the tip. A table-side axis carries the part, so it moves the part away from under the
// tip: its frame stands at the sum of (offset_k - enc_k axis_k) over the table chain up to j, and d -= e_j +
// w_j x l_j, with l_j again from its frame to the tip (the point on the part).
//
// Squarenesses. Positive: the angle between the two axes is larger than 90 degrees. The tip is then less far
// along the first axis than the machine believes, so with measured = true + d: d_x = cwy y + bwz z, d_y = awz
// z (readings). They are linear terms of exy, exz and eyz (with the opposite sign in the function of a
// table-side axis, which enters with a minus).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/machine/machine.hpp"

namespace abbe {

/// Number of basis functions for N harmonics.
constexpr int basis_size(int harmonics) { return 3 + 2 * harmonics; }

/// Coefficients of one virtual machine, [component][basis], in mm or rad.
using GeometryCoefficients = std::vector<double>;

/// Draws the error functions of one virtual machine. Numbers depend on (seed, machine index, component) only.
GeometryCoefficients draw_geometry(const Machine&, std::uint64_t seed, std::uint32_t machine_index);

/// The value of one error function at a scale reading, mm or rad: the plain reference of the lane kernel.
double error_at(const Machine&, const GeometryCoefficients&, Component, double reading_mm);

/// The lever from the frame of one axis to the tip, as it depends on the readings.
struct AxisLever {
  double sign = 1;  ///< of the axis' contribution: +1 ram side, -1 table side
  Vec3 offset_mm;
  Vec3 reach;  ///< 1 where the reading of axis k lengthens the lever, else 0
  /// The lever at given readings, mm.
  constexpr Vec3 at(const Vec3& enc_mm, const Vec3& tip_from_mount) const {
    return offset_mm + Vec3{reach.x * enc_mm.x, reach.y * enc_mm.y, reach.z * enc_mm.z} + tip_from_mount;
  }
};
AxisLever axis_lever(const Machine&, Axis);

/// The 18 values at one position of the carriages.
struct AxisErrors {
  double value[kComponents] = {};
};
/// First-order error d of the tip centre in W (measured = true + d), mm, for readings `enc_mm` and nominal
/// tip `tip_from_mount`.
Vec3 geometric_error(const Machine&, const AxisErrors&, const Vec3& enc_mm, const Vec3& tip_from_mount);
/// The same from the full product of the transforms: the oracle of the tests.
Vec3 geometric_error_exact(const Machine&, const AxisErrors&, const Vec3& enc_mm, const Vec3& tip_from_mount);

/// Coefficients of a block of virtual machines in structure-of-arrays form for the lane kernel.
class GeometryBlock {
 public:
  GeometryBlock(const Machine&, std::span<const GeometryCoefficients* const> machines);
  int lanes() const { return lanes_; }

  /// Adds the geometric error of n touches. Touch i happens on lane `lane[i]` of the block (lane[i] = i
  /// everywhere is the fast case). enc, tip and d are arrays of three columns each: column k of enc is
  /// enc[k][0..n). tip: tip from mount, mm.
  void add_error(int n, const int* lane, const double* const enc[3], const double* const tip[3],
                 double* const d[3]) const;

 private:
  template <class Index>
  void add_error_indexed(int n, Index lane, const double* const enc[3], const double* const tip[3],
                         double* const d[3]) const;

  struct AxisData {
    AxisLever lever;
    double u_per_mm = 0;
  };
  std::array<AxisData, 3> axes_;
  int harmonics_ = 0, lanes_ = 0;
  std::vector<double> coefficients_;  // [axis][basis][component of the axis][lane]
};

}  // namespace abbe
