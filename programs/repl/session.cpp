#include "programs/repl/session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/run/check_plan.hpp"
#include "lang/blocks.hpp"
#include "lang/labels.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "programs/lsp/complete.hpp"
#include "programs/repl/file_names.hpp"

namespace abbe {

namespace {

/// Whether a text is a whole entry: no line goes on, and every block that begins in it ends in it.
bool complete(const std::string& text) {
  const SourceFile source("", text);
  const std::vector<lang::LogicalLine> lines = lang::logical_lines(source);
  if (lines.back().line != source.line_count()) return false;  // `$`: the empty rest belongs to it
  int depth = 0;
  Sink ignored;
  for (const lang::LogicalLine& line : lines) {
    const auto raw = lang::parse_statement(line, source, ignored);
    if (!raw) continue;
    const lang::Nesting nesting = lang::nesting_of(*raw);
    depth += nesting.before + nesting.after;
  }
  return depth <= 0;
}

std::string word_of(const std::string& line) {
  const SourceFile source("", line);
  Sink ignored;
  const auto raw = lang::parse_statement(lang::logical_lines(source).front(), source, ignored);
  return raw ? raw->word : "";
}

/// What a program that is still being written cannot fulfil. An entry is never taken inside a
/// block, so a MEAS without an end is one whose word is misspelt, which has its own message.
bool premature(Code code) {
  return code == Code::W0225 || code == Code::W0226 || code == Code::E0215 || code == Code::E0205;
}

/// The targets that jumps of the program lack, a line each.
std::string missing_targets(const SourceFile& source, const Sink& sink) {
  std::set<std::string> lines;
  for (const Diagnostic& d : sink.list()) {
    if (d.code != Code::E0233 || d.file != source.name()) continue;
    const std::string_view jump = source.text(*d.span);
    lines.insert(fmt::format("{}\n", jump.substr(jump.find('('))));
  }
  return fmt::format("{}", fmt::join(lines, ""));
}

/// A message about an earlier line is new when that line is reached on another path: a macro by its CALL.
bool same_mistake(const Diagnostic& a, const Diagnostic& b) {
  return a.code == b.code && a.file == b.file && a.span == b.span;
}

/// Two significant digits of the uncertainty.
int decimals_for(double u) { return u > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(u))), 0, 9) : 6; }

std::string result_line(const CharacteristicReport& c) {
  const double u95 = c.varies ? (c.summary.symmetric.high - c.summary.symmetric.low) / 2 : 0;
  const int digits = decimals_for(u95);
  const std::string value =
      c.reference ? fmt::format("{:.{}f} {}", *c.reference, digits, c.unit) : "no value on the error-free machine";
  const std::string uncertainty = c.varies ? fmt::format("{:.{}f} {}", u95, digits, c.unit) : "not known";
  return fmt::format("TA({}) of FA({}): {}, u95 {}\n", c.tolerance, fmt::join(c.features, "), FA("), value,
                     uncertainty);
}

}  // namespace

std::string rendered(const UserError& error) {
  std::string out;
  for (const Diagnostic& d : error.diagnostics()) out += render(d);
  return out;
}

std::string Session::text() const { return fmt::format("{}", fmt::join(entries_, "")); }

CompiledProgram Session::compiled(const std::string& text) const {
  SourceFile source(path_.empty() ? "session" : path_, text);
  Sink sink;
  lang::Compilation compilation = lang::compile(source, sink);
  // A target that is still to come stands at the end, where its jumps lead for now.
  if (const std::string targets = missing_targets(source, sink); !targets.empty()) {
    sink = {};
    source = SourceFile(source.name(), text + targets);
    compilation = lang::compile(source, sink);
  }
  std::vector<Diagnostic> messages = sink.sorted();
  std::erase_if(messages, [](const Diagnostic& d) { return premature(d.code); });
  const bool errors = std::any_of(messages.begin(), messages.end(),
                                  [](const Diagnostic& d) { return d.severity() == Severity::error; });
  return {std::move(source), std::move(compilation), std::move(messages), errors};
}

std::string Session::enter(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first != std::string::npos && line[first] == '.') return command(line.substr(first));
  if (pending_.empty() && first == std::string::npos) return "";
  if (pending_.empty() && word_of(line) == "ENDFIL") return "the session goes on; .save writes the ENDFIL\n";
  pending_ += line + "\n";
  if (!complete(pending_)) return "";
  return entry(std::exchange(pending_, ""));
}

std::string Session::drop() {
  if (pending_.empty()) return "";
  pending_.clear();
  return "the unfinished entry is dropped\n";
}

std::string Session::entry(const std::string& text) {
  const std::string before = this->text();
  const CompiledProgram known = compiled(before), program = compiled(before + text);
  std::string out;
  for (const Diagnostic& d : program.messages) {
    const bool told = std::any_of(known.messages.begin(), known.messages.end(),
                                  [&](const Diagnostic& k) { return same_mistake(k, d); });
    if (!told || d.severity() == Severity::error) out += render(d);
  }
  if (program.has_errors) return out;
  try {
    out += tried(program);
    const std::size_t first = known.compilation.plan.characteristics.size();
    if (program.compilation.plan.characteristics.size() > first) out += evaluate(program, first);
  } catch (const UserError& error) {
    return out + rendered(error);
  }
  entries_.push_back(text);
  return out;
}

std::string Session::tell_once(const std::vector<Diagnostic>& messages) {
  std::string out;
  for (const Diagnostic& d : messages)
    if (const auto [text, is_new] = told_.insert(render(d)); is_new) out += *text;
  return out;
}

std::string Session::tried(const CompiledProgram& program) {
  const StudyInputs in = read_inputs(program, settings_);
  RunOptions options;
  options.workpiece = in.workpiece ? &*in.workpiece : nullptr;
  options.placement_mm = placement_of(program, in.machine).shift_mm;
  return tell_once(check_plan(program.compilation.plan, in.machine, options, program.source));
}

std::string Session::evaluate(const CompiledProgram& program, std::size_t first) {
  CompiledProgram quiet = program;
  quiet.messages.clear();  // they were shown when they arose
  const RunReport report = study_program(quiet, settings_, read_inputs(quiet, settings_)).report;
  std::string out;
  for (const CharacteristicReport& c : report.characteristics)
    if (static_cast<std::size_t>(c.characteristic.value) >= first) out += result_line(c);
  for (const LostCharacteristic& l : report.lost) {
    const std::string lost = fmt::format("lost: line {}: {}: {}\n", l.line, l.feature, l.reason);
    if (told_.insert(lost).second || first == 0) out += lost;
  }
  return out + tell_once(report.messages);
}

std::vector<std::string> Session::completions(const std::string& line) const {
  std::vector<std::string> words;
  if (line.starts_with('.')) {
    const std::size_t blank = line.find(' ');
    const std::string command = line.substr(0, blank);
    if (command == ".load" || command == ".save") {
      const std::size_t path = line.find_first_not_of(' ', blank);
      if (blank != std::string::npos) return file_names(path == std::string::npos ? "" : line.substr(path));
    }
    for (const Command& c : commands())
      words.push_back(std::string(c.word) + (c.form.find(' ') == std::string_view::npos ? "" : " "));
    return words;
  }
  const SourceFile source("session", text() + pending_ + line);
  for (lsp::Proposal& p :
       lsp::proposals(source, lang::label_uses(source), static_cast<std::uint32_t>(source.text().size()))) {
    // A name behind `FA(` ends with the parenthesis.
    const bool inside = p.kind == lsp::Proposal::Kind::reference && p.text.find('(') == std::string::npos;
    words.push_back(inside ? p.text + ")" : std::move(p.text));
  }
  return words;
}

}  // namespace abbe
