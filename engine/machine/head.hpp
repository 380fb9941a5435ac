// The articulating head (paper section 8.2, eq. 25). A turns first, B then, both in
// rad; A = 0 points down.
#pragma once

#include "engine/math/vec.hpp"

namespace abbe {

/// R_mr = Rz(B) Ry(-A).
Mat3 head_rotation(double a_rad, double b_rad);
/// d(R_mr tip_r)/dA and d(R_mr tip_r)/dB, mm/rad: multiplied by the indexing errors they give the
/// displacement of the tip.
Vec3 head_derivative_a(double a_rad, double b_rad, const Vec3& tip_in_r);
Vec3 head_derivative_b(double a_rad, double b_rad, const Vec3& tip_in_r);

}  // namespace abbe
