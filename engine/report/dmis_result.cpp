#include "engine/report/dmis_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "engine/math/units.hpp"

namespace abbe {

namespace {

/// As real result files print them, without a negative zero.
std::string five_decimals(double value) {
  std::string text = fmt::format("{:.5f}", value);
  return text == "-0.00000" ? text.substr(1) : text;
}

std::string numbers(const Vec3& v) {
  return five_decimals(v.x) + ", " + five_decimals(v.y) + ", " + five_decimals(v.z);
}

/// A quote inside a text is written twice.
std::string dmis_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

struct ArgumentText {
  std::string operator()(std::string_view word) const { return std::string(word); }
  std::string operator()(double number) const { return five_decimals(number); }
  std::string operator()(const Vec3& v) const { return numbers(v); }
};

/// In the form of FEAT: where the touches of a line without ends began and ended is chance.
std::string feature_arguments(const plan::FeatureDef& def, Element e) {
  std::string out;
  if (def.kind->shape == Shape::line && def.varying.empty() && def.nominal.begin == def.nominal.end)
    e.begin = e.end = 0;
  if (def.kind->signature.starts_with("side:")) out = def.inner ? ", INNER" : ", OUTER";
  for (const auto& argument : def.kind->written(e)) out += ", " + std::visit(ArgumentText{}, argument);
  return out;
}

bool inside(double value, const ToleranceLimits& limits) {
  return !(limits.lower && value < *limits.lower) && !(limits.upper && value > *limits.upper);
}

std::string tolerance_arguments(const plan::ToleranceDef& def, const OutputRecord::Evaluated& result) {
  const double value = unit_of(*def.kind, def.arguments) == Unit::rad ? in_degrees(result.value) : result.value;
  const std::string status = inside(result.value, result.limits) ? "INTOL" : "OUTOL";
  const std::string word(def.kind->word);
  const std::string axis = def.arguments.text("axis");
  if (word.starts_with("DIST")) return fmt::format("{}, {}, NOMINL, {}, {}", word, status, five_decimals(value), axis);
  const std::string qualifier = !axis.empty() ? axis : def.arguments.text("space");
  return fmt::format("{}{}{}, {}, {}", word, qualifier.empty() ? "" : ", ", qualifier, five_decimals(value), status);
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
      text +=
          fmt::format("FA({}) = FEAT/{}{}\n", def.label, def.kind->word, feature_arguments(def, record.features[k]));
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
      if (!r.reference || !r.varies || r.characteristic != id || r.evaluation != evaluation) continue;
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
