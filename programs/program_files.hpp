// Programs on the command line: files, and folders that hold them.
#pragma once

#include <string>
#include <vector>

namespace abbe {

/// The files named, and below the folders named all programs (.dmi), in the order of their names.
std::vector<std::string> program_files(const std::vector<std::string>& paths);

/// The same. Throws UserError (E0601) when there is none.
std::vector<std::string> some_program_files(const std::vector<std::string>& paths);

}  // namespace abbe
