// The standard normal quantile for kernels: algorithm AS 241, PPND16 (M. J. Wichura, Applied
// Statistics 37, 1988, 477-484). AS 241 has three branches (centre, tails, far tails). Here all
// three are evaluated and one is selected, so that the loop vectorises; that costs some thirty
// multiplications and saves every misprediction.
#pragma once

#include <cmath>

#include "engine/lanes/elementary.hpp"

namespace abbe {

/// The x with P(X <= x) = p for X ~ N(0, 1). p in (0, 1), a normal number.
[[gnu::always_inline]] inline double normal_quantile_inline(double p) {
  const double q = p - 0.5;
  const double z = 0.180625 - q * q;
  const double centre = q *
      polynomial(z, 3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
                 4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3) /
      polynomial(z, 1.0, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3,
                 2.1213794301586595867e4, 3.9307895800092710610e4, 2.8729085735721942674e4, 5.2264952788528545610e3);

  const double r = std::sqrt(-log_positive(q < 0 ? p : 1 - p));
  const double near = r - 1.6, far = r - 5;
  const double near_top = polynomial(near, 1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0,
                                     3.64784832476320460504e0, 1.27045825245236838258e0, 2.41780725177450611770e-1,
                                     2.27238449892691845833e-2, 7.74545014278341407640e-4);
  const double near_bottom = polynomial(near, 1.0, 2.05319162663775882187e0, 1.67638483018380384940e0,
                                        6.89767334985100004550e-1, 1.48103976427480074590e-1, 1.51986665636164571966e-2,
                                        5.47593808499534494600e-4, 1.05075007164441684324e-9);
  const double far_top = polynomial(far, 6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0,
                                    2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                    2.71155556874348757815e-5, 2.01033439929228813265e-7);
  const double far_bottom = polynomial(far, 1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1,
                                       1.48753612908506148525e-2, 7.86869131145613259100e-4, 1.84631831751005468180e-5,
                                       1.42151175831644588870e-7, 2.04426310338993978564e-15);
  const double tail = (r <= 5 ? near_top : far_top) / (r <= 5 ? near_bottom : far_bottom);
  return std::fabs(q) <= 0.425 ? centre : q < 0 ? -tail : tail;
}

}  // namespace abbe
