#include "programs/commands/usable_program.hpp"

#include <fmt/format.h>

namespace abbe {

CompiledProgram usable_program(const std::string& path, const std::map<std::string, std::string>& answers) {
  CompiledProgram program = compile_program(path, {answers});
  if (!program.has_errors) return program;
  program.messages.push_back(diagnostic(Code::E0604,
                                        fmt::format("'{}' has errors and was not run", program.source.name()),
                                        "correct the program; `abbe check` lists what is wrong"));
  throw UserError(std::move(program.messages));
}

}  // namespace abbe
