// GEOALG: by which criterion the features of a kind are fitted from here on (engine/features/criterion.hpp).
// It holds for measured features; CONST/..,BF is least squares always. The form tolerances take their
// value about the element of the criterion in force.
#include <fmt/format.h>

#include "engine/features/feature.hpp"
#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

FitCriterion criterion_of(std::string_view word) {
  return word == "MINMAX" ? FitCriterion::minimum_zone
      : word == "MAXINS"  ? FitCriterion::maximum_inscribed
      : word == "MINCIR"  ? FitCriterion::minimum_circumscribed
                          : FitCriterion::least_squares;
}

void choose_criterion(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const MatchedValue &word = *match.find("kind"), &method = *match.find("method");
  const FitCriterion criterion = criterion_of(method.text);
  if (word.text == "ALL") {  // every kind that can be fitted so
    for (const FeatureKind* kind : feature_kinds())
      if (!criterion_refusal(*kind, criterion)) lowering.criteria[kind->shape].set(criterion);
    return;
  }
  const FeatureKind* kind = find_feature_kind(word.text);
  if (!kind) return unknown_kind(lowering, word, raw.word, "kind of feature", feature_words());
  if (const char* reason = criterion_refusal(*kind, criterion))
    return lowering.error(Code::E0250, method.span,
                          fmt::format("a {} cannot be fitted by {}: {}", kind->word, method.text, reason),
                          fmt::format("write GEOALG/{},LSTSQR", kind->word), "LSTSQR");
  lowering.criteria[kind->shape].set(criterion);
}

}  // namespace

extern const Statement kGeoalg;

const Statement kGeoalg = {
    .word = "GEOALG",
    .signature = "kind:word, method:LSTSQR|MINMAX|MAXINS|MINCIR|DEFALT",
    .help =
        "How features of a kind, or ALL that can be, are fitted from here on: least squares (also DEFALT), "
        "minimum zone (MINMAX), maximum inscribed (MAXINS), minimum circumscribed (MINCIR). Form "
        "tolerances are taken about that element.",
    .example = "GEOALG/CIRCLE,MAXINS",
    .source = "ISO 22093, GEOALG; ISO 12181-1, ISO 14405-1",
    .lower = choose_criterion,
    .doubt = Doubt::one_setting,
};

}  // namespace abbe::lang
