#include "lang/statements/words.hpp"

#include <fmt/format.h>

#include "engine/features/feature.hpp"

namespace abbe::lang {

std::vector<std::string_view> feature_words() {
  std::vector<std::string_view> words;
  for (const FeatureKind* kind : feature_kinds()) words.push_back(kind->word);
  return words;
}

void unknown_kind(Lowering& lowering, const MatchedValue& written, std::string_view what,
                  std::string_view role, const std::vector<std::string_view>& known) {
  const std::string near = nearest_word(written.text, known);
  lowering.error(Code::E0112, written.span,
                 fmt::format("'{}' is not a {} that {} knows", written.text, role, what),
                 near.empty() ? fmt::format("known: {}", fmt::join(known, " "))
                              : fmt::format("did you mean {}?", near),
                 near);
}

void check_kind(Lowering& lowering, const MatchedValue& written, plan::FeatureId feature) {
  const plan::FeatureDef& def = lowering.out.plan[feature];
  if (written.text == def.kind->word) return;
  if (!find_feature_kind(written.text))
    return unknown_kind(lowering, written, lowering.statement->word, "kind of feature",
                        feature_words());
  lowering.warn(Code::W0222, written.span,
                fmt::format("F({}) was defined as {}, here it is called {}", def.label,
                            def.kind->word, written.text),
                "the definition holds", std::string(def.kind->word));
}

}  // namespace abbe::lang
