// Which influences on a measurement the figures of a report contain, and which they do not: the
// declaration that ISO/TS 15530-4:2008 asks of software for task-specific uncertainty. One table,
// in influences.cpp.
#pragma once

#include <vector>

#include "engine/machine/machine.hpp"
#include "engine/report/run_report.hpp"
#include "engine/workpiece/workpiece.hpp"

namespace abbe {

/// The declaration for a machine and, when there is one, a workpiece file: an influence that is not
/// modelled by itself is when the machine file switches on an effect that describes it, or the
/// workpiece file describes it.
std::vector<Influence> influences(const Machine&, const Workpiece* workpiece = nullptr);

}  // namespace abbe
