// abbe explain [WORD|EFFECT|FAMILY|ACCEPTANCE-TEST|MESSAGE-CODE]: help from the tables that the program itself uses.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include "engine/base/diagnostic.hpp"
#include "engine/base/ids.hpp"
#include "engine/base/letter_case.hpp"
#include "engine/effects/effect.hpp"
#include "engine/figures/signature.hpp"
#include "engine/machine/acceptance/acceptance.hpp"
#include "engine/machine/machine.hpp"
#include "engine/report/report_words.hpp"
#include "lang/reference.hpp"
#include "programs/commands/commands.hpp"
#include "programs/terminal.hpp"

namespace abbe {
namespace {

/// What the messages of a range of codes have in common (engine/base/diagnostic_codes.def).
struct CodeRange {
  std::string_view digits;
  std::string_view about, found_when, read;
};
constexpr CodeRange kRanges[] = {
    {"01", "text and statements of a program",
     "a statement is read, before anything is known of those around it: `abbe check` tells all of them",
     "docs/language.md, and `abbe explain WORD` for the form of a statement"},
    {"02", "meaning of a program",
     "a statement is understood, but not together with the others: labels, units, features, tolerances, variables",
     "docs/language.md, and `abbe explain WORD` for the form of a statement"},
    {"03", "running a program",
     "the program runs on a machine: its sensors, travels and effects, and what was measured",
     "docs/language.md (\"What running means\"), docs/machine.md (\"Machine file\"), docs/physics.md (\"Effects\")"},
    {"04", "machine, workpiece and effects",
     "a JSON file is read, its machines are screened against the specification, or too few of them run",
     "docs/machine.md (\"Machine file\", \"Screening\"), docs/workpiece.md"},
    {"05", "points, tables and recordings", "a table (CSV) or a DMIS result file is read, with what belongs to it",
     "docs/recording.md (\"Recordings\", \"Points\")"},
    {"06", "files and command line", "a command is understood, and what it needs is found: settings, files, memory",
     "docs/results.md (\"Files\"), and `abbe COMMAND --help`"},
    {"07", "diagnosis of recordings", "a recording is compared with what the simulated machines may do",
     "docs/diagnosis.md, docs/recording.md (\"Problems with a file\")"},
};

const CodeRange& range_of(const CodeInfo& code) {
  const auto* const found = std::find_if(std::begin(kRanges), std::end(kRanges),
                                         [&](const CodeRange& r) { return r.digits == code.name.substr(1, 2); });
  ABBE_CHECK(found != std::end(kRanges));
  return *found;
}

std::string_view consequence(Severity severity) {
  switch (severity) {
    case Severity::error: return "an error: this cannot be used as it is, and no result comes of it";
    case Severity::warning: return "a warning: the result comes, but may not mean what was meant";
    case Severity::note: return "a note: nothing is wrong, but it is worth knowing";
  }
  return "";
}

std::optional<std::string> explain_code(const std::string& word) {
  for (const CodeInfo& code : all_codes())
    if (code.name == word)
      return fmt::format(
          "{}: {}\n  about: {}\n  found when {}\n  {}: {}\n  read: {}\n  The message itself says where it is, what was found there, and the next step.\n",
          code.name, code.title, range_of(code).about, range_of(code).found_when, code.name.front(),
          consequence(code.severity), range_of(code).read);
  return std::nullopt;
}

/// What holds of a parameter that is left out, and what may be given.
std::string range_of(const EffectParameter& p) {
  if (p.choices.empty()) return fmt::format("{:g} if left out; {} to {}", p.standard, p.low, p.high);
  const auto left_out = static_cast<std::size_t>(p.standard - p.low);
  return fmt::format("{} if left out; one of {}", p.choices[left_out], fmt::join(p.choices, ", "));
}

bool described_alike(const EffectParameter& a, const EffectParameter& b) {
  return a.unit == b.unit && a.help == b.help && range_of(a) == range_of(b);
}

/// A line for each parameter; what is described alike, as the knots of a curve, shares one.
std::string lines_of(std::span<const EffectParameter> parameters) {
  constexpr std::size_t kShown = 30;
  std::string out;
  for (std::size_t k = 0, next = 0; k < parameters.size(); k = next) {
    std::vector<std::string_view> names;
    for (; next < parameters.size() && described_alike(parameters[k], parameters[next]); ++next)
      names.push_back(parameters[next].name);
    const std::size_t last = names.size() - 1;
    if (names.size() > kShown)
      names.erase(names.begin() + 5, names.begin() + static_cast<std::ptrdiff_t>(last)),
          names.insert(names.end() - 1, "...");
    out += fmt::format("  {} [{}]  {}; {}\n", fmt::join(names, ", "), parameters[k].unit, parameters[k].help,
                       range_of(parameters[k]));
  }
  return out;
}

/// `record --with EFFECT` gives the first parameter its typical size (record.cpp).
std::string alone(const Effect& effect) {
  if (effect.parameters.empty() || effect.parameters.front().typical == 0) return "";
  const EffectParameter& first = effect.parameters.front();
  return fmt::format("  `abbe record --with {}` alone: {}={:g}\n", effect.name, first.name, first.typical);
}

std::optional<std::string> explain_effect(const std::string& name) {
  const Effect* effect = find_effect(name);
  if (!effect) return std::nullopt;
  return fmt::format("{}: {}\n  {}\n", effect->name, effect->title, effect->help) + lines_of(effect->parameters) +
      alone(*effect) + fmt::format("  told apart by: {}\n  source: {}\n", effect->separate, effect->source);
}

std::string line_of(const Effect& effect) { return fmt::format("  {:<34} {}\n", effect.name, effect.title); }

/// The effects of a family: head, probe, ...
std::optional<std::string> explain_family(std::string_view name) {
  std::string lines;
  for (const Effect* effect : effects())
    if (effect->name.starts_with(name) && effect->name.substr(name.size()).starts_with('.')) lines += line_of(*effect);
  if (lines.empty()) return std::nullopt;
  return fmt::format("{}: a family of effects\n{}", name, lines);
}

std::optional<std::string> explain_acceptance_test(const std::string& name) {
  for (const AcceptanceTest* test : acceptance_tests())
    if (upper(std::string(test->name)) == upper(name))
      return fmt::format(
          "{}: an acceptance test of machines\n  {}\n  what it does here: {}; `abbe machine screen FILE` shows it\n  source: {}\n",
          test->name, test->help,
          test->lines ? "simulated machines must pass it" : "says whether the stated probe would pass it",
          test->source);
  return std::nullopt;
}

/// The words of one kind of answer.
struct Answers {
  std::string_view title, plural;
  std::span<const ReportWord> words;
};
std::array<Answers, 2> answers() {
  return {{{"Report", "reports", report_words()}, {"Diagnosis", "diagnoses", diagnosis_words()}}};
}

/// A word of an answer, first as it is written: u is not U.
std::optional<std::string> explain_word_of(const Answers& answers, const std::string& asked) {
  const std::span<const ReportWord> words = answers.words;
  auto found =
      std::find_if(words.begin(), words.end(), [&](const ReportWord& w) { return w.word == asked || w.key == asked; });
  const std::string same = upper(asked);
  if (found == words.end())
    found = std::find_if(words.begin(), words.end(),
                         [&](const ReportWord& w) { return upper(w.word) == same || upper(w.key) == same; });
  if (found == words.end() || asked.empty()) return std::nullopt;
  const auto& [word, key, help] = *found;
  const bool both = !word.empty() && !key.empty() && word != key;
  return fmt::format("{}: a word of {}{}\n  {}\n", word.empty() ? key : word, answers.plural,
                     both ? fmt::format("; `{}` in the JSON", key) : "", help);
}

std::vector<std::string_view> words_of(const Answers& answers) {
  std::vector<std::string_view> names;
  for (const ReportWord& w : answers.words)
    for (const std::string_view name : {w.word, w.key})
      if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

std::string overview() {
  std::string out = lang::list_of_words();
  for (const Answers& one : answers()) out += "\n" + lang::list_of_group(one.title, words_of(one));
  out += "\nAcceptance tests\n";
  for (const AcceptanceTest* test : acceptance_tests()) out += fmt::format("  {:<34} {}\n", test->name, test->source);
  out += "\nEffects\n";
  for (const Effect* effect : effects()) out += line_of(*effect);
  return out +
      "\n`abbe explain WORD` explains a word, an effect, a family of effects (head), an acceptance test, or the code of a message (E0110).\n";
}

[[noreturn]] void unknown(const std::string& word) {
  std::vector<std::string_view> candidates = lang::explained_words();
  for (const Effect* effect : effects()) candidates.push_back(effect->name);
  for (const Answers& one : answers())
    for (const std::string_view name : words_of(one)) candidates.push_back(name);
  for (const AcceptanceTest* test : acceptance_tests()) candidates.push_back(test->name);
  for (const CodeInfo& code : all_codes()) candidates.push_back(code.name);
  const std::string near = nearest_name(word, candidates);
  throw UserError(diagnostic(Code::E0609, fmt::format("there is nothing to explain under '{}'", word),
                             near.empty() ? "`abbe explain` lists the words" : fmt::format("did you mean {}?", near)));
}

[[noreturn]] void no_figure(const std::string& what, const std::string& word) {
  std::vector<std::string_view> names;
  for (const Effect* effect : effects()) names.push_back(effect->name);
  const std::string near = nearest_name(word, names);
  throw UserError(diagnostic(
      Code::E0431, what,
      near.empty() ? "`abbe explain` lists the effects; each has a figure" : fmt::format("did you mean {}?", near)));
}

/// The specification of the figure of an effect; nothing else has one.
std::string figure(const std::optional<std::string>& word) {
  if (!word) no_figure("--format vega draws the signature of an effect, and none is named", "");
  const Effect* effect = find_effect(*word);
  if (!effect) no_figure(fmt::format("--format vega draws effects, and '{}' is none", *word), *word);
  return vega_lite(signature(*effect, read_machine(kDefaultMachine)));
}

std::string text_of(const ExplainOptions& options) {
  if (options.format == "vega") return figure(options.word);
  if (options.markdown) return lang::reference_markdown();
  if (!options.word) return overview();
  const std::string& word = *options.word;
  std::string out;  // a word may be one of programs, of reports and of diagnoses: VALUE
  const auto add = [&](const std::optional<std::string>& text) {
    if (text) out += (out.empty() ? "" : "\n") + *text;
  };
  add(explain_code(upper(word)));
  add(lang::explain_word(word));
  for (const Answers& one : answers()) add(explain_word_of(one, word));
  add(explain_effect(word));
  add(explain_family(word));
  add(explain_acceptance_test(word));
  if (out.empty()) out = lang::explain_argument_word(word).value_or("");
  if (out.empty()) unknown(word);
  return out;
}

}  // namespace

int explain_command(const ExplainOptions& options) {
  print_result(text_of(options));
  return kDone;
}

}  // namespace abbe
