// A diagnosis of values: what one machine reported of the characteristics of programs, without its touches.
//
// The programs run on the same screened virtual machines, so the covariance between all values, of one
// program or of several, is that of the simulation; repeats (`run`) share the machine and the part and have
// other noise. The uncertainty U of each reference (k = 2) adds. One half of the machines gives mean and
// covariance; the other half is judged by them as the recording is, so the p-value is that of the ensemble
// itself, whatever its shape (a permutation argument: under the null the recording is one more machine of the
// second half). The statistic is the average Bayes factor of all explanations (value_search.hpp).
// A mismatch is what neither machines of the specification nor rougher ones (rough_geometry.hpp) report, each judged
// by themselves: of both kinds no more than the nominal share is told so (Berger 1982, intersection-union tests).
//
// The signature of an effect on the values is what the programs report on an error-free machine with the
// effect at its typical size, one run for each linear parameter and choice. So an effect acts on alignments
// as it does in reality. It is exact where a value is linear in the errors (sizes, distances, positions,
// angles) and a rough guide for form. Effects that depend on clock, scale readings or indexing cannot be
// judged from values.
#pragma once

#include "engine/diagnose/diagnosis.hpp"
#include "engine/plan/plan.hpp"
#include "engine/recording/value_recording.hpp"

namespace abbe {

/// A program whose values were recorded; `name` is what the rows call it.
struct ValueProgram {
  std::string name;
  const plan::Plan* plan = nullptr;
  const SourceFile* source = nullptr;
  Vec3 placement_mm;
};

/// Throws UserError: a characteristic that its program does not evaluate, or that is not the only one of that
/// name; the same value twice.
Diagnosis diagnose_values(const ValueRecording&, const std::vector<ValueProgram>&, const Machine&,
                          const DiagnoseOptions&);

}  // namespace abbe
