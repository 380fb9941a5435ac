// The one style in which programs are written out (`abbe format`).
//
//   - words of the language in capitals; names, numbers, texts, comments and expressions as they were written
//   - no blanks around `/ , =` and the parentheses of labels; one blank before a comment behind a statement
//   - two blanks of indentation for every block that is open
//   - a statement in one line of at most 80 columns, the line length of the older editions of the
//     standard, which some controllers insist on; a longer one is cut behind a comma with `$` and
//     goes on four blanks deeper
//
// What cannot be read as a statement stays as it is, byte for byte: the formatter repairs nothing.
// Empty lines, line ends and byte order mark stay too. A formatted program has the same meaning,
// and formatting it again changes nothing; tests hold both over all programs at hand.
#pragma once

#include <string>

#include "engine/base/source.hpp"

namespace abbe::lang {

inline constexpr std::size_t kFormattedColumns = 80;

std::string format(const SourceFile&);

}  // namespace abbe::lang
