// Messages to the user are data: a stable code, a place, a text, a help. Nothing in the engine or in the language
// prints or exits; a Sink collects, and the program at the edge renders.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/source.hpp"

namespace abbe {

enum class Severity {
  error,    ///< this statement, file or value cannot be used
  warning,  ///< understood, but without effect here, or suspect
  note,     ///< worth knowing
};
std::string_view name(Severity);

/// One constant per line of diagnostic_codes.def, for example Code::E0101.
enum class Code {
#define X(code, severity, title) code,
#include "engine/base/diagnostic_codes.def"
#undef X
};

struct CodeInfo {
  Code code;
  std::string_view name;  ///< "E0101": what the user sees, greps and asks `abbe explain` for
  Severity severity;
  std::string_view title;  ///< what this code means, in one line
};
const CodeInfo& info(Code code);
const std::vector<CodeInfo>& all_codes();

struct Diagnostic {
  Code code{};
  std::string message;       ///< what is wrong, in the user's words: names what was written and what was expected
  std::string help;          ///< the next step; may be empty
  std::string file;          ///< file name; empty when the message is about no file
  std::optional<Span> span;  ///< bytes of the file, when there is a place
  Place place;               ///< line and column of span.begin
  std::string source_line;   ///< the line there, for the caret
  int caret_length = 0;      ///< how many columns to underline
  std::string replacement;   ///< text that would mend the span (editors offer it as a quick fix); may be empty

  Severity severity() const { return info(code).severity; }
};

/// Builds a diagnostic with the place, the line and the caret taken from `source`.
Diagnostic diagnostic_at(const SourceFile& source, Span span, Code code, std::string message, std::string help = "",
                         std::string replacement = "");
/// A diagnostic without a place in a file.
Diagnostic diagnostic(Code code, std::string message, std::string help = "");

/// "file:line:column: error E0101: message", the line, the caret, "help: ...". Ends with a newline.
std::string render(const Diagnostic& d);

/// Collects diagnostics in the order in which they are found; sorted() gives them by place.
class Sink {
 public:
  void add(Diagnostic d) { list_.push_back(std::move(d)); }
  const std::vector<Diagnostic>& list() const { return list_; }
  std::vector<Diagnostic> sorted() const;
  bool has_errors() const;

 private:
  std::vector<Diagnostic> list_;
};

/// The user's input cannot be used at all (unreadable file, broken JSON, impossible machine). Carries the messages;
/// the command line prints them and exits with 2.
class UserError : public std::runtime_error {
 public:
  explicit UserError(Diagnostic d);
  explicit UserError(std::vector<Diagnostic> list);
  const std::vector<Diagnostic>& diagnostics() const { return list_; }

 private:
  std::vector<Diagnostic> list_;
};

/// The word of `candidates` nearest to `word` (case-insensitive edit distance), or "" when none is near enough to be a
/// likely slip of the pen (distance at most 2, and at most a third of the longer word's length).
std::string nearest_word(std::string_view word, const std::vector<std::string_view>& candidates);
/// The nearest word of names that have parts, as "probe.pretravel_lobing" and "travel_mm"; else the nearest by what stands
/// behind the family, else the only one that begins or ends with `word` as a part.
std::string nearest_name(std::string_view word, const std::vector<std::string_view>& candidates);
/// Whether two names of a quantity differ in the unit behind their last "_" alone ("part_F", "part_C"), or are those of an
/// expanded and a standard uncertainty ("U", "u"): who takes the one for the other must convert the number.
bool differ_in_unit(std::string_view name, std::string_view other);

}  // namespace abbe
