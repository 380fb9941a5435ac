#include "tests/unit/lang/cases.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "lang/parser.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

namespace fs = std::filesystem;

std::vector<fs::path> case_files(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(ABBE_SOURCE_DIR) / "tests/lang" / folder))
    if (entry.path().extension() == ".dmi") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> expected_messages(const SourceFile& source) {
  static const std::regex pattern(R"(\$\$ expect (?:(?:error|warning|note) ([EWN]\d{4})|(lost))(?: at ([+-]?)(\d+))?)");
  std::vector<std::string> out;
  for (int line = 1; line <= source.line_count(); ++line) {
    const std::string text(source.line(line));
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
      const std::string sign = (*it)[3], number = (*it)[4];
      const int value = number.empty() ? 0 : std::stoi(number);
      const int at = number.empty() ? line : sign == "+" ? line + value : sign == "-" ? line - value : value;
      out.push_back(fmt::format("{} {}", at, (*it)[2].matched ? "lost" : (*it)[1].str()));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> actual_messages(const Sink& sink, const Compilation& compilation) {
  std::vector<std::string> out;
  for (const Diagnostic& d : sink.list()) out.push_back(fmt::format("{} {}", d.place.line, info(d.code).name));
  for (const Lost& lost : compilation.lost) out.push_back(fmt::format("{} lost", lost.line));
  std::sort(out.begin(), out.end());
  return out;
}

namespace {

std::string read_text(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string all_messages(const Sink& sink) {
  std::string out;
  for (const Diagnostic& d : sink.sorted()) out += render(d);
  return out;
}

/// Every message of a compilation has a place inside the file, a text and a caret under the line.
void check_messages_are_sound(const SourceFile& source, const Sink& sink) {
  for (const Diagnostic& d : sink.list()) {
    CHECK_FALSE(d.message.empty());
    REQUIRE(d.span.has_value());
    CHECK(d.span->begin <= d.span->end);
    CHECK(d.span->end <= source.text().size());
    CHECK(d.caret_length >= 1);
  }
}

void run_case(const fs::path& path) {
  INFO(path.string());
  const SourceFile source(path.string(), read_text(path));  // modules lie beside it
  Sink sink;
  const Compilation compilation = compile(source, sink);
  INFO(all_messages(sink));
  CHECK(fmt::format("{}", fmt::join(actual_messages(sink, compilation), "\n")) ==
        fmt::format("{}", fmt::join(expected_messages(source), "\n")));
  check_messages_are_sound(source, sink);
  const fs::path golden = fs::path(path).replace_extension(".plan");
  if (std::getenv("ABBE_REFRESH_GOLDEN") && fs::exists(golden)) std::ofstream(golden) << to_text(compilation.plan);
  if (fs::exists(golden)) CHECK(to_text(compilation.plan) == read_text(golden));
}

}  // namespace

TEST_CASE("correct programs compile without errors") {
  for (const fs::path& path : case_files("ok")) {
    run_case(path);
    Sink sink;
    compile(SourceFile(path.string(), read_text(path)), sink);
    CHECK_FALSE(sink.has_errors());
  }
}

TEST_CASE("mistakes are reported at their places, all of them") {
  for (const fs::path& path : case_files("error")) run_case(path);
}

TEST_CASE("every statement has a case in which it is right and one in which it is wrong") {
  const auto words_of = [](const std::string& folder, bool reported) {
    std::set<std::string> words;
    for (const fs::path& path : case_files(folder)) {
      const SourceFile source(path.string(), read_text(path));
      std::set<int> lines;  // with an expected error
      for (const std::string& message : expected_messages(source))
        if (message.find(" E") != std::string::npos) lines.insert(std::stoi(message));
      Sink sink;
      for (const LogicalLine& line : logical_lines(source)) {
        const auto raw = parse_statement(line, source, sink);
        if (raw && (!reported || lines.count(line.line) > 0)) words.insert(raw->word);
      }
    }
    return words;
  };
  const std::set<std::string> right = words_of("ok", false), wrong = words_of("error", true);
  for (const Statement* s : statements()) {
    const std::string word(s->word);
    // there is no device to read from: always an error
    CHECK_MESSAGE((right.contains(word) || word == "READ"), word << " stands in no program of tests/lang/ok");
    CHECK_MESSAGE(wrong.contains(word), word << " has no mistake in a program of tests/lang/error");
  }
}

TEST_CASE("limits are reported") {
  for (const fs::path& path : case_files("limit")) run_case(path);
}

TEST_CASE("no edit of a program crashes the compiler") {
  // The standard fixes the sequence of mt19937, so this test does the same everywhere.
  std::mt19937 random(20221107);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const std::string splices[] = {
      "$",    "$$",    "'",  "(",   ")",       ",", "=", "/", "\n", "\r", std::string(1, '\0'),
      "\xff", "1E999", "F(", "$$!", "ENDMES\n"};
  std::size_t compiled = 0;
  for (const std::string folder : {"ok", "error"}) {
    for (const fs::path& path : case_files(folder)) {
      const std::string original = read_text(path);
      for (int round = 0; round < 60; ++round) {
        std::string text = original;
        for (std::size_t edits = 1 + below(6); edits > 0; --edits) {
          const std::size_t at = below(text.size() + 1);
          if (below(3) == 0) {
            text.insert(at, splices[below(std::size(splices))]);
          } else if (below(2) == 0) {
            text.erase(at, 1 + below(20));
          } else if (at < text.size()) {
            text[at] = static_cast<char>(below(256));
          }
        }
        const SourceFile source("edited.dmi", text);
        Sink sink;
        const Compilation compilation = compile(source, sink);
        check_messages_are_sound(source, sink);
        compiled += to_text(compilation.plan).empty() ? 0 : 1;
      }
    }
  }
  CHECK(compiled > 500);
}

TEST_CASE("real programs compile without errors") {
  const char* set = std::getenv("ABBE_REFERENCE_DMIS");
  const fs::path folder = set ? fs::path(set) : fs::path(ABBE_SOURCE_DIR) / "../shared/reference/dmis";
  if (!fs::is_directory(folder)) {
    MESSAGE("skipped: no folder ", folder.string(), "; set ABBE_REFERENCE_DMIS to one with .dmi files");
    return;
  }
  int programs = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".dmi") continue;
    Sink sink;
    const Compilation compilation = compile(read_source(entry.path().string()), sink);
    INFO(all_messages(sink));
    CHECK_FALSE(sink.has_errors());
    CHECK(compilation.lost.empty());
    CHECK_FALSE(compilation.plan.operations.empty());
    ++programs;
  }
  CHECK(programs > 0);
}

}  // namespace abbe::lang
