// Files that are there, and output files: they appear whole or not at all, and destroy nothing that the same command
// reads or writes.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// Whether something, or a regular file, stands at the path. What cannot even be looked for, because its folder is locked,
/// its name too long or its link leads round in a circle, does not.
bool is_there(const std::string& path);
bool is_file(const std::string& path);

/// Writes `content` to a temporary file beside `path` and renames it. A link stays, and the file that it
/// points to is replaced; into a device or a pipe the content is written. A file keeps its permissions; one
/// that is read-only is not replaced. A signal that would end the program waits for the file. Throws
/// UserError when writing fails; then a file at `path` is what it was before.
void write_whole(const std::string& path, std::string_view content);

struct OutputFile {
  std::string path, content;
};

/// Writes several files of one command so, all or none: every file is there before the first takes its place. What cannot
/// be taken back goes before: into devices and pipes, and what `print` writes elsewhere. When that throws, no file changes.
void write_together(const std::vector<OutputFile>&, const std::function<void()>& print = {});

/// Throws UserError when an output is one of the inputs, stands there twice, whatever the paths are called,
/// is read-only or a folder, or has the name "" or "-". Call it before the work.
void refuse_overwriting(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

}  // namespace abbe
