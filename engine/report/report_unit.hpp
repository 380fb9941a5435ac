// The unit in which a characteristic is reported: mm as inside the engine, degrees for angles. All
// reports convert here; a DMIS result file (dmis_result.cpp), whose arguments are no reported values,
// converts them itself.
#pragma once

#include "engine/math/units.hpp"
#include "engine/plan/plan.hpp"

namespace abbe {

struct ReportUnit {
  const char* name = "mm";  ///< "mm" or "deg"
  double factor = 1;        ///< reported value = engine value * factor
};

inline ReportUnit report_unit(const plan::Plan& plan, plan::CharacteristicId id) {
  const plan::ToleranceDef& tolerance = plan[plan[id].tolerance];
  return unit_of(*tolerance.kind, tolerance.arguments) == Unit::rad ? ReportUnit{"deg", in_degrees(1)} : ReportUnit{};
}

}  // namespace abbe
