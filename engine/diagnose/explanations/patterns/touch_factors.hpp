// The factors of the touches of a recording, in the units in which patterns are spread.
#pragma once

#include "engine/diagnose/explanations/patterns/functions.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose::patterns {

/// Everything by row of the recording.
struct TouchFactors {
  TouchFactors(const RecordedTouches&, const std::vector<int>& rows);

  // Of [0, 1] from the first to the last.
  Points time;
  double duration_s = 1;    ///< of it
  bool timed = false;       ///< whether a clock has told it
  Points touch;             ///< its number in the sequence
  Points settled, clamped;  ///< time since the head, or the part, was moved to where it is
  Points reading[3];
  Points place;            ///< in W, from 0 to 1 along the longest extent
  bool one_round = false;  ///< all touches are on one ball or circle, put down once: their normals tell their places

  // Directions and displacements that a change of one unit has along the normal.
  Directions normal, normal_on_part;
  Directions normal_on_probe;  ///< last link of the head
  Directions turned;           ///< of a small rotation of the wrist about its centre; 100 mm of stylus is the unit
  Directions travel, travel_on_probe;
  Directions skid;             ///< what of the travel is along the surface, on the probe
  Directions before_on_probe;  ///< normal of the touch before, in the same visit of the head; zero where there is none
  /// Of the first touch on a feature the way from the one before, of the last that to the next, of length 1; zero for all
  /// others, and where the part was put down anew.
  Directions arriving, leaving;
  bool oblique = false;  ///< some approaches are not along the normal

  // Groups.
  std::vector<int> orientation, sensor, feature, setup, run;
  std::vector<double> speed_mm_s;
  std::vector<int> speed;     ///< levels, from the slowest
  std::vector<int> dynamics;  ///< levels of speed and acceleration that were used together

  Vector part_above_20, scale_above_20[3];  ///< degrees C
};

/// Whether there is more than one group.
bool several(const std::vector<int>& group);
/// Whether temperatures differ so much that something can be seen of it.
bool differ(const Vector& temperature);

/// A share of the sequence of touches, but so many of them at least.
double stretch(const TouchFactors&, double share, int touches);
/// What changes slowly in time: a straight line and a parabola.
Matrix trend(const TouchFactors&);
/// Functions of a time since: a straight line, and one that slows down.
Matrix settling(const Points& since);

}  // namespace abbe::diagnose::patterns
