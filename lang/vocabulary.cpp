#include "lang/vocabulary.hpp"

#include <algorithm>
#include <array>

#include "engine/features/construct.hpp"
#include "engine/features/feature.hpp"
#include "engine/tolerances/tolerance.hpp"
#include "lang/signature.hpp"

namespace abbe::lang {

namespace {

using Words = std::vector<std::string>;

void add_words(const Signature& signature, Words& out) {
  for (const SignatureItem& item : signature) {
    out.insert(out.end(), item.words.begin(), item.words.end());
    for (const Signature& branch : item.branches) add_words(branch, out);
  }
}

void add_words(std::string_view signature, Words& out) { add_words(parse_signature(signature), out); }

template <class Kinds>
void add_kinds(const Kinds& kinds, Words& out) {
  for (const auto* kind : kinds) out.emplace_back(kind->word);
}

/// Words for the places `kind:word`, `method:word` and `tolerance:word` of a signature, which registries fill.
void add_registered(const Statement& statement, Words& out) {
  const auto names = [&](std::string_view place) { return statement.signature.find(place) != std::string_view::npos; };
  if (names("kind:word")) add_kinds(feature_kinds(), out);
  if (names("method:word")) add_kinds(constructions(), out);
  if (names("tolerance:word")) add_kinds(tolerance_kinds(), out);
}

/// Words of the kind that an argument names.
void add_named(std::string_view statement, const RawArgument& argument, Words& out) {
  if (argument.kind != RawArgument::Kind::word) return;
  if (const FeatureKind* kind = find_feature_kind(argument.word); kind && statement == "FEAT")
    add_words(kind->signature, out);
  if (const ToleranceKind* kind = find_tolerance_kind(argument.word); kind && statement == "TOL")
    add_words(kind->signature, out);
  if (const Construction* method = find_construction(argument.word); method && statement == "CONST")
    add_words(method->signature, out);
}

Words sorted(Words words) {
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

}  // namespace

const std::set<std::string, std::less<>>& minor_words() {
  static const auto words = [] {
    Words all;
    for (const Statement* s : statements()) add_words(s->signature, all), add_registered(*s, all);
    for (const FeatureKind* kind : feature_kinds()) add_words(kind->signature, all);
    for (const ToleranceKind* kind : tolerance_kinds()) add_words(kind->signature, all);
    for (const Construction* method : constructions()) add_words(method->signature, all);
    return std::set<std::string, std::less<>>(all.begin(), all.end());
  }();
  return words;
}

std::vector<std::string_view> major_words() {
  std::vector<std::string_view> words(standard_words().begin(), standard_words().end());
  for (const Statement* s : statements()) words.push_back(s->word);
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

std::vector<std::string> argument_words(std::string_view word, std::span<const RawArgument> written) {
  const Statement* statement = find_statement(word);
  if (!statement) return {};
  Words out;
  add_words(statement->signature, out);
  add_registered(*statement, out);
  for (const RawArgument& argument : written) add_named(word, argument, out);
  return sorted(std::move(out));
}

std::span<const LabelKind> label_kinds() {
  static constexpr std::array kinds = {LabelKind{"F", "nominal of a feature"},
                                       LabelKind{"FA", "actual of a feature"},
                                       LabelKind{"T", "tolerance"},
                                       LabelKind{"TA", "tolerance, evaluated"},
                                       LabelKind{"D", "coordinate system"},
                                       LabelKind{"DA", "coordinate system, actual"},
                                       LabelKind{"S", "sensor"},
                                       LabelKind{"SA", "sensor, qualified"},
                                       LabelKind{"DAT", "datum"},
                                       LabelKind{"M", "macro"},
                                       LabelKind{"V", "form of a report"},
                                       LabelKind{"P", "path"},
                                       LabelKind{"G", "geometry of a CAD model"},
                                       LabelKind{"DID", "device"},
                                       LabelKind{"DV", "decimal places"},
                                       LabelKind{"R", "report"}};
  return kinds;
}

std::string_view shared_kind(std::string_view kind) {
  for (const std::string_view pair : {"FA", "TA", "DA", "SA"})
    if (kind == pair) return pair.substr(0, 1);
  return kind;
}

}  // namespace abbe::lang
