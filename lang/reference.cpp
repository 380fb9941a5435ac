#include "lang/reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "engine/features/construct.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/tolerance.hpp"
#include "lang/directives.hpp"
#include "lang/intrinsics.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

/// One word, whichever table it comes from.
struct Entry {
  std::string_view group, word;
  std::string form;  ///< the statement with its signature
  std::string_view help, example, source;
};

constexpr std::string_view kStatements = "Statements", kFeatures = "Features", kConstructions = "Constructions",
                           kTolerances = "Tolerances", kFunctions = "Functions", kDirectives = "Directives";

std::string form_of(const Statement& s) {
  const std::string label = s.label.empty() || s.label == "*" ? ""
      : s.label == "="                                        ? "variable="
                                                              : fmt::format("{}(label)=", s.label);
  return s.signature.empty() ? fmt::format("{}{}", label, s.word) : fmt::format("{}{}/{}", label, s.word, s.signature);
}

std::vector<Entry> entries() {
  std::vector<Entry> out;
  for (const Statement* s : statements())
    out.push_back({kStatements, s->word, form_of(*s), s->help, s->example, s->source});
  for (const FeatureKind* k : feature_kinds())
    out.push_back({kFeatures, k->word,
                   fmt::format("F(label)=FEAT/{}{}{}", k->word, k->signature.empty() ? "" : ",", k->signature), k->help,
                   k->example, k->source});
  for (const Construction* c : constructions())
    out.push_back({kConstructions, c->word, fmt::format("CONST/kind,F(label),{},{}", c->word, c->signature), c->help,
                   c->example, c->source});
  for (const ToleranceKind* t : tolerance_kinds())
    out.push_back({kTolerances, t->word, fmt::format("T(label)=TOL/{},{}", t->word, t->signature), t->help, t->example,
                   t->source});
  for (const Intrinsic& f : intrinsics())
    out.push_back({kFunctions, f.name, std::string(f.form), f.help, "", "ISO 22093, intrinsic functions"});
  for (const DirectiveHelp& d : directives())
    out.push_back({kDirectives, d.word, fmt::format("$$! {}", d.form), d.help, "",
                   "Abbe; a real controller skips it as a comment"});
  return out;
}

/// Whether `word`, in upper case, is one of the words between the slash and the end of a form.
bool has_argument_word(std::string_view form, std::string_view word) {
  const auto in_word = [&](std::size_t at) {
    return at < form.size() && (std::isalnum(static_cast<unsigned char>(form[at])) || form[at] == '_');
  };
  const std::size_t slash = form.find('/');
  for (std::size_t at = form.find(word, slash); at < form.size(); at = form.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if (!in_word(at - 1) && !in_word(end) && form.substr(end, 1) != "(") return true;  // F(label) is no word
  }
  return false;
}

/// What a form is called in a sentence, and what `abbe explain` is asked for it.
std::string name_of(const Entry& e) {
  if (e.group == kFeatures) return fmt::format("FEAT/{}", e.word);
  if (e.group == kTolerances) return fmt::format("TOL/{}", e.word);
  return e.group == kConstructions ? fmt::format("CONST with {}", e.word) : std::string(e.word);
}

/// All words of the standard, by what becomes of them.
std::string words_markdown() {
  constexpr std::string_view kNoOperatorNoFiles[] = {"PAUSE", "READ", "WRITE"};
  std::vector<std::string_view> supported, skipped,
      absent(std::begin(kNoOperatorNoFiles), std::end(kNoOperatorNoFiles)), later;
  for (const Statement* s : statements())
    if (std::find(absent.begin(), absent.end(), s->word) == absent.end())
      (s->lower == skip ? skipped : supported).push_back(s->word);
  for (const std::string_view word : standard_words())
    if (!find_statement(word)) later.push_back(word);
  const auto row = [](std::string_view what, std::vector<std::string_view>& words) {
    std::sort(words.begin(), words.end());
    return fmt::format("| {} | {} |\n", what, fmt::join(words, " "));
  };
  return "## Words\n\n| what becomes of it | words |\n|---|---|\n" + row("supported", supported) +
      row("accepted and ignored: nothing depends on it here", skipped) +
      row("understood, with a message: there is no operator and no file here", absent) +
      row("not yet: one warning each, and skipped", later);
}

/// Bars end a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

}  // namespace

std::optional<std::string> explain_word(std::string_view word) {
  const std::string wanted = upper(word);
  std::string out;
  for (const Entry& e : entries()) {
    if (upper(e.word) != wanted) continue;
    out += fmt::format("{}\n  {}\n", e.form, e.help);
    if (!e.example.empty()) out += fmt::format("  example: {}\n", e.example);
    out += fmt::format("  source: {}\n", e.source);
  }
  if (out.empty() && is_standard_word(wanted))
    out = fmt::format("{}\n  a word of the standard that is not supported yet\n", wanted);
  return out.empty() ? std::nullopt : std::optional(out);
}

std::optional<std::string> explain_argument_word(std::string_view word) {
  const std::string wanted = upper(word);
  const auto of_a_word = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  if (wanted.empty() || !std::all_of(wanted.begin(), wanted.end(), of_a_word)) return std::nullopt;
  std::vector<std::string> names;
  std::string_view first;
  for (const Entry& e : entries()) {
    if (e.form.find('/') == std::string::npos || !has_argument_word(e.form, wanted)) continue;
    if (names.empty()) first = e.word;
    names.push_back(name_of(e));
  }
  if (names.empty()) return std::nullopt;
  return fmt::format("{}\n  a word in the arguments of {}\n  `abbe explain {}` shows its place\n", wanted,
                     fmt::join(names, ", "), first);
}

std::vector<std::string_view> explained_words() {
  std::vector<std::string_view> out;
  for (const Entry& e : entries()) out.push_back(e.word);
  return out;
}

std::string list_of_group(std::string_view title, const std::vector<std::string_view>& words) {
  constexpr std::size_t kColumns = 78;
  std::string out = fmt::format("{}\n ", title);
  std::size_t column = 1;
  for (const std::string_view word : words) {
    if (column + word.size() > kColumns) out += "\n ", column = 1;
    out += fmt::format(" {}", word);
    column += word.size() + 1;
  }
  return out + "\n";
}

std::string list_of_words() {
  std::string out;
  const std::vector<Entry> all = entries();
  for (auto first = all.begin(), next = first; first != all.end(); first = next) {
    next = std::find_if(first, all.end(), [&](const Entry& e) { return e.group != first->group; });
    std::vector<std::string_view> words;
    for (auto e = first; e != next; ++e) words.push_back(e->word);
    out += (out.empty() ? "" : "\n") + list_of_group(first->group, words);
  }
  return out;
}

std::string reference_markdown() {
  std::string out;
  std::string_view group;
  for (const Entry& e : entries()) {
    if (e.group != group)
      out +=
          fmt::format("{}## {}\n\n| form | meaning | example |\n|---|---|---|\n", group.empty() ? "" : "\n", e.group);
    group = e.group;
    out += fmt::format("| `{}` | {} | {} |\n", cell(e.form), cell(e.help),
                       e.example.empty() ? "" : fmt::format("`{}`", cell(e.example)));
  }
  out += "\n## Default points\n\n| kind | where a MEAS without PTMEAS touches it |\n|---|---|\n";
  for (const FeatureKind* k : feature_kinds())
    if (k->pattern.touch) out += fmt::format("| {} | {} |\n", k->word, k->pattern.help);
  return out + "\n" + words_markdown();
}

}  // namespace abbe::lang
