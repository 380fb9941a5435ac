// The recording laid out for judgement: its touches, what the part is, and what a machine in order may do to them.
#pragma once

#include <optional>
#include <string>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// `surfaces`: what they count as; without, they are what the targets say unless half of them is not. Messages, and
/// lengths beyond the specification, go to the diagnosis.
Case on_the_bench(const Recording&, const Machine&, const DiagnoseOptions&, std::optional<Surfaces> surfaces,
                  const std::string& file, Diagnosis&);
/// Positions are multiples of a step. Rounding is noise too: without it, what is rounded coarsely would lie on its steps
/// without any.
void judge_rounding(double step_um, Case&);

}  // namespace abbe::diagnose
