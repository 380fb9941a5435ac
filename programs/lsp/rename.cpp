// Giving a name another one. The places come from the text; whether the program still means the same is asked of the
// compiler, because a name may also be made from texts, by @ or by the arguments of a macro, and used in modules.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/base/letter_case.hpp"
#include "lang/intrinsics.hpp"
#include "lang/vocabulary.hpp"
#include "programs/lsp/document.hpp"
#include "programs/lsp/positions.hpp"

namespace abbe::lsp {

using nlohmann::json;

namespace {

/// Whether a name of this kind may be written so.
bool is_name(const std::string& kind, const std::string& name) {
  const auto only = [&](std::string_view signs) {
    return std::all_of(name.begin(), name.end(), [&](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80 || c == '_' ||
          signs.find(c) != std::string_view::npos;
    });
  };
  if (name.empty()) return false;
  if (kind.empty() || kind == lang::kQuotedArgument)
    return only("") && !std::isdigit(static_cast<unsigned char>(name[0]));
  return only("_-.+");
}

}  // namespace

void Document::check_renamable(const lang::LabelUse& use) const {
  const std::string text = label_text(use);
  if (use.computed) throw Refused{fmt::format("{} is a computed label: change what it is computed from", text)};
  for (const Module& module : modules_)
    for (const lang::LabelUse& other : module.uses)
      if (use.scope == 0 && other.definition && other.same_label(use))
        throw Refused{fmt::format("{} is defined in '{}', which other programs may read", text, module.source.name())};
  if (!lang::definition_of(uses_, use))
    throw Refused{fmt::format("{} has no definition of its own in this program", text)};
}

void Document::check_new_name(const lang::LabelUse& use, const std::string& name) const {
  if (!is_name(use.kind, name)) throw Refused{fmt::format("'{}' cannot be the name of {}", name, label_text(use))};
  const std::string key = upper(name);
  if (key == upper(use.name)) return;
  if (use.kind.empty() && (lang::minor_words().contains(key) || lang::find_intrinsic(key)))
    throw Refused{fmt::format("{} is a word of the language", key)};
  const auto refuse_used = [&](const std::vector<lang::LabelUse>& uses) {
    for (const lang::LabelUse& other : uses)
      if (other.kind == use.kind && !other.computed && upper(other.name) == key)
        throw Refused{fmt::format("there is a {} already", label_text(other))};
  };
  refuse_used(uses_);
  for (const Module& module : modules_) refuse_used(module.uses);
}

void Document::check_meaning(const std::vector<Span>& places, const std::string& name) const {
  std::string text(source_.text());
  for (auto place = places.rbegin(); place != places.rend(); ++place)
    text.replace(place->begin, place->end - place->begin, name);
  Sink sink;
  const SourceFile renamed(source_.name(), std::move(text));
  const lang::Compilation compilation = lang::compile(renamed, sink);
  // A better name may take messages away, of a label that was too long.
  std::map<Code, int> known;
  for (const Diagnostic& d : messages_) ++known[d.code];
  for (const Diagnostic& d : sink.sorted())
    if (known[d.code]-- <= 0)
      throw Refused{fmt::format("the program would not mean the same: line {}: {}", d.place.line, d.message)};
  if (compilation.plan.operations.size() != compilation_.plan.operations.size())
    throw Refused{"the program would not mean the same"};
}

json Document::prepare_rename(std::uint32_t offset) const {
  const lang::LabelUse* use = use_at(offset);
  if (!use) return nullptr;
  check_renamable(*use);
  return {{"range", range(source_, use->name_span)}, {"placeholder", use->name}};
}

json Document::rename(std::uint32_t offset, const std::string& name) const {
  const lang::LabelUse* use = use_at(offset);
  if (!use) throw Refused{"no name stands here"};
  check_renamable(*use);
  check_new_name(*use, name);
  std::vector<Span> places;
  for (const lang::LabelUse& other : uses_)
    if (other.same_label(*use)) places.push_back(other.name_span);
  check_meaning(places, name);
  json edits = json::array();
  for (const Span place : places) edits.push_back({{"range", range(source_, place)}, {"newText", name}});
  return {{"changes", {{uri_, edits}}}};
}

}  // namespace abbe::lsp
