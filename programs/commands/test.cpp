// `abbe test`: runs programs and compares their figures with what their `$$! expect` lines ask for.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/base/file_kind.hpp"
#include "engine/base/files.hpp"
#include "programs/commands/commands.hpp"
#include "programs/expectations.hpp"
#include "programs/junit.hpp"
#include "programs/program_files.hpp"
#include "programs/terminal.hpp"

namespace abbe {

namespace {

/// Every expectation of a program that cannot be run fails for the same reason.
void fail_all(TestSuite& suite, const std::vector<lang::Expectation>& expectations, const std::string& reason) {
  for (const lang::Expectation& e : expectations) suite.cases.push_back({e.text, e.line, reason, false});
}

/// Errors of a program by where they stand: in its `$$!` directives, or in its statements.
struct Errors {
  std::vector<Diagnostic> directives;
  bool in_statements = false;
};

Errors errors_of(const CompiledProgram& program) {
  Errors errors;
  for (const Diagnostic& d : program.messages) {
    if (d.severity() != Severity::error) continue;
    const std::size_t directive = d.source_line.find("$$!");
    if (directive < static_cast<std::size_t>(d.place.column))
      errors.directives.push_back(d);
    else
      errors.in_statements = true;
  }
  return errors;
}

/// A directive that cannot be read must fail, not vanish. Expectations that were read are judged by
/// themselves.
void fail_unreadable(TestSuite& suite, const Errors& errors, const std::vector<lang::Expectation>& expectations) {
  for (const Diagnostic& d : errors.directives) {
    const bool read =
        std::any_of(expectations.begin(), expectations.end(), [&](const auto& e) { return e.line == d.place.line; });
    if (!read)
      suite.cases.push_back(
          {d.source_line, d.place.line, fmt::format("{} {}; {}", info(d.code).name, d.message, d.help), false});
  }
}

TestSuite test_program(const CompiledProgram& program, const TestOptions& options, ProgressLine& progress) {
  const std::string& path = program.source.name();
  const auto& expectations = program.compilation.directives.expectations;
  const Errors errors = errors_of(program);
  TestSuite suite{path, {}};
  fail_unreadable(suite, errors, expectations);
  if (expectations.empty()) return suite;
  if (errors.in_statements) {
    fail_all(suite, expectations, "the program has errors; `abbe check` lists them");
    return suite;
  }
  const auto fail = [&](const UserError& error) {
    print_messages(error.diagnostics());
    fail_all(suite, expectations, error.what());
  };
  StudyInputs inputs;
  try {
    inputs = read_inputs(program, options.settings);
  } catch (const UserError& error) {
    fail(error);
    return suite;
  }
  // a mistake of the command, not of the program
  if (options.junit) refuse_overwriting(inputs.files, {*options.junit});
  try {
    const Study study = study_program(program, options.settings, inputs,
                                      [&](std::string_view step) { progress.show(fmt::format("{}: {}", path, step)); });
    for (const lang::Expectation& e : expectations) {
      const ExpectationVerdict verdict = judge(e, study.report);
      suite.cases.push_back({e.text, e.line, verdict.outcome, verdict.passed});
    }
  } catch (const UserError& error) {
    fail(error);
  }
  return suite;
}

/// A program that cannot even be read has no expectations, and passes none: it is one case that fails.
TestSuite test_file(const std::string& path, const TestOptions& options, ProgressLine& progress) {
  std::optional<CompiledProgram> program;
  try {
    program = compile_program(path, {options.answers});
  } catch (const UserError& error) {
    print_messages(error.diagnostics());
    return {path, {{"a program that can be read", 1, error.what(), false}}};
  }
  return test_program(*program, options, progress);
}

/// A path that leads nowhere, and a file of another kind, are mistakes of the command, told before the work. What else is
/// wrong with a file is that program's.
void refuse_no_programs(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!is_there(path))
      throw UserError(diagnostic(Code::E0601, fmt::format("cannot read '{}': it does not exist", path),
                                 "check the name of the program or folder"));
    if (!is_file(path)) continue;  // a pipe is read once
    try {
      refuse_other_kind(read_source(path), FileKind::program);
    } catch (const UserError& error) {
      if (error.diagnostics().front().code == Code::E0622) throw;
    }
  }
}

}  // namespace

int test_command(const TestOptions& options) {
  refuse_no_programs(options.paths);
  const std::vector<std::string> programs = program_files(options.paths);
  if (options.junit) refuse_overwriting(programs, {*options.junit});
  std::vector<TestSuite> suites;
  int passed = 0, failed = 0;
  for (const std::string& path : programs) {
    ProgressLine progress;
    TestSuite suite = test_file(path, options, progress);
    if (suite.cases.empty()) continue;
    for (const TestCase& c : suite.cases) {
      ++(c.passed ? passed : failed);
      print_result(fmt::format("{}  {}:{}: {}\n", c.passed ? "ok  " : "FAIL", path, c.line, c.outcome));
    }
    suites.push_back(std::move(suite));
  }
  if (suites.empty())
    throw UserError(diagnostic(Code::E0607, "no program with an expectation was found",
                               "write a line such as `$$! expect TA(LEN) u95 between 0.003 0.005` into a .dmi file"));
  std::vector<OutputFile> files;
  if (options.junit) files.push_back({*options.junit, junit_xml(suites)});
  print_result(fmt::format("{} passed, {} failed\n", passed, failed), files);
  return failed ? kNo : kDone;
}

}  // namespace abbe
