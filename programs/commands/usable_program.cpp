#include "programs/commands/usable_program.hpp"

#include <fmt/format.h>

#include "programs/terminal.hpp"

namespace abbe {

CompiledProgram usable_program(const std::string& path, const std::map<std::string, std::string>& answers) {
  CompiledProgram program = compile_program(path, {answers});
  print_messages(program.messages);
  if (program.has_errors)
    throw UserError(diagnostic(Code::E0604, fmt::format("'{}' has errors and was not run", program.source.name()),
                               "correct the program; `abbe check` lists what is wrong"));
  return program;
}

}  // namespace abbe
