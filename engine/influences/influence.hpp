// The quantities that influence a coordinate measurement, by the names under which reports declare
// them (ISO/TS 15530-4:2008 asks software for task-specific uncertainty to say which of them its
// figures contain), and bounds on those that are not propagated.
//
// An influence is in one of three states:
//   modelled      it acts on the virtual machines of the run: it is in u and limits
//   bounded       it is in no figure, but someone who can know has stated its greatest error
//   not modelled  it is in no figure, and nothing is known of it
//
// A bound is stated in the machine file or in the workpiece file, always with its source:
//   "bounds": [{"influence": "thermal drift", "at_most_um": 0.3, "source": "drift test of 3 May"}]
// It bounds |r|, the error of one touch along the normal of the surface; a distance between two
// touches may err by twice as much. The program derives no bound from a specification: an MPE holds
// for the stylus, the sphere and the lengths of its test, and only the user knows whether the task
// is within these.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/json_reader.hpp"

namespace abbe {

struct InfluenceQuantity {
  std::string_view name;
  bool always_modelled = false;  ///< part of every simulation
};

/// All of them, in the order of reports.
std::span<const InfluenceQuantity> influence_quantities();

struct InfluenceBound {
  std::string influence;  ///< one of the names
  double at_most_mm = 0;  ///< of |r|
  std::string source;     ///< certificate, data sheet, test: whatever the user trusts
};

/// The list "bounds" of a machine or workpiece file; empty when there is none. Reports an unknown
/// influence (E0432), and one that is always modelled or stands there twice (E0433).
std::vector<InfluenceBound> read_bounds(JsonObject& root);

}  // namespace abbe
