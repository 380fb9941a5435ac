// Geometric errors of virtual machines: the 18 error functions of each, and what they do to the tip (physics.md 1 and 2).
//
// Each error function is a linear combination of fixed basis functions of the normalised reading u in [-1, 1]:
//   1, u, 2u^2 - 1, cos(n pi u), sin(n pi u) for n = 1..N
// so a virtual machine is a table of coefficients, evaluated exactly: no interpolation.
#pragma once

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

/// The 18 values at one position of the carriages.
struct AxisErrors {
  double value[kComponents] = {};
};
/// First-order error d of the tip centre in W (measured = true + d), mm, for readings `enc_mm` and nominal tip `tip_from_mount`.
Vec3 geometric_error(const Machine&, const AxisErrors&, const Vec3& enc_mm, const Vec3& tip_from_mount);
/// The same from the full product of the transforms: the oracle of the tests.
Vec3 geometric_error_exact(const Machine&, const AxisErrors&, const Vec3& enc_mm, const Vec3& tip_from_mount);

/// Coefficients of a block of virtual machines in structure-of-arrays form for the lane kernel.
class GeometryBlock {
 public:
  GeometryBlock(const Machine&, std::span<const GeometryCoefficients* const> machines);
  int lanes() const { return lanes_; }

  /// Adds the geometric error of n touches. Touch i happens on lane `lane[i]` of the block (lane[i] = i everywhere is the fast
  /// case). enc, tip and d are arrays of three columns each: column k of enc is enc[k][0..n). tip: tip from mount, mm.
  void add_error(int n, const int* lane, const double* const enc[3], const double* const tip[3], double* const d[3]) const;

 private:
  const Machine* machine_;
  int lanes_ = 0, stride_ = 0;
  std::vector<double> coefficients_;  // [component][basis][lane]
};

}  // namespace abbe
