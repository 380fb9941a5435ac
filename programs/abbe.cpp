// The command `abbe`. Exit codes: commands/commands.hpp.
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "programs/commands/commands.hpp"
#include "programs/options.hpp"
#include "programs/terminal.hpp"

int main(int argc, char** argv) {
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of the file size is then an error of the write, and nothing is left half
#endif
  try {
    return abbe::parse_command_line(argc, argv)();
  } catch (const abbe::UserError& error) {
    abbe::print_messages(error.diagnostics());
    return abbe::kUnusable;
  } catch (const std::bad_alloc&) {
    abbe::print_messages({abbe::diagnostic(abbe::Code::E0620, "the memory is not enough for this command",
                                           "ask for fewer virtual machines (--machines), or give it less to read")});
    return abbe::kUnusable;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "abbe: internal fault: %s\nPlease report this with the command and its input files.\n",
                 error.what());
    return abbe::kFault;
  }
}
