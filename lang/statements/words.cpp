#include "lang/statements/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include "engine/features/feature.hpp"

namespace abbe::lang {

std::vector<std::string_view> feature_words() {
  std::vector<std::string_view> words;
  for (const FeatureKind* kind : feature_kinds()) words.push_back(kind->word);
  return words;
}

namespace {

/// Kinds of features, tolerances and constructions of ISO 22093 that Abbe does not have.
bool is_standard_kind(std::string_view statement, std::string_view word) {
  static const std::map<std::string_view, std::set<std::string_view>> kinds{
      {"FEAT",
       {"COMPOUND", "CONRADSEGMNT", "CYLRADSEGMNT", "ELONGCYL", "GCURVE", "GEOM", "OBJECT", "PATERN", "REVSURF",
        "SPHRADSEGMNT", "TORRADSEGMNT"}},
      {"TOL", {"COMPOS", "CPROFL", "CPROFS", "GTOL", "USETOL"}},
      {"CONST", {"BUILD", "CURVE", "GEOM", "NEARPT", "PIERCE", "PROJCT", "PTDATA", "RETRIEVE", "SPHERE", "TRMATX"}}};
  const auto found = kinds.find(statement);
  return found != kinds.end() && found->second.contains(word);
}

}  // namespace

void unknown_kind(Lowering& lowering, const MatchedValue& written, std::string_view what, std::string_view role,
                  const std::vector<std::string_view>& known) {
  if (is_standard_kind(what, written.text))
    return lowering.error(Code::E0112, written.span, fmt::format("the {} {} is not supported yet", role, written.text),
                          fmt::format("supported: {}; what needs it is lost with --only-valid", fmt::join(known, " ")));
  const std::string near = nearest_word(written.text, known);
  lowering.error(Code::E0112, written.span, fmt::format("'{}' is not a {} that {} knows", written.text, role, what),
                 near.empty() ? fmt::format("known: {}", fmt::join(known, " ")) : fmt::format("did you mean {}?", near),
                 near);
}

void check_kind(Lowering& lowering, const MatchedValue& written, plan::FeatureId feature) {
  const plan::FeatureDef& def = lowering.out.plan[feature];
  if (written.text == def.kind->word) return;
  if (!find_feature_kind(written.text))
    return unknown_kind(lowering, written, lowering.statement->word, "kind of feature", feature_words());
  lowering.warn(Code::W0222, written.span,
                fmt::format("F({}) was defined as {}, here it is called {}", def.label, def.kind->word, written.text),
                "the definition holds", std::string(def.kind->word));
}

}  // namespace abbe::lang
