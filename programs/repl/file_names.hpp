// Names of files for the completion of `.load` and `.save`.
#pragma once

#include <string>
#include <vector>

namespace abbe {

/// The names, without their folder, that may go on where a path `typed` so far ends: those in its folder that
/// begin as its last part does, sorted, folders with a `/` at the end. Hidden ones only behind a dot. Empty
/// where nothing can be read.
std::vector<std::string> file_names(const std::string& typed);

}  // namespace abbe
