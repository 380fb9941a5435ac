// abbe explain [WORD|EFFECT|MESSAGE-CODE]: help from the tables that the program itself uses.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "engine/base/diagnostic.hpp"
#include "engine/base/letter_case.hpp"
#include "engine/effects/effect.hpp"
#include "engine/figures/signature.hpp"
#include "engine/machine/machine.hpp"
#include "lang/reference.hpp"
#include "programs/commands/commands.hpp"

namespace abbe {
namespace {

std::optional<std::string> explain_code(const std::string& word) {
  for (const CodeInfo& code : all_codes())
    if (code.name == word) return fmt::format("{}: {}\n", code.name, code.title);
  return std::nullopt;
}

std::optional<std::string> explain_effect(const std::string& name) {
  const Effect* effect = find_effect(name);
  if (!effect) return std::nullopt;
  std::string out = fmt::format("{}: {}\n  {}\n", effect->name, effect->title, effect->help);
  for (const EffectParameter& p : effect->parameters)
    out += fmt::format("  {} [{}]  {}; {} to {}\n", p.name, p.unit, p.help, p.low, p.high);
  return out + fmt::format("  told apart by: {}\n  source: {}\n", effect->separate, effect->source);
}

std::string overview() {
  std::string out = lang::list_of_words() + "\nEffects\n";
  for (const Effect* effect : effects())
    out += fmt::format("  {:<34} {}\n", effect->name, effect->title);
  return out +
         "\n`abbe explain WORD` explains a word, an effect, or the code of a message (E0110).\n";
}

[[noreturn]] void unknown(const std::string& word) {
  std::vector<std::string_view> candidates = lang::explained_words();
  for (const Effect* effect : effects()) candidates.push_back(effect->name);
  for (const CodeInfo& code : all_codes()) candidates.push_back(code.name);
  const std::string near = nearest_word(word, candidates);
  throw UserError(diagnostic(
      Code::E0609, fmt::format("there is nothing to explain under '{}'", word),
      near.empty() ? "`abbe explain` lists the words" : fmt::format("did you mean {}?", near)));
}

[[noreturn]] void no_figure(const std::string& what, const std::string& word) {
  std::vector<std::string_view> names;
  for (const Effect* effect : effects()) names.push_back(effect->name);
  const std::string near = nearest_word(word, names);
  throw UserError(diagnostic(Code::E0431, what,
                             near.empty() ? "`abbe explain` lists the effects; each has a figure"
                                          : fmt::format("did you mean {}?", near)));
}

/// The specification of the figure of an effect; nothing else has one.
std::string figure(const std::optional<std::string>& word) {
  if (!word) no_figure("--format vega draws the signature of an effect, and none is named", "");
  const Effect* effect = find_effect(*word);
  if (!effect) no_figure(fmt::format("--format vega draws effects, and '{}' is none", *word), *word);
  return vega_lite(signature(*effect, read_machine(kDefaultMachine)));
}

}  // namespace

int explain_command(const ExplainOptions& options) {
  if (options.format == "vega") return fmt::print("{}", figure(options.word)), kDone;
  if (options.markdown) return fmt::print("{}", lang::reference_markdown()), kDone;
  if (!options.word) return fmt::print("{}", overview()), kDone;
  std::optional<std::string> text = explain_code(upper(*options.word));
  if (!text) text = lang::explain_word(*options.word);
  if (!text) text = explain_effect(*options.word);
  if (!text) unknown(*options.word);
  fmt::print("{}", *text);
  return kDone;
}

}  // namespace abbe
