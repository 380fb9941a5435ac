// Small plans written by hand, for tests of the executor without the language.
#pragma once

#include "engine/machine/machine.hpp"
#include "engine/plan/plan.hpp"
#include "engine/run/run.hpp"

namespace abbe::test {

inline plan::Point constant(const Vec3& v) {
  return {plan::Operand{v.x, {}}, plan::Operand{v.y, {}}, plan::Operand{v.z, {}}};
}

/// Of a plan that no text was compiled to.
inline const SourceFile& no_source() {
  static const SourceFile source("test", "");
  return source;
}

/// Of a sample: over n - 1.
inline double variance(const std::vector<double>& x) {
  double mean = 0, sum = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  for (const double v : x) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(x.size() - 1);
}

struct PlanBuilder {
  plan::Plan plan;

  int append(plan::Action action) {
    plan.operations.push_back({std::move(action), {}, static_cast<int>(plan.operations.size()) + 1});
    return static_cast<int>(plan.operations.size()) - 1;
  }
  /// A straight stylus on the head, `length` below the mount at A = 0.
  plan::SensorId sensor(double a_deg, double b_deg, double length, double radius = 2) {
    plan::SensorDef def;
    def.label = "P" + std::to_string(plan.sensors.size());
    def.indexed = true;
    def.head_a_rad = a_deg * kPi / 180;
    def.head_b_rad = b_deg * kPi / 180;
    def.tip_in_r = {0, 0, -length};
    def.radius_mm = radius;
    plan.sensors.push_back(def);
    return {static_cast<int>(plan.sensors.size()) - 1};
  }
  plan::FeatureId feature(Shape shape, const Element& nominal) {
    plan.features.push_back({"F" + std::to_string(plan.features.size()), &feature_kind(shape), nominal, false, {}});
    const plan::FeatureId id{static_cast<int>(plan.features.size()) - 1};
    append(plan::DefineFeature{id});
    return id;
  }
  plan::FeatureId point(const Vec3& p, const Vec3& n) {
    Element nominal;
    nominal.point = p;
    nominal.direction = n;
    const plan::FeatureId id = feature(Shape::point, nominal);
    append(plan::BeginMeasure{id});
    append(plan::Touch{id, constant(p), constant(n), true});
    append(plan::EndMeasure{id});
    return id;
  }
  plan::CharacteristicId evaluate(std::vector<plan::FeatureId> features, std::string_view word, Arguments arguments) {
    plan.tolerances.push_back(
        {"T" + std::to_string(plan.tolerances.size()), find_tolerance_kind(word), std::move(arguments), {}});
    plan.characteristics.push_back({std::move(features), {static_cast<int>(plan.tolerances.size()) - 1}, 0, {}});
    const plan::CharacteristicId id{static_cast<int>(plan.characteristics.size()) - 1};
    append(plan::Evaluate{id});
    return id;
  }
  plan::ColumnId column() { return {plan.columns++}; }
};

}  // namespace abbe::test
