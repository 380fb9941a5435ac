// FLAT, STRGHT, CIRLTY, CYLCTY: the spread high - low of the residuals about the fitted element: the
// least-squares one (reference element LS of ISO 12781, 12780, 12181 and 12180) unless GEOALG chose
// another; then the minimum zone, or the spread about the inscribed or circumscribed element. Of a
// line see form.hpp. The circularity of a cylinder is that of its sections, the largest of them: in each the touches
// about the least-squares circle of the section, as seen along the fitted axis.
#include "engine/tolerances/form.hpp"

#include <algorithm>
#include <cmath>

#include "engine/tolerances/common.hpp"
#include "engine/tolerances/sections.hpp"

namespace abbe {
namespace {

const char* plane_only(const Arguments&, Shapes s) {
  if (acts_as(s[0]) != Shape::plane) return "flatness is for planes";
  return s[0] == Shape::plane ? nullptr : "flatness is of one face: measure each of the two as a PLANE";
}
const char* line_only(const Arguments&, Shapes s) {
  return s[0] == Shape::line ? nullptr : "straightness is for lines";
}
const char* round_only(const Arguments&, Shapes s) {
  return acts_as(s[0]) == Shape::circle || s[0] == Shape::sphere || s[0] == Shape::cylinder
      ? nullptr
      : "circularity is for circles, cylinders and spheres";
}
const char* cylinder_only(const Arguments&, Shapes s) {
  return s[0] == Shape::cylinder ? nullptr : "cylindricity is for cylinders";
}

Outcome<double> spread(const Arguments&, const EvaluationInput& in) { return {in.actual[0].high - in.actual[0].low}; }

struct InSection {
  double x, y;
};

/// Of the distances from a centre the constant, and the shift of the centre that makes them most alike.
Vec3 radius_and_shift(const std::vector<InSection>& points, const InSection& centre) {
  Mat3 normal{{}, {}, {}};
  Vec3 right;
  for (const InSection& p : points) {
    const double x = p.x - centre.x, y = p.y - centre.y, distance = std::hypot(x, y);
    const Vec3 row{1, x / distance, y / distance};
    normal.cx += row, normal.cy += row.y * row, normal.cz += row.z * row;
    right += distance * row;
  }
  const double determinant = dot(normal.cx, cross(normal.cy, normal.cz));
  return 1 / determinant *
      Vec3{dot(right, cross(normal.cy, normal.cz)), dot(normal.cx, cross(right, normal.cz)),
           dot(normal.cx, cross(normal.cy, right))};
}

/// How far apart the points lie about their least-squares circle, which is next to the origin (Gauss-Newton).
double range_about_circle(const std::vector<InSection>& points) {
  constexpr int kRounds = 20;
  constexpr double kSettled_mm = 1e-10;
  InSection centre{0, 0};
  double shift = 1;
  for (int round = 0; round < kRounds && shift > kSettled_mm; ++round) {
    const Vec3 fit = radius_and_shift(points, centre);
    centre.x += fit.y, centre.y += fit.z;
    shift = std::hypot(fit.y, fit.z);
  }
  std::vector<double> distances;
  for (const InSection& p : points) distances.push_back(std::hypot(p.x - centre.x, p.y - centre.y));
  const auto [low, high] = std::minmax_element(distances.begin(), distances.end());
  return *high - *low;
}

/// Whether a section has a circle, at three places, and touches besides.
bool shows_form(const std::vector<std::size_t>& section, std::span<const TouchedPoint> touches) {
  constexpr std::size_t kSettleCircle = 3;
  constexpr double kSamePlace_mm = 0.1;
  std::vector<Vec3> places;
  for (const std::size_t k : section)
    if (std::none_of(places.begin(), places.end(),
                     [&](const Vec3& p) { return norm(p - touches[k].nominal) < kSamePlace_mm; }))
      places.push_back(touches[k].nominal);
  return section.size() > kSettleCircle && places.size() >= kSettleCircle;
}

/// The largest circularity of the sections of a cylinder.
Outcome<double> circularity_of_sections(const EvaluationInput& in) {
  const Element& axis = in.actual[0];
  std::vector<double> heights;
  for (const TouchedPoint& touch : in.touches)
    heights.push_back(dot(in.nominal[0].direction, touch.nominal - in.nominal[0].point));
  const Vec3 e1 = any_perpendicular(axis.direction), e2 = cross(axis.direction, e1);
  std::optional<double> largest;
  for (const std::vector<std::size_t>& section : sections(heights)) {
    if (!shows_form(section, in.touches)) continue;
    std::vector<InSection> points;
    for (const std::size_t k : section) {
      const Vec3 arm = in.touches[k].actual - axis.point;
      points.push_back({dot(arm, e1), dot(arm, e2)});
    }
    largest = std::max(largest.value_or(0), range_about_circle(points));
  }
  return largest
      ? Outcome<double>{*largest}
      : no_value("no section of the cylinder was touched four times, at three places or more: it shows no circularity");
}

Outcome<double> circularity(const Arguments& arguments, const EvaluationInput& in) {
  return in.shapes[0] == Shape::cylinder ? circularity_of_sections(in) : spread(arguments, in);
}

Outcome<double> straightness_value(const Arguments&, const EvaluationInput& in) { return {straightness(in)}; }

/// Vectors of touches that differ little count as one: they are taken from a surface that is nearly flat.
bool have_one_normal(std::span<const TouchedPoint> touches) {
  return !touches.empty() && std::all_of(touches.begin(), touches.end(), [&](const TouchedPoint& touch) {
    return norm(touch.normal - touches[0].normal) < kOneDegreeSine;
  });
}

std::vector<Vec3> actual_points(std::span<const TouchedPoint> touches) {
  std::vector<Vec3> points;
  for (const TouchedPoint& touch : touches) points.push_back(touch.actual);
  return points;
}

}  // namespace

bool are_of_one_face(std::span<const TouchedPoint> touches) {
  return !touches.empty() && std::all_of(touches.begin(), touches.end(), [&](const TouchedPoint& touch) {
    return dot(touch.normal, touches[0].normal) > 0;
  });
}

double range_along(const Vec3& w, std::span<const Vec3> points) {
  double low = dot(w, points[0]), high = low;
  for (const Vec3& p : points) low = std::min(low, dot(w, p)), high = std::max(high, dot(w, p));
  return high - low;
}

double range_along(const Vec3& w, std::span<const TouchedPoint> touches) {
  return range_along(w, actual_points(touches));
}

std::vector<Vec3> points_of_plane(const EvaluationInput& in) {
  if (in.faces.empty()) return actual_points(in.touches);
  const Element& plane = in.actual[0];
  std::vector<Vec3> feet;
  for (const Vec3& p : in.faces) feet.push_back(p - dot(p - plane.point, plane.direction) * plane.direction);
  return feet;
}

std::optional<Vec3> section_normal(std::span<const TouchedPoint> touches, const Vec3& v) {
  if (!have_one_normal(touches)) return std::nullopt;
  const Vec3 across = perpendicular_part(touches[0].normal, v);
  if (norm(across) < kOneDegreeSine) return std::nullopt;
  return unit(across);
}

double straightness(const EvaluationInput& in) {
  const Element& line = in.actual[0];
  const std::optional<Vec3> across = section_normal(in.touches, line.direction);
  return across ? range_along(*across, in.touches) : line.high - line.low;
}

extern const ToleranceKind flatness_tolerance{
    .word = "FLAT",
    .signature = "zone:length,[ unit_zone:length,unit_a:length,unit_b:length ]",
    .help = "flatness: spread of the touches about the fitted plane; a second zone per unit of area is not evaluated",
    .example = "T(F1)=TOL/FLAT,0.05",
    .source = "ISO 1101:2017, clause 17; ISO 12781-1 (LSPL)",
    .unit = Unit::mm,
    .features = 1,
    .applies = plane_only,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = spread,
};

extern const ToleranceKind straightness_tolerance{
    .word = "STRGHT",
    .signature = "zone:length," ABBE_MATERIAL,
    .help =
        "straightness: width of the zone about the fitted line that holds the touches: in the section "
        "of a surface two parallel lines, of an axis a cylinder",
    .example = "T(S1)=TOL/STRGHT,0.02",
    .source = "ISO 1101:2017, clause 17; ISO 12780-1 (LSLI)",
    .unit = Unit::mm,
    .features = 1,
    .applies = line_only,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = straightness_value,
    .wants_touches = always,
};

extern const ToleranceKind circularity_tolerance{
    .word = "CIRLTY",
    .signature = "zone:length",
    .help =
        "circularity: spread of the touches about the fitted circle or sphere; of a cylinder about the circles of its "
        "sections, the largest",
    .example = "T(C1)=TOL/CIRLTY,0.01",
    .source = "ISO 1101:2017, clause 17; ISO 12181-1 (LSCI)",
    .unit = Unit::mm,
    .features = 1,
    .applies = round_only,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = circularity,
    .wants_touches = always,
};

extern const ToleranceKind cylindricity_tolerance{
    .word = "CYLCTY",
    .signature = "zone:length",
    .help = "cylindricity: spread of the touches about the fitted cylinder",
    .example = "T(Y1)=TOL/CYLCTY,0.1",
    .source = "ISO 1101:2017, clause 17; ISO 12180-1 (LSCY)",
    .unit = Unit::mm,
    .features = 1,
    .applies = cylinder_only,
    .nominal = no_deviation,
    .limits = zone_limits,
    .evaluate = spread,
};

}  // namespace abbe
