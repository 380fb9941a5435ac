#include "engine/base/file_kind.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/letter_case.hpp"

namespace abbe {

namespace {

constexpr std::string_view kBlank = " \t\r\"";

std::string_view bare(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlank), text.size());
  return text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin);
}

/// The first lines that are not empty.
std::vector<std::string_view> first_lines(std::string_view text) {
  constexpr std::size_t kMost = 50;
  std::vector<std::string_view> lines;
  while (!text.empty() && lines.size() < kMost) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (const std::string_view line = bare(text.substr(0, end)); !line.empty()) lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// Whether a line names two columns of our tables. A statement that does, DECL/REAL,X,Y, has a slash.
bool is_header(std::string_view line) {
  constexpr std::array<std::string_view, 9> kColumns = {"FEATURE", "TOUCH",          "X",     "Y",      "Z",
                                                        "TIME_S",  "CHARACTERISTIC", "VALUE", "PROGRAM"};
  int known = 0;
  if (line.find('/') != std::string_view::npos) return false;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(",;\t"), line.size());
    known += std::count(kColumns.begin(), kColumns.end(), upper(bare(line.substr(0, end)))) > 0 ? 1 : 0;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return known >= 2;
}

/// "# machine: ..."
bool is_metadata(std::string_view line) {
  if (!line.starts_with("# ")) return false;
  const std::size_t end = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", 2);
  return end != std::string_view::npos && end > 2 && line[end] == ':';
}

/// "FA(BORE) = FEAT/..."
bool is_outcome(std::string_view line) {
  const std::string_view label = line.substr(0, 3);
  return (upper(label) == "FA(" || upper(label) == "TA(") && line.find('=') != std::string_view::npos;
}

bool is_of_program(std::string_view line) {
  constexpr std::string_view kBegin = "DMISMN/";
  return line.starts_with("$$") || upper(line.substr(0, kBegin.size())) == kBegin;
}

std::string_view name_of(FileKind kind) {
  switch (kind) {
    case FileKind::program: return "a DMIS program";
    case FileKind::result: return "a DMIS result file";
    case FileKind::json: return "a JSON file";
    case FileKind::table: return "a table (CSV), as recordings are";
    case FileKind::unknown: break;
  }
  return "a text";
}

std::string_view reader_of(FileKind kind) {
  switch (kind) {
    case FileKind::program: return "`abbe run` and `abbe check` read programs";
    case FileKind::result: return "`abbe diagnose` reads result files, whose names end with .dmo";
    case FileKind::json: return "--machine and --workpiece take JSON files; `abbe machine show` shows a machine";
    case FileKind::table: return "`abbe diagnose` reads recordings, `abbe fit` points";
    case FileKind::unknown: break;
  }
  return "";
}

}  // namespace

FileKind kind_of(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::vector<std::string_view> lines = first_lines(text);
  if (lines.empty()) return FileKind::unknown;
  if (lines.front().front() == '{') return FileKind::json;
  if (is_metadata(lines.front())) return FileKind::table;
  const auto content = std::find_if(lines.begin(), lines.end(), [](std::string_view l) { return l.front() != '#'; });
  if (content != lines.end() && is_header(*content)) return FileKind::table;
  if (std::any_of(lines.begin(), lines.end(), is_outcome)) return FileKind::result;
  return std::any_of(lines.begin(), lines.end(), is_of_program) ? FileKind::program : FileKind::unknown;
}

void refuse_other_kind(const SourceFile& source, FileKind expected) {
  const FileKind kind = kind_of(source.text());
  if (kind == expected || kind == FileKind::unknown) return;
  throw UserError(diagnostic(Code::E0622,
                             "'" + source.name() + "' is " + std::string(name_of(kind)) +
                                 "; what is expected here is " + std::string(name_of(expected)),
                             std::string(reader_of(kind))));
}

}  // namespace abbe
