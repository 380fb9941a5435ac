// A diagnosis in words and as JSON (schema "abbe.diagnosis/1", docs/formats.md).
#pragma once

#include <string>

#include "engine/diagnose/diagnosis.hpp"

namespace abbe {

std::string diagnosis_json(const Diagnosis&);
/// Three sentences, one table, what to do next: for people who measure, not for statisticians.
std::string diagnosis_text(const Diagnosis&);
/// The text of the machine file with what the diagnosis found in it: `effects` appended, `known_state` replaced.
std::string improved_machine(const std::string& machine_json, const Diagnosis&);

}  // namespace abbe
