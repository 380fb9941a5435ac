// Which influences on a measurement the figures of a report contain, and which they do not: the
// declaration that ISO/TS 15530-4:2008 asks of software for task-specific uncertainty. What the
// three states mean is in engine/influences/influence.hpp.
#pragma once

#include <vector>

#include "engine/machine/machine.hpp"
#include "engine/report/run_report.hpp"
#include "engine/run/effect_activity.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe {

struct Declaration {
  std::vector<Influence> influences;  ///< every one, in the order of influence_quantities()
  std::vector<Diagnostic> messages;   ///< bounds on what is modelled (W0434)
};

/// What a run makes of the part that a workpiece file describes.
struct PartInRun {
  bool recorded_points = false;          ///< errors are added to points that were measured on the true part
  bool temperature_compensated = false;  ///< the controller compensates somewhere in the program
};

/// The declaration for a run on a machine and, when there is one, a workpiece file. An influence that
/// is not modelled by itself is when an effect of the machine file that describes it moved a touch
/// in the run, or the workpiece file describes it; else it is bounded when one of the two
/// states a bound.
Declaration declare_influences(const Machine&, const EffectActivities&, const Workpiece* workpiece = nullptr,
                               const PartInRun& = {});

}  // namespace abbe
