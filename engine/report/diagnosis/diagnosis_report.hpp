// A diagnosis in words, as JSON (schema "abbe.diagnosis/1", docs/results.md) and as a page: one HTML file
// with its figures in it.
#pragma once

#include <string>
#include <vector>

#include "engine/diagnose/diagnosis.hpp"

namespace abbe {

/// `machine`: its name.
std::string diagnosis_json(const Diagnosis&, const std::string& machine);
/// Three sentences, one table, what to do next: for people who measure, not for statisticians.
std::string diagnosis_text(const Diagnosis&);
/// Whether they agree, what it is, whether that is better.
std::vector<std::string> diagnosis_sentences(const Diagnosis&);
/// What to do beside another measurement.
std::vector<std::string> further_steps(const Diagnosis&);
/// What cannot be judged and is not told as one of the explanations anyway; in one, where that is every effect.
std::vector<CannotJudge> open_questions(const Diagnosis&);
/// What the machine does beside what was found, its noise, and the touches left out, in one line; "" of values.
std::string baseline_in_words(const Diagnosis&);
/// The characteristic, and which of its evaluations in one run of the program.
std::string label(const JudgedValue&);
/// `recording` and `machine`: what was compared, for the heading.
std::string diagnosis_html(const Diagnosis&, const std::string& recording, const std::string& machine);
/// The text of the machine file with what the diagnosis found in it: `effects` appended, or in the place of
/// those they stand for, and `known_state` replaced.
std::string improved_machine(const std::string& machine_json, const Diagnosis&);

}  // namespace abbe
