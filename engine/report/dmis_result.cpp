#include "engine/report/dmis_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/features/shape_traits.hpp"

namespace abbe {

namespace {

/// Five decimals as real result files print them, without a negative zero.
std::string decimal(double value) {
  std::string text = fmt::format("{:.5f}", value);
  return text == "-0.00000" ? text.substr(1) : text;
}

std::string numbers(const Vec3& v) { return decimal(v.x) + ", " + decimal(v.y) + ", " + decimal(v.z); }

/// A quote inside a text is written twice.
std::string dmis_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

double degrees(double rad) { return rad * 180 / kPi; }

std::string line_arguments(const Element& e, const std::string& place) {
  const std::string surface = norm(e.second) > 0 ? ", " + numbers(e.second) : "";
  if (e.begin == e.end) return "UNBND, CART, " + place + surface;
  return "BND, CART, " + numbers(e.point + e.begin * e.direction) + ", " + numbers(e.point + e.end * e.direction) +
      surface;
}

std::string cylinder_arguments(const Element& e) {
  const std::string length = e.end > e.begin ? ", " + decimal(e.end - e.begin) : "";
  // with a length the point is one end of the axis
  const Vec3 end = e.end > e.begin ? e.point + e.begin * e.direction : e.point;
  return numbers(end) + ", " + numbers(e.direction) + ", " + decimal(2 * e.size) + length;
}

std::string rectangle_arguments(const Element& e) {
  return numbers(e.point) + ", " + numbers(e.second) + ", " + decimal(2 * e.size) + ", " +
      numbers(cross(e.direction, e.second)) + ", " + decimal(2 * e.minor_size) + ", " + numbers(e.direction) + ", " +
      decimal(e.end - e.begin);
}

std::string ellipse_arguments(const Element& e) {
  const Vec3 focus = std::sqrt(std::max(0.0, e.size * e.size - e.minor_size * e.minor_size)) * e.second;
  return numbers(e.point - focus) + ", " + numbers(e.point + focus) + ", MAJOR, " + decimal(2 * e.size) + ", " +
      numbers(e.direction);
}

/// The start of the arc is written as its direction, with the start angle 0.
std::string arc_arguments(const Element& e, const std::string& place) {
  return place + ", " + decimal(e.size) + ", " + decimal(0) + ", " + decimal(degrees(e.angle)) + ", " +
      numbers(e.second);
}

std::string feature_arguments(const plan::FeatureDef& def, const Element& e) {
  const std::string in = def.inner ? "INNER, " : "OUTER, ", side = in + "CART, ";
  const std::string place = numbers(e.point) + ", " + numbers(e.direction);
  switch (def.kind->shape) {
    case Shape::point:
    case Shape::plane: return "CART, " + place;
    case Shape::line: return line_arguments(e, place);
    case Shape::circle: return side + place + ", " + decimal(2 * e.size);
    case Shape::arc: return side + arc_arguments(e, place);
    case Shape::cylinder: return side + cylinder_arguments(e);
    case Shape::sphere: return side + numbers(e.point) + ", " + decimal(2 * e.size);
    case Shape::cone:
      return side + numbers(apex(e)) + ", " + numbers(e.direction) + ", " + decimal(degrees(2 * e.angle));
    case Shape::torus: return side + place + ", " + decimal(2 * e.size) + ", " + decimal(2 * e.minor_size);
    case Shape::edge_point: return "CART, " + place + ", " + numbers(e.second);
    case Shape::surface: return "";
    case Shape::slot:
      return in + (e.angle != 0 ? "FLAT" : "ROUND") + ", CART, " + place + ", " + numbers(e.second) + ", " +
          decimal(2 * e.size) + ", " + decimal(2 * e.minor_size);
    case Shape::rectangle: return side + rectangle_arguments(e);
    case Shape::ellipse: return side + ellipse_arguments(e);
    case Shape::parallel_planes: return in + "MIDPL, CART, " + place + ", " + decimal(2 * e.size);
    case Shape::symmetry_plane: return side + place + ", " + decimal(2 * e.size);
  }
  throw InternalError("a Shape without DMIS arguments");
}

bool inside(double value, const ToleranceLimits& limits) {
  return !(limits.lower && value < *limits.lower) && !(limits.upper && value > *limits.upper);
}

std::string tolerance_arguments(const plan::ToleranceDef& def, const OutputRecord::Evaluated& result) {
  const double value = unit_of(*def.kind, def.arguments) == Unit::rad ? degrees(result.value) : result.value;
  const std::string status = inside(result.value, result.limits) ? "INTOL" : "OUTOL";
  const std::string word(def.kind->word);
  const std::string axis = def.arguments.text("axis");
  if (word.starts_with("DIST")) return fmt::format("{}, {}, NOMINL, {}, {}", word, status, decimal(value), axis);
  const std::string qualifier = !axis.empty() ? axis : def.arguments.text("space");
  return fmt::format("{}{}{}, {}, {}", word, qualifier.empty() ? "" : ", ", qualifier, decimal(value), status);
}

/// Nine decimals of the axes: who reads the system back turns positions of a metre by them.
std::string matrix_arguments(const Rigid& X_MD) {
  const Mat3& R = X_MD.R;  // its columns are the axes of D in the machine system
  std::string out;
  for (const double v : {R.cx.x, R.cx.y, R.cx.z, R.cy.x, R.cy.y, R.cy.z, R.cz.x, R.cz.y, R.cz.z})
    out += fmt::format("{:.9f}, ", v == 0 ? 0.0 : v);
  return out + numbers(X_MD.p);
}

class ResultText {
 public:
  ResultText(const plan::Plan& plan, std::span<const CharacteristicReport> reports) : plan_(plan), reports_(reports) {}

  void add(const OutputRecord& record) {
    const plan::Action& action = plan_.operations[record.operation].action;
    if (const auto* frame = std::get_if<plan::OutputFrame>(&action)) {
      const std::string& label = plan_[frame->frame].label;
      text += fmt::format("OUTPUT/DA({0})\nDA({0}) = DATSET/TRMATX, {1}\n", label, matrix_arguments(*record.frame));
      return;
    }
    const auto& what = std::get<plan::Output>(action);
    std::vector<std::string> echo;
    for (const plan::FeatureId f : what.features) echo.push_back(fmt::format("FA({})", plan_[f].label));
    for (const auto& v : record.values)
      echo.push_back(fmt::format("TA({})", plan_[plan_[v.characteristic].tolerance].label));
    echo.insert(echo.end(), what.also.begin(), what.also.end());
    text += fmt::format("OUTPUT/{}\n", fmt::join(echo, ", "));
    for (std::size_t k = 0; k < what.features.size(); ++k) {
      const plan::FeatureDef& def = plan_[what.features[k]];
      const std::string arguments = feature_arguments(def, record.features[k]);
      text +=
          fmt::format("FA({}) = FEAT/{}{}{}\n", def.label, def.kind->word, arguments.empty() ? "" : ", ", arguments);
    }
    for (const auto& v : record.values) {
      const plan::ToleranceDef& def = plan_[plan_[v.characteristic].tolerance];
      text += fmt::format("TA({}) = TOL/{}\n", def.label, tolerance_arguments(def, v));
      add_uncertainty(v.characteristic, def.label);
    }
  }

  std::string text;

 private:
  void add_uncertainty(plan::CharacteristicId id, const std::string& label) {
    const int evaluation = ++written_[id.value];
    for (const CharacteristicReport& r : reports_) {
      if (!r.reference || r.characteristic != id || r.evaluation != evaluation) continue;
      text +=
          fmt::format("$$! u TA({}) {:.3g} lcl {:.3g} ucl {:.3g}", label, r.summary.u, r.lcl.value(), r.ucl.value());
      if (r.conformance_probability) text += fmt::format(" conforms {:.4g}", *r.conformance_probability);
      text += "\n";
      return;
    }
  }

  const plan::Plan& plan_;
  std::span<const CharacteristicReport> reports_;
  std::map<int, int> written_;  ///< by characteristic
};

}  // namespace

std::string dmis_result(const plan::Plan& plan, const std::vector<OutputRecord>& records,
                        std::span<const CharacteristicReport> reports) {
  ResultText result(plan, reports);
  result.text =
      fmt::format("FILNAM/{}\nUNITS/MM, ANGDEC\n", dmis_text(plan.result_name.empty() ? plan.name : plan.result_name));
  for (const OutputRecord& record : records) result.add(record);
  return result.text + "ENDFIL\n";
}

}  // namespace abbe
