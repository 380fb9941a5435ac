// The lines `# key: value` before a recording: keys that are given twice or misspelt.
#pragma once

#include <vector>

#include "engine/base/csv.hpp"

namespace abbe {

/// Throws UserError (E0532) where two lines of one key that is read say different things; of a stylus they may. Returns a
/// warning (W0533) for each key that is likely to be a slip for one that is read: its line would be lost in silence.
std::vector<Diagnostic> check_remarks(const CsvTable&, const SourceFile&);

}  // namespace abbe
