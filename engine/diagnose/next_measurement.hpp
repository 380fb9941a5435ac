// Which measurement would decide: every change of the menu is applied to a part of the touches, appended to the recording, and the
// expected evidence against each rival is computed from the longer recording's model, as if the likeliest explanations were true in turn.
// The changes are ranked by the probability that they would give to the truth, per minute of machine time
// (posterior-weighted, symmetric discrimination: Atkinson & Fedorov 1975).
#pragma once

#include <functional>
#include <string>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// One change to how touches are made.
struct Change {
  std::string text;                 ///< "repeat with probing speed 3 mm/s"
  std::string instruction;          ///< for the operator, or empty when the program does it all
  std::string statement;            ///< DMIS that sets it: "FEDRAT/MESVEL,MMPS,3"
  unsigned makes_known = 0;         ///< covariates that vary once it is made
  double minutes = 0;               ///< beyond the touches themselves
  std::function<void(RecordedTouch&)> apply;
};

/// The changes that make sense for a recording on a machine.
std::vector<Change> changes_for(const Case&);

/// The touches of a change as a DMIS program.
std::string dmis_program(const Case&, const Change&, const std::vector<RecordedTouch>&);

}  // namespace abbe::diagnose
