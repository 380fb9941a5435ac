// Programs of which every result is needed.
#pragma once

#include <map>
#include <string>

#include "programs/program_study.hpp"

namespace abbe {

/// Compiles a program. Throws UserError, with its messages and E0604, when it has errors.
CompiledProgram usable_program(const std::string& path, const std::map<std::string, std::string>& answers = {});

}  // namespace abbe
