#include "engine/influences/influence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/math/units.hpp"

namespace abbe {

namespace {

constexpr InfluenceQuantity kQuantities[] = {
    {"geometry", true},
    {"head indexing", true},
    {"probe repeatability", true},
    {"number and place of the points", true},
    {"part temperature"},
    {"scale temperature"},
    {"temperature gradients in the machine"},
    {"thermal drift"},
    {"probe pretravel lobing"},
    {"stylus bending and length"},
    {"tip size and form"},
    {"contact deformation"},
    {"trigger delay"},
    {"head geometry and qualification"},
    {"dynamics and backlash"},
    {"scale interpolation"},
    {"vibration and outliers"},
    {"true size of the part"},
    {"form error of the part"},
    {"fixturing"},
    {"surface roughness and dirt"},
    {"operator"},
    {"software"},
};

const InfluenceQuantity* find_quantity(std::string_view name) {
  const auto* found = std::find_if(std::begin(kQuantities), std::end(kQuantities),
                                   [&](const InfluenceQuantity& q) { return q.name == name; });
  return found == std::end(kQuantities) ? nullptr : found;
}

void refuse_unknown(JsonObject& object, const std::string& name) {
  std::vector<std::string_view> names;
  for (const InfluenceQuantity& q : kQuantities)
    if (!q.always_modelled) names.push_back(q.name);
  const std::string near = nearest_word(name, names);
  object.fault("influence", Code::E0432, fmt::format("there is no influence \"{}\"", name),
               near.empty() ? fmt::format("it is one of: {}", fmt::join(names, ", "))
                            : fmt::format("did you mean \"{}\"?", near));
}

}  // namespace

std::span<const InfluenceQuantity> influence_quantities() { return kQuantities; }

std::vector<InfluenceBound> read_bounds(JsonObject& root) {
  std::vector<InfluenceBound> bounds;
  for (JsonObject& object : root.object_list("bounds")) {
    InfluenceBound bound;
    bound.influence = object.text("influence");
    bound.at_most_mm = kUm * object.number("at_most_um", kPositive);
    bound.source = object.text("source");
    const InfluenceQuantity* quantity = find_quantity(bound.influence);
    const bool twice = std::any_of(bounds.begin(), bounds.end(),
                                   [&](const InfluenceBound& other) { return other.influence == bound.influence; });
    if (!quantity) {
      if (object.has("influence")) refuse_unknown(object, bound.influence);
    } else if (quantity->always_modelled) {
      object.fault("influence", Code::E0433,
                   fmt::format("\"{}\" is part of every simulation: a bound adds nothing", bound.influence),
                   "remove it; what the machine file says of it is propagated");
    } else if (twice) {
      object.fault("influence", Code::E0433, fmt::format("\"{}\" has a bound already", bound.influence),
                   "remove one of the two; of two bounds that both hold, keep the smaller");
    }
    bounds.push_back(std::move(bound));
  }
  return bounds;
}

}  // namespace abbe
