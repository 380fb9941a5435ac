// Error functions that are rougher than the specification's: real guides are not sums of seven harmonics.
//
// Every error function is a Gaussian process of the reading along its axis, once differentiable twice (Matern
// 5/2), of no preferred length: the mean of the covariances of three lengths, and a straight line. Its size
// is that of the machine file. A recording that fits it better than the harmonics is one of an uneven
// machine, not of physics left out. [Rasmussen & Williams 2006, 4.2.1; 8.3.1 for the columns]
#pragma once

#include "engine/diagnose/model/linear.hpp"
#include "engine/machine/machine.hpp"
#include "engine/run/recorded_touch.hpp"

namespace abbe::diagnose {

/// Rows x columns, um per standard deviation. `line`: standard deviation of the straight line, over that of
/// the process: scale and squareness are larger than waviness, until an earlier recording has told them.
Matrix rough_geometry(const RecordedTouches&, const Machine&, double line);

/// The same for each error function by itself, of short length only and without a line: a guide with one bad
/// error function.
std::vector<Matrix> uneven_functions(const RecordedTouches&, const Machine&);

}  // namespace abbe::diagnose
