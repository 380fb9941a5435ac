// The words and figures of what a diagnosis of values has found.
#pragma once

#include "engine/diagnose/values/value_estimate.hpp"

namespace abbe::diagnose {

/// Of the variant of a finding, with 95 % intervals.
std::vector<DiagnosedParameter> parameters_of(const ValueCase&, const Closer&, const Finding&);

/// A set of names. `adequacy`: how often a machine with the first leaves as much as the recording does.
void tell_name(const ValueCase&, const Closer&, const Finding&, double adequacy, Diagnosis&);

/// One characteristic of one artefact, measured in several places, that strays alike in all of them.
struct StraysAlike {
  std::string label;     ///< of its tolerance
  double reference = 0;  ///< mm or degrees
  bool angle = false;
  std::size_t places = 0;
  Vector column;                ///< 1 where a value is of it
  double size = 0, energy = 0;  ///< um or urad; its square over its variance
};

void tell_strays_alike(const ValueCase&, const StraysAlike&, Diagnosis&);

/// What stands for no name.
void tell_pattern(const ValueCase&, const Closer&, const Finding&, Diagnosis&);

}  // namespace abbe::diagnose
