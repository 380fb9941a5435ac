// What is known of a quantity whose value is uncertain, as the probability distributions of
// JCGM 101:2008, 6.4, and numbers drawn from them.
//
// A distribution here is centred on zero: it describes the deviation from the best estimate. One
// deviation is made of one pair of uniform numbers, so every quantity needs one address of
// lanes/random.hpp whatever its distribution. Only the functions of lanes/elementary.hpp are used:
// the same bits on every machine.
//
//   normal             u * quantile(a)                                                    6.4.7
//   student_t          u * sqrt(dof (a^(-2/dof) - 1)) cos(2 pi b)                         6.4.9
//                      (exact for any dof: R. W. Bailey, Math. of Computation 62, 1994, 779-781)
//   rectangular        w (2 a - 1)                                                        6.4.2
//   triangular         w (a + b - 1)                                                      6.4.5
//   arcsine            w sin(pi (a - 1/2)), the U-shaped distribution of a cycle          6.4.6
//   trapezoidal        w [ (1 + s)/2 (2 a - 1) + (1 - s)/2 (2 b - 1) ], s top over base   6.4.4
//   curvilinear        [ w + d (1 - 2 a) ] (2 b - 1): a rectangle whose half width lies
//   trapezoid          between w - d and w + d                                            6.4.3
#pragma once

#include "engine/lanes/random.hpp"

namespace abbe {

enum class Distribution { normal, student_t, rectangular, triangular, arcsine, trapezoidal, curvilinear_trapezoid };

/// One independent part of what is not known of a quantity, in the unit of that quantity.
struct Deviation {
  Distribution distribution = Distribution::normal;
  /// normal: standard uncertainty. student_t: the standard uncertainty s / sqrt(n) that n readings
  /// give, which is the scale of the distribution; its own standard deviation is larger by
  /// sqrt(dof / (dof - 2)). All others: half the width of the base.
  double scale = 0;
  /// student_t: degrees of freedom. trapezoidal: width of the top over that of the base, 0..1.
  /// curvilinear_trapezoid: inexactness d of the half width, 0..scale.
  double shape = 0;
};

/// The deviation that a pair of uniform numbers stands for.
double deviation(const Deviation&, UniformPair);
/// The standard deviation of the distribution. student_t: needs dof > 2.
double standard_deviation(const Deviation&);
/// Half the width of the base that gives a standard deviation `u`; 0 when `shape` alone is more
/// than `u`. Not for normal and student_t, which have no width.
double half_width_for(Distribution, double shape, double u);

}  // namespace abbe
