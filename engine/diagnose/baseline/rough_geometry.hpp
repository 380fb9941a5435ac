// Error functions that are rougher than the specification's: real guides are not sums of seven harmonics.
//
// Every error function is a Gaussian process of the reading along its axis, once differentiable twice (Matern
// 5/2), of no preferred length: the mean of the covariances of three lengths, and a straight line. Its size
// is that of the machine file. A recording that fits it better than the harmonics is one of an uneven
// machine, not of physics left out. [Rasmussen & Williams 2006, 4.2.1; 8.3.1 for the columns]
#pragma once

#include <cstdint>

#include "engine/diagnose/model/linear.hpp"
#include "engine/machine/machine.hpp"
#include "engine/machine/screening.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

struct RoughGeometry {
  Matrix um;  ///< rows x columns, per standard deviation
  /// of the harmonics that come nearest to each column: coefficients x columns; mm, rad
  Matrix harmonics;
};

/// The straight lines of scale and squareness are larger than waviness.
RoughGeometry rough_geometry(const RecordedTouches&, const Machine&);

/// Virtual machines with such errors, but for the straight lines that machines of the specification have, and the machine
/// that has the harmonics for them. Each is as large as the specification lets it be: of the MPE its worst length takes a
/// share that is drawn evenly between those of v_max and v_min.
struct RoughMachines {
  Machine machine;
  VirtualMachines machines;
};
RoughMachines rough_machines(const Machine&, std::uint64_t seed, int count, int threads);

/// Each error function by itself, of short length only and without a line, in the order of the components; then all
/// those of each axis together; then, for each axis, its straightnesses and its angles by themselves as a wavy rail makes
/// them: one bad error function, a bad guide, or a rail whose waves show in one of the two only, which is no coupling of
/// both.
std::vector<Matrix> uneven_functions(const RecordedTouches&, const Machine&);

/// The same of a machine that an earlier recording has told, by sums of harmonics: what these cannot follow,
/// and a fifth of the size of every other shape.
RoughGeometry rough_geometry_left(const RecordedTouches&, const Machine&);
std::vector<Matrix> uneven_functions_left(const RecordedTouches&, const Machine&);

}  // namespace abbe::diagnose
