// FEAT and CONST. Which arguments a kind of feature or a construction takes is said by the engine's
// registries.
#include <fmt/format.h>

#include "engine/features/construct.hpp"
#include "engine/features/feature.hpp"
#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

void define_feature(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const MatchedValue& word = *match.find("kind");
  const FeatureKind* kind = find_feature_kind(word.text);
  if (!kind) return unknown_kind(lowering, word, "FEAT", "kind of feature", feature_words());
  const std::optional<Match> rest =
      lowering.match(kind->signature, raw, fmt::format("FEAT/{}", kind->word), match.used, Varying::taken);
  const std::optional<Arguments> arguments = rest ? lowering.arguments(*rest) : std::nullopt;
  if (!arguments) return;
  std::vector<plan::VaryingNumber> varying = Lowering::varying(*rest);
  const Outcome<Element> nominal = varying.empty() ? kind->nominal(*arguments) : Outcome<Element>{};
  if (!nominal)
    return lowering.error(Code::E0208, raw.span, fmt::format("this {} cannot be: {}", kind->word, nominal.failure),
                          fmt::format("a correct one: {}", kind->example));
  lowering.define(raw,
                  {raw.label->name, kind, nominal.value, arguments->text("side") == "INNER",
                   varying.empty() ? Arguments{} : *arguments, std::move(varying)},
                  *rest);
}

std::vector<std::string_view> method_words() {
  std::vector<std::string_view> words;
  for (const Construction* method : constructions()) words.push_back(method->word);
  return words;
}

/// Whether the method makes this kind of feature of those kinds; reports why not.
bool can_be_made(Lowering& lowering, const RawStatement& raw, plan::FeatureId result, const Construction& method,
                 const Arguments& arguments) {
  const auto shape = [&](plan::FeatureId id) { return lowering.out.plan[id].kind->acts_as; };
  std::vector<Shape> from;
  for (const int id : arguments.features("from")) from.push_back(shape({id}));
  const char* reason = method.applies(shape(result), from);
  if (reason)
    lowering.error(Code::E0259, raw.span, fmt::format("this construction cannot be: {}", reason),
                   fmt::format("`abbe explain {}` says what it makes of what", method.word));
  return !reason;
}

void construct(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const std::optional<plan::FeatureId> result = lowering.defined_feature(match.find("feature")->label);
  if (result) check_kind(lowering, *match.find("kind"), *result);
  const MatchedValue& word = *match.find("method");
  const Construction* method = find_construction(word.text);
  if (!method) return unknown_kind(lowering, word, "CONST", "construction", method_words());
  const std::optional<Match> rest =
      lowering.match(method->signature, raw, fmt::format("CONST/...,{}", method->word), match.used, Varying::taken);
  const std::optional<Arguments> arguments = rest ? lowering.arguments(*rest) : std::nullopt;
  if (arguments && result && can_be_made(lowering, raw, *result, *method, *arguments)) {
    plan::Construct operation{*result, method, {}, *arguments, Lowering::varying(*rest)};
    for (const int id : arguments->features("from")) operation.from.push_back(plan::FeatureId{id});
    lowering.emit(std::move(operation));
    lowering.actuals.set(result->value, {true, ""});
  } else if (result) {
    lowering.actuals.set(result->value, {false, lowering.blame()});
  }
}

}  // namespace

extern const Statement kFeat, kConst;

const Statement kFeat = {
    .word = "FEAT",
    .label = "F",
    .signature = "kind:word, ...",
    .help = "Defines the nominal of a feature in the current coordinate system.",
    .example = "F(BORE)=FEAT/CIRCLE,INNER,CART,50,50,40,0,0,1,50",
    .source = "ISO 22093, FEAT",
    .lower = define_feature,
};
const Statement kConst = {
    .word = "CONST",
    .signature = "kind:word, feature:feature, method:word, ...",
    .help = "Constructs the feature F(l), defined before, from other features.",
    .example = "CONST/LINE,F(EDGE),INTOF,FA(TOP),FA(FRONT)",
    .source = "ISO 22093, CONST",
    .lower = construct,
    .doubt = Doubt::construction,
};

}  // namespace abbe::lang
