// A plan with a length and an angle, and runs of it with given values: enough for the reports,
// without any machine.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/report/run_report.hpp"

namespace abbe::test {

inline ToleranceKind kind_of(std::string_view word, Unit unit) {
  ToleranceKind kind{};
  kind.word = word;
  kind.unit = unit;
  return kind;
}

inline const ToleranceKind kDistance = kind_of("DISTB", Unit::mm);
inline const ToleranceKind kAngle = kind_of("ANGLB", Unit::rad);

/// Characteristic 0: LEN between A and B, line 41. Characteristic 1: ANG of A, line 42.
inline plan::Plan length_and_angle() {
  plan::Plan plan;
  plan.features.resize(2);
  plan.features[0].label = "A";
  plan.features[1].label = "B";
  plan.tolerances.resize(2);
  plan.tolerances[0].label = "LEN";
  plan.tolerances[0].kind = &kDistance;
  plan.tolerances[1].label = "ANG";
  plan.tolerances[1].kind = &kAngle;
  plan.characteristics = {{{plan::FeatureId{0}, plan::FeatureId{1}}, plan::ToleranceId{0}, 41, {}},
                          {{plan::FeatureId{0}}, plan::ToleranceId{1}, 42, {}}};
  return plan;
}

inline Samples samples(int characteristic, double reference, ToleranceLimits limits, std::vector<double> values) {
  Samples s{plan::CharacteristicId{characteristic}, 1, reference, reference, limits, std::move(values), {}, {}};
  for (std::uint32_t i = 0; i < s.value.size(); ++i) s.machine.push_back(i);
  return s;
}

inline RunResult run_of(std::vector<Samples> list, int machines) {
  RunResult result;
  result.samples = std::move(list);
  result.machines = machines;
  return result;
}

}  // namespace abbe::test
