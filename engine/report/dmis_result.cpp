#include "engine/report/dmis_result.hpp"

#include <fmt/format.h>

namespace abbe {

namespace {

/// Five decimals as real result files print them, without a negative zero.
std::string number(double value) {
  std::string text = fmt::format("{:.5f}", value);
  return text == "-0.00000" ? text.substr(1) : text;
}

std::string numbers(const Vec3& v) { return number(v.x) + ", " + number(v.y) + ", " + number(v.z); }

double degrees(double rad) { return rad * 180 / kPi; }

std::string feature_arguments(const plan::FeatureDef& def, const Element& e) {
  const std::string side = def.inner ? "INNER, CART, " : "OUTER, CART, ";
  const std::string place = numbers(e.point) + ", " + numbers(e.direction);
  switch (def.kind->shape) {
    case Shape::point:
    case Shape::plane: return "CART, " + place;
    case Shape::line:
      if (e.begin == e.end) return "UNBND, CART, " + place;
      return "BND, CART, " + numbers(e.point + e.begin * e.direction) + ", " + numbers(e.point + e.end * e.direction);
    case Shape::circle:
    case Shape::cylinder: return side + place + ", " + number(2 * e.size);
    case Shape::sphere: return side + numbers(e.point) + ", " + number(2 * e.size);
    case Shape::cone: return side + place + ", " + number(degrees(2 * e.angle));
    case Shape::torus: return side + place + ", " + number(2 * e.size) + ", " + number(2 * e.minor_size);
  }
  ABBE_CHECK(false);
}

bool inside(double value, const ToleranceLimits& limits) {
  return !(limits.lower && value < *limits.lower) && !(limits.upper && value > *limits.upper);
}

std::string tolerance_arguments(const plan::ToleranceDef& def, const OutputRecord::Evaluated& result) {
  const double value = unit_of(*def.kind, def.arguments) == Unit::rad ? degrees(result.value) : result.value;
  const std::string status = inside(result.value, result.limits) ? "INTOL" : "OUTOL";
  const std::string word(def.kind->word);
  const std::string axis = def.arguments.text("axis");
  if (word.starts_with("DIST")) return fmt::format("{}, {}, NOMINL, {}, {}", word, status, number(value), axis);
  const std::string qualifier = !axis.empty() ? axis : def.arguments.text("space");
  return fmt::format("{}{}{}, {}, {}", word, qualifier.empty() ? "" : ", ", qualifier, number(value), status);
}

}  // namespace

std::string dmis_result(const plan::Plan& plan, const std::vector<OutputRecord>& records) {
  std::string out = fmt::format("FILNAM/'{}'\nUNITS/MM, ANGDEC\n", plan.name);
  for (const OutputRecord& record : records) {
    const auto& what = std::get<plan::Output>(plan.operations[record.operation].action);
    std::string echo = "OUTPUT/";
    for (std::size_t k = 0; k < what.features.size(); ++k) echo += fmt::format("{}FA({})", k ? ", " : "", plan[what.features[k]].label);
    for (const auto& v : record.values) echo += fmt::format(", TA({})", plan[plan[v.characteristic].tolerance].label);
    out += echo + "\n";
    for (std::size_t k = 0; k < what.features.size(); ++k) {
      const plan::FeatureDef& def = plan[what.features[k]];
      out += fmt::format("FA({}) = FEAT/{}, {}\n", def.label, def.kind->word, feature_arguments(def, record.features[k]));
    }
    for (const auto& v : record.values) {
      const plan::ToleranceDef& def = plan[plan[v.characteristic].tolerance];
      out += fmt::format("TA({}) = TOL/{}\n", def.label, tolerance_arguments(def, v));
    }
  }
  return out + "ENDFIL\n";
}

}  // namespace abbe
