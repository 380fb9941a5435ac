// The effects of the articulating head (docs/physics/head.md), one per .cpp file, and the geometry
// that they share.
//
// R_WR = M Rz(B) Ry(-A): B turns about the mount's axis, and carries the axis of A. Whatever the
// mounting M, the two axes follow from R_WR and A alone, so the effects need no other knowledge of
// the machine.
#pragma once

#include "engine/effects/effect.hpp"

namespace abbe {

extern const Effect kHeadAxisErrors;
extern const Effect kHeadReindexing;
extern const Effect kHeadSag;
extern const Effect kHeadQualification;

/// From the centre of the head to the tip, W, mm.
constexpr Vec3 head_arm(const StylusScene& stylus) { return -stylus.length_mm * stylus.to_head; }

/// The frame that B carries, between the two axes: its y is the axis of A (A turns about -y), its z
/// the axis of B. In W.
inline Mat3 frame_after_b(const StylusScene& stylus) {
  const double c = std::cos(stylus.head_a_rad), s = std::sin(stylus.head_a_rad);
  const Mat3& R = stylus.R_WR;
  return {c * R.cx - s * R.cz, R.cy, s * R.cx + c * R.cz};
}

}  // namespace abbe
