// The machine files of examples/machines, embedded into the program (embed.cmake):
// `--machine coord3-mc16` works from any folder and without installed data.
#pragma once

#include <span>
#include <string_view>

namespace abbe {

struct ShippedFile {
  std::string_view name;  ///< "coord3-mc16"
  std::string_view text;  ///< the whole file
};
/// In alphabetical order of the names.
std::span<const ShippedFile> shipped_machine_files();

}  // namespace abbe
