#include "lang/statements/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/features/nominal.hpp"
#include "engine/features/shape_traits.hpp"

namespace abbe::lang {

namespace {

/// Nothing where it is known only while the program runs.
std::optional<Vec3> nominal_direction(const plan::FeatureDef& def) {
  if (def.varying.empty()) return def.nominal.direction;
  const bool turns = std::any_of(def.varying.begin(), def.varying.end(), [](const plan::VaryingNumber& v) {
    return v.name == "i" || v.name == "j" || v.name == "k";
  });
  const Outcome<Vec3> written = direction(def.arguments);
  return written && !turns ? std::optional(written.value) : std::nullopt;
}

bool along(const plan::FeatureDef& a, const plan::FeatureDef& b) {
  const std::optional<Vec3> one = nominal_direction(a), other = nominal_direction(b);
  return one && other && norm(cross(*one, *other)) < kOneDegreeSine;
}

/// One label of the tolerance and the word that follows it.
struct Modified {
  plan::FeatureId feature;
  const MatchedValue* word = nullptr;
};

bool widens(const MatchedValue& v) { return v.text == "MMC" || v.text == "LMC"; }

std::optional<plan::MaterialCondition> condition_of(Lowering& lowering, const Modified& m, const MatchedValue& use) {
  const plan::ToleranceId* known = lowering.size_of.find(m.feature.value);
  if (!known) {
    const std::string& label = lowering.out.plan[m.feature].label;
    lowering.warn(Code::W0253, use.span,
                  fmt::format("{} has no size of FA({}) to widen the zone with", m.word->text, label),
                  fmt::format("name its size tolerance before it, for example OUTPUT/FA({}),TA(size)"
                              "; it is judged without bonus",
                              label));
    return std::nullopt;
  }
  return plan::MaterialCondition{m.feature, *known,
                                 m.word->text == "MMC" ? Condition::maximum_material : Condition::least_material};
}

/// Why the frame of the datums does not simply move across the axis of the modified datum; nullptr
/// when it does.
const char* no_simple_shift(const plan::Plan& plan, const std::vector<Modified>& datums, const Modified& datum,
                            plan::FeatureId feature) {
  const plan::FeatureDef &def = plan[datum.feature], &part = plan[feature];
  const Shape shape = def.kind->acts_as;
  if (shape != Shape::cylinder && shape != Shape::circle) return "the datum is not a bore, a shaft or a circle";
  for (const Modified& other : datums) {
    if (&other == &datum) continue;
    const plan::FeatureDef& face = plan[other.feature];
    if (face.kind->acts_as != Shape::plane || !along(face, def))
      return "another datum than a face square to the axis holds the part";
  }
  const Shape own = part.kind->acts_as;
  if ((own != Shape::cylinder && own != Shape::circle && own != Shape::line) || !along(part, def))
    return "the feature has no axis along that of the datum";
  return nullptr;
}

}  // namespace

void remember_size(Lowering& lowering, plan::FeatureId feature, plan::ToleranceId id) {
  const plan::ToleranceDef& def = lowering.out.plan[id];
  const bool length = def.arguments.text("across") == "LONG";  // a slot fits by its width
  if (def.kind->size_factor > 0 && !length) lowering.size_of.set(feature.value, id);
}

std::vector<plan::MaterialCondition> material_conditions(Lowering& lowering, const ToleranceSymbol& symbol,
                                                         plan::FeatureId feature, const MatchedValue& use) {
  std::vector<plan::MaterialCondition> out;
  std::vector<Modified> datums;
  for (const MatchedValue& v : symbol.match.values) {
    if (v.name == "datum") datums.push_back({*lowering.datum(v.label), nullptr});
    if (v.name == "datum_material" && widens(v)) datums.back().word = &v;
    if (v.name != "material" || !widens(v)) continue;
    if (auto made = condition_of(lowering, {feature, &v}, use)) out.push_back(*made);
  }
  for (const Modified& datum : datums) {
    if (!datum.word) continue;
    if (const char* reason = no_simple_shift(lowering.out.plan, datums, datum, feature)) {
      lowering.warn(Code::W0254, use.span, fmt::format("no datum shift is reckoned with: {}", reason),
                    "it is judged with the datum where it was measured, which is the safe side");
    } else if (auto made = condition_of(lowering, datum, use)) {
      out.push_back(*made);
    }
  }
  return out;
}

}  // namespace abbe::lang
