// Output files appear whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace abbe {

/// Writes `content` to a temporary file beside `path` and renames it. Throws UserError when that fails; then `path` is
/// what it was before.
void write_whole(const std::string& path, std::string_view content);

}  // namespace abbe
