// The command line: the only place that knows its syntax, and the only user of CLI11.
#pragma once

#include <functional>

namespace abbe {

/// What the command line asks for, ready to be done: call it, and it returns the exit code. For
/// --help and --version that prints them. Throws UserError (E0609) that names what was wrong and
/// the nearest option or command when there is one.
std::function<int()> parse_command_line(int argc, const char* const* argv);

}  // namespace abbe
