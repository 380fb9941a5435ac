// How long the features of a plan live, so that an executor holds what is alive and not all that a program
// ever measures.
//
// A lane runs operations in ascending order, except for jumps back. So a feature lives from the first
// operation that names it to the last; where one of them stands in a loop, to the ends of that loop, as the
// next round may still want what this one left. Features that are never alive together share a *slot*.
// Operations are in order already, so one pass over the lives suffices: the linear scan of Poletto and
// Sarkar, "Linear Scan Register Allocation", ACM TOPLAS 21 (1999), with as many registers as it takes.
#pragma once

#include <vector>

#include "engine/plan/plan.hpp"

namespace abbe::plan {

/// Operations `first`..`last` that a lane may run more than once: from the target of a jump back to the jump.
struct Loop {
  int first = 0, last = 0;
};
/// The loops of a plan in program order. Loops that overlap or stand inside each other count as one.
std::vector<Loop> loops(const Plan&);

/// The features whose state an operation reads or writes on a lane. A feature may occur twice.
std::vector<FeatureId> features_of(const Plan&, const Action&);

struct FeatureSlots {
  std::vector<int> slot;  ///< by FeatureId; -1 for features that no operation names
  int count = 0;          ///< the most features that are alive at one operation
};
FeatureSlots feature_slots(const Plan&);

/// Counters of how often a lane ran an operation are needed only for touches and evaluations in loops; any
/// other runs once.
struct VisitCounters {
  std::vector<int> counter;  ///< by operation; -1 where none is needed
  int count = 0;
};
VisitCounters visit_counters(const Plan&);

}  // namespace abbe::plan
