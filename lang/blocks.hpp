// Which statements begin and end a block: MEAS..ENDMES, IF..ELSE..ENDIF and the like. One table for
// everyone who only needs the nesting of a text and not its meaning: the formatter indents by it,
// the interactive session waits for the end of a block by it, the editor folds by it.
#pragma once

#include <span>
#include <string_view>

#include "lang/parser.hpp"

namespace abbe::lang {

struct Block {
  std::string_view begin, middle, end;  ///< words in upper case; middle may be empty
};
/// The blocks of ISO 22093.
std::span<const Block> blocks();

/// How a statement changes the depth of nesting: by `before` for itself, then by `after` for what
/// follows. ELSE: -1, +1.
struct Nesting {
  int before = 0, after = 0;
};
Nesting nesting_of(const RawStatement&);

}  // namespace abbe::lang
