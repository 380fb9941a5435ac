#include "programs/program_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/diagnostic.hpp"
#include "engine/base/files.hpp"
#include "engine/base/letter_case.hpp"

namespace abbe {

namespace fs = std::filesystem;

std::vector<std::string> program_files(const std::vector<std::string>& paths) {
  std::vector<std::string> found;
  for (const std::string& path : paths) {
    std::error_code none;
    if (!fs::is_directory(path, none)) {
      found.push_back(path);
      continue;
    }
    std::vector<std::string> below;
    for (const auto& entry : fs::recursive_directory_iterator(path, fs::directory_options::skip_permission_denied))
      if (is_file(entry.path().string()) && upper(entry.path().extension().string()) == ".DMI")
        below.push_back(entry.path().string());
    std::sort(below.begin(), below.end());
    found.insert(found.end(), below.begin(), below.end());
  }
  return found;
}

std::vector<std::string> some_program_files(const std::vector<std::string>& paths) {
  std::vector<std::string> found = program_files(paths);
  if (found.empty())
    throw UserError(diagnostic(Code::E0601, fmt::format("no program (.dmi) lies in '{}'", fmt::join(paths, "', '")),
                               "check the name of the folder, or name the files"));
  return found;
}

}  // namespace abbe
