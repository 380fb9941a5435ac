// abbe format PATH...: programs in the one style of lang/format.hpp, on stdout; or checked, or
// written back.
#include <fmt/format.h>

#include "engine/base/file_kind.hpp"
#include "engine/base/files.hpp"
#include "lang/format.hpp"
#include "programs/commands/commands.hpp"
#include "programs/program_files.hpp"
#include "programs/terminal.hpp"

namespace abbe {

int format_command(const FormatOptions& options) {
  int differ = 0;
  for (const std::string& path : some_program_files(options.paths)) {
    const SourceFile source = read_source(path);
    refuse_other_kind(source, FileKind::program);
    const std::string text = lang::format(source);
    const bool changes = text != source.text();
    differ += changes ? 1 : 0;
    if (options.check) {
      if (changes) print_result(fmt::format("{}: not formatted; `abbe format --write` does it\n", path));
    } else if (options.write) {
      if (changes) write_whole(path, text);
    } else {
      print_result(text);
    }
  }
  return options.check && differ > 0 ? kNo : kDone;
}

}  // namespace abbe
