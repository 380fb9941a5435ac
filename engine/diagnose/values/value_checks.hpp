// What is wrong with a file of values as such.
#pragma once

#include <string>
#include <vector>

#include "engine/diagnose/values/value_case.hpp"

namespace abbe::diagnose {

/// Calibrations that say less of most values than any machine of the specification would.
void doubt_calibrations(const ValueCase&, std::vector<Diagnostic>& messages);

/// References of one label and artefact that lie further apart than their calibration allows, and less than
/// one length does from another (W0739): a slip, or values and references exchanged.
void doubt_references(const ValueCase&, std::vector<Diagnostic>& messages);

/// Throws UserError (E0713): runs of which nine tenths of the smaller stand in another one, value for value to the last digit,
/// where so many would not repeat by themselves: a value of a machine that repeats far better than the simulated ones does
/// with the chance of its step over their scatter.
void refuse_copied_values(const ValueCase&);

/// What to say of values that lie a hundred times further off than any virtual machine, and of which a thousandth is what these
/// measure: they may be in micrometres. A part may have such a form, so they are not refused. Empty: there are none.
std::string doubt_of_micrometres(const ValueCase&);

/// A value that lies far from its repeats in other runs, which agree; by so much, um or urad.
struct FarRepeat {
  std::size_t value;
  double beside;
};
std::vector<FarRepeat> far_from_repeats(const ValueCase&);

/// What to say of such values: a slip of one run. Empty: there are none.
std::string doubt_of_single_repeats(const ValueCase&);

/// Whether every value is, to its last digit, what it should be. Machines of the specification would not report that: the
/// chance is the digit times the density of the values.
bool holds_references_only(const ValueCase&);

}  // namespace abbe::diagnose
