// CRNOUT, TRNOUT: how far the touched points run out while the part turns about the datum axis (ISO
// 1101:2017, clause 17: circular and total run-out).
//
// The datum axis is the z axis of the frame that the datums establish. The distance that the
// indicator would show is measured from it for circles and cylinders (radial run-out) and along it for
// planes (axial run-out). On cones and spheres the indicator stands on the surface at a right angle: it
// shows how far a touch lies from its nominal place along the normal there. TRNOUT is the range over
// all touches, CRNOUT the largest range over one section (of a plane: of one radius). A section with a single touch has
// no range.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/features/alignment.hpp"
#include "engine/tolerances/common.hpp"
#include "engine/tolerances/sections.hpp"

namespace abbe {
namespace {

const char* turned(Shape written) {
  const Shape s = acts_as(written);
  const bool round = s == Shape::circle || s == Shape::cylinder || s == Shape::sphere || s == Shape::cone;
  return round || s == Shape::plane ? nullptr : "a run-out is for round features and planes";
}
const char* turned_sections(const Arguments& arguments, Shapes s) {
  return arguments.features("datum").size() > 3 ? "a run-out has at most three datums" : turned(s[0]);
}
const char* turned_wholly(const Arguments& arguments, Shapes s) {
  return s[0] == Shape::cone || s[0] == Shape::sphere ? "a total run-out is for cylinders, circles and planes"
                                                      : turned_sections(arguments, s);
}

/// One touch about the axis: what the indicator shows, and in which section.
struct Reading {
  double section, shown;
};

Outcome<std::vector<Reading>> readings(const EvaluationInput& in) {
  using Made = Outcome<std::vector<Reading>>;
  if (in.touches.empty())
    return Made::failed("a run-out is evaluated of the touches: the feature must be measured, not constructed");
  const bool axis = std::any_of(in.datum_shapes.begin(), in.datum_shapes.end(),
                                [](Shape s) { return has_axis(s) || s == Shape::circle; });
  if (!axis) return Made::failed("a run-out needs a datum with an axis");
  const Outcome<Rigid> frame = datum_reference_frame(in.datum_shapes, in.datums);
  if (!frame) return Made::failed(frame.failure);
  const Outcome<Rigid> nominal_frame = datum_reference_frame(in.datum_shapes, in.nominal_datums);
  if (!nominal_frame) return Made::failed(nominal_frame.failure);
  const Rigid own = inverse(frame.value), meant = inverse(nominal_frame.value);
  const bool axial = in.shapes[0] == Shape::plane,
             along_normal = in.shapes[0] == Shape::cone || in.shapes[0] == Shape::sphere;
  Made made;
  for (const TouchedPoint& touch : in.touches) {
    const Vec3 p = own * touch.actual, q = meant * touch.nominal;
    made.value.push_back(axial              ? Reading{std::hypot(q.x, q.y), p.z}
                             : along_normal ? Reading{q.z, dot(p - q, meant.R * touch.normal)}
                                            : Reading{q.z, std::hypot(p.x, p.y)});
  }
  return made;
}

double range(std::span<const Reading> list) {
  const auto [low, high] = std::minmax_element(list.begin(), list.end(),
                                               [](const Reading& a, const Reading& b) { return a.shown < b.shown; });
  return high->shown - low->shown;
}

Outcome<double> total(const Arguments&, const EvaluationInput& in) {
  const auto all = readings(in);
  return all ? Outcome<double>{range(all.value)} : no_value(all.failure);
}

Outcome<double> circular(const Arguments&, const EvaluationInput& in) {
  const auto all = readings(in);
  if (!all) return no_value(all.failure);
  std::vector<double> heights;
  for (const Reading& reading : all.value) heights.push_back(reading.section);
  std::optional<double> largest;
  for (const std::vector<std::size_t>& section : sections(heights)) {
    if (section.size() < 2) continue;
    std::vector<Reading> list;
    for (const std::size_t k : section) list.push_back(all.value[k]);
    largest = std::max(largest.value_or(0), range(list));
  }
  return largest ? Outcome<double>{*largest} : no_value("no section was touched twice: it shows no circular run-out");
}

}  // namespace

extern const ToleranceKind circular_runout_tolerance{
    .word = "CRNOUT",
    .signature = "zone:length," ABBE_DATUM ",{ " ABBE_DATUM " }",
    .help = "circular run-out about the datum axis: largest range of the touches of one section",
    .example = "T(CR)=TOL/CRNOUT,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/CRNOUT; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = turned_sections,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = circular,
    .wants_touches = always,
};

extern const ToleranceKind total_runout_tolerance{
    .word = "TRNOUT",
    .signature = "zone:length," ABBE_DATUM ",{ " ABBE_DATUM " }",
    .help = "total run-out about the datum axis: range of all touches, radial for cylinders, axial for planes",
    .example = "T(TR)=TOL/TRNOUT,0.05,DAT(A)",
    .source = "ISO 22093:2011, TOL/TRNOUT; ISO 1101:2017, clause 17",
    .unit = Unit::mm,
    .features = 1,
    .applies = turned_wholly,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = total,
    .wants_touches = always,
};

}  // namespace abbe
