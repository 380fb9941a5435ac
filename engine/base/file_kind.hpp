// What a file is by its first lines. Whoever gives a recording to `abbe run` or a program to `abbe diagnose` is told so,
// and not what each line of it is not.
#pragma once

#include <string_view>

#include "engine/base/source.hpp"

namespace abbe {

enum class FileKind {
  unknown,  ///< nothing that is known here
  program,  ///< of measurement, in DMIS
  result,   ///< of a program, in DMIS
  json,     ///< machine and workpiece files
  table,    ///< CSV: recordings, values, points
};
FileKind kind_of(std::string_view text);

/// Throws UserError (E0622) when a file is of another kind than the one that is read here. What is unknown is left to
/// its reader.
void refuse_other_kind(const SourceFile&, FileKind expected);

}  // namespace abbe
