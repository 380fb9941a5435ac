#include "engine/base/json_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/numbers.hpp"

namespace abbe {

namespace {

using Kind = JsonNode::Kind;

std::string_view word_for(Kind kind) {
  switch (kind) {
    case Kind::null: return "null";
    case Kind::boolean: return "true or false";
    case Kind::number: return "a number";
    case Kind::text: return "a text in double quotes";
    case Kind::array: return "a list [ ... ]";
    case Kind::object: return "an object { ... }";
  }
  return "";
}

std::string help_for(Kind wanted, const JsonNode& found) {
  const bool quoted = wanted == Kind::number && found.kind == Kind::text && finite_number(found.text);
  return quoted ? fmt::format("write {} without the quotes", found.text) : "";
}

}  // namespace

std::string JsonObject::path_to(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

const JsonNode* JsonObject::find(std::string_view key) const {
  if (!node_) return nullptr;
  for (const JsonNode::Member& member : node_->members)
    if (member.key == key) return &member.value;
  return nullptr;
}

bool JsonObject::check(const JsonNode& node, std::string_view key, Kind kind) {
  if (node.kind == kind) return true;
  reader_->report(
      node.span, Code::E0405,
      fmt::format("\"{}\" must be {}, but {} stands here", path_to(key), word_for(kind), word_for(node.kind)),
      help_for(kind, node));
  return false;
}

void JsonObject::offer(std::string_view key) {
  if (node_) reader_->asked_[node_].emplace_back(key);
}

const JsonNode* JsonObject::ask(std::string_view key, Kind kind) {
  if (!node_) return nullptr;
  offer(key);
  const JsonNode* value = find(key);
  return value && check(*value, key, kind) ? value : nullptr;
}

const JsonNode* JsonObject::require(std::string_view key, Kind kind) {
  const JsonNode* value = ask(key, kind);
  if (node_ && !find(key)) {
    const std::string where = path_.empty() ? "the file" : fmt::format("\"{}\"", path_);
    reader_->report({node_->span.begin, node_->span.begin + 1}, Code::E0404,
                    fmt::format("{} needs \"{}\", {}", where, key, word_for(kind)),
                    fmt::format("add \"{}\": ...", key));
  }
  return value;
}

double JsonObject::checked(const JsonNode& node, std::string_view key, const NumberRange& range) {
  // Squares of such numbers, and their quotients, stay finite.
  constexpr double kLargest = 1e12, kSmallest = 1e-12;
  const bool meant = std::abs(node.number) <= kLargest && (node.number >= kSmallest || range.holds(0));
  if (!range.holds(node.number))
    reader_->report(
        node.span, Code::E0406,
        fmt::format("\"{}\" is {}, but must be {}", path_to(key), reader_->source_.text(node.span), range.words));
  else if (!meant)
    reader_->report(node.span, Code::E0406,
                    fmt::format("\"{}\" is {}, but must be between {:g} and {:g} in size", path_to(key),
                                reader_->source_.text(node.span), kSmallest, kLargest));
  return node.number;
}

double JsonObject::number(std::string_view key, const NumberRange& range) {
  const JsonNode* value = require(key, Kind::number);
  return value ? checked(*value, key, range) : 0;
}

double JsonObject::number_or(std::string_view key, double otherwise, const NumberRange& range) {
  const JsonNode* value = ask(key, Kind::number);
  return value ? checked(*value, key, range) : otherwise;
}

int JsonObject::integer_or(std::string_view key, int otherwise, int low, int high) {
  const JsonNode* value = ask(key, Kind::number);
  if (!value) return otherwise;
  if (value->number == std::floor(value->number) && value->number >= low && value->number <= high)
    return static_cast<int>(value->number);
  reader_->report(value->span, Code::E0406,
                  fmt::format("\"{}\" is {}, but must be a whole number from {} to {}", path_to(key),
                              reader_->source_.text(value->span), low, high));
  return otherwise;
}

std::string JsonObject::text(std::string_view key) {
  const JsonNode* value = require(key, Kind::text);
  if (value && value->text.empty())
    fault(key, Code::E0406, fmt::format("\"{}\" is empty", path_to(key)), "write something between the quotes");
  return value ? value->text : "";
}

std::string JsonObject::text_or(std::string_view key, std::string otherwise) {
  const JsonNode* value = ask(key, Kind::text);
  return value ? value->text : otherwise;
}

bool JsonObject::flag_or(std::string_view key, bool otherwise) {
  const JsonNode* value = ask(key, Kind::boolean);
  return value ? value->number != 0 : otherwise;
}

std::vector<double> JsonObject::numbers_of(const JsonNode& list, std::string_view key, const NumberRange& range) {
  std::vector<double> out;
  for (const JsonNode& item : list.items)
    if (check(item, key, Kind::number)) out.push_back(checked(item, key, range));
  return out;
}

std::vector<double> JsonObject::number_list(std::string_view key, const NumberRange& range) {
  const JsonNode* list = ask(key, Kind::array);
  return list ? numbers_of(*list, key, range) : std::vector<double>{};
}

std::vector<std::vector<double>> JsonObject::number_lists(std::string_view key, const NumberRange& range) {
  std::vector<std::vector<double>> out;
  if (const JsonNode* lists = ask(key, Kind::array)) {
    for (const JsonNode& list : lists->items)
      if (check(list, key, Kind::array)) out.push_back(numbers_of(list, key, range));
  }
  return out;
}

std::vector<double> JsonObject::numbers_or(std::string_view key, std::vector<double> otherwise, std::size_t size,
                                           const NumberRange& range) {
  const JsonNode* list = ask(key, Kind::array);
  if (!list) return otherwise;
  if (list->items.size() != size) {
    reader_->report(list->span, Code::E0406,
                    fmt::format("\"{}\" has {} elements, but must have {}", path_to(key), list->items.size(), size));
    return otherwise;
  }
  std::vector<double> out = number_list(key, range);
  return out.size() == size ? out : otherwise;
}

std::vector<std::string> JsonObject::text_list_or(std::string_view key, std::vector<std::string> otherwise) {
  const JsonNode* list = ask(key, Kind::array);
  if (!list) return otherwise;
  std::vector<std::string> out;
  for (const JsonNode& item : list->items)
    if (check(item, key, Kind::text)) out.push_back(item.text);
  return out;
}

JsonObject JsonObject::object(std::string_view key) { return {reader_, require(key, Kind::object), path_to(key)}; }

JsonObject JsonObject::object_or_absent(std::string_view key) {
  return {reader_, ask(key, Kind::object), path_to(key)};
}

std::vector<JsonObject> JsonObject::object_list(std::string_view key) {
  std::vector<JsonObject> out;
  if (const JsonNode* list = ask(key, Kind::array)) {
    for (std::size_t i = 0; i < list->items.size(); ++i)
      if (check(list->items[i], key, Kind::object))
        out.push_back({reader_, &list->items[i], fmt::format("{}[{}]", path_to(key), i)});
  }
  return out;
}

std::vector<std::string> JsonObject::own_names() const {
  std::vector<std::string> out;
  if (node_)
    for (const JsonNode::Member& member : node_->members) out.push_back(member.key);
  return out;
}

Kind JsonObject::kind_of(std::string_view key) const {
  const JsonNode* value = find(key);
  return value ? value->kind : Kind::null;
}

Span JsonObject::span_of(std::string_view key) const {
  const JsonNode* value = find(key);
  return value ? value->span : node_ ? Span{node_->span.begin, node_->span.begin + 1} : Span{};
}

void JsonObject::fault(std::string_view key, Code code, std::string message, std::string help) {
  reader_->report(span_of(key), code, std::move(message), std::move(help));
}

void JsonObject::check_schema(std::string_view schema, std::string_view kind, std::string help) {
  const std::string found = text("schema");
  if (found.empty() || found == schema) return;
  throw UserError(diagnostic_at(reader_->source(), span_of("schema"), Code::E0407,
                                fmt::format("the schema is \"{}\", but {} has \"{}\"", found, kind, schema),
                                std::move(help)));
}

void JsonObject::one_of(std::string_view key, const std::string& value, const std::vector<std::string_view>& words) {
  if (std::find(words.begin(), words.end(), value) != words.end()) return;
  const std::string near = nearest_word(value, words);
  fault(key, Code::E0406,
        fmt::format("\"{}\" is \"{}\", but must be one of: {}", path_to(key), value, fmt::join(words, ", ")),
        near.empty() ? "" : fmt::format("did you mean \"{}\"?", near));
}

JsonReader::JsonReader(SourceFile source) : source_(std::move(source)), root_(parse_json(source_)) {
  if (root_.kind != Kind::object)
    throw UserError(diagnostic_at(source_, root_.span, Code::E0405,
                                  fmt::format("the file must be an object, but {} stands here", word_for(root_.kind))));
}

void JsonReader::report(Span span, Code code, std::string message, std::string help, std::string replacement) {
  sink_.add(diagnostic_at(source_, span, code, std::move(message), std::move(help), std::move(replacement)));
}

void JsonReader::report_unknown_keys(const JsonNode& node) {
  for (const JsonNode& item : node.items) report_unknown_keys(item);
  if (node.kind != Kind::object) return;
  const auto found = asked_.find(&node);
  if (found == asked_.end() && &node != &root_) return;  // its own key is unknown, or of the wrong kind: reported there
  std::vector<std::string_view> known;
  if (found != asked_.end()) known.assign(found->second.begin(), found->second.end());
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const JsonNode::Member& member : node.members) {
    if (std::find(known.begin(), known.end(), member.key) != known.end()) {
      report_unknown_keys(member.value);
      continue;
    }
    const std::string near = nearest_name(member.key, known);
    const bool slip =
        near == nearest_word(member.key, known);  // else a part is missing: what unit was meant is not known
    const bool another_unit = differ_in_unit(member.key, near);
    report(member.key_span, Code::E0402, fmt::format("unknown key \"{}\"", member.key),
           near.empty()       ? fmt::format("the keys here are: {}", fmt::join(known, ", "))
               : near == "u"  ? "\"u\" is a standard uncertainty: an expanded one divided by its k"
               : another_unit ? fmt::format("did you mean \"{}\"? That is another unit: convert the number", near)
                              : fmt::format("did you mean \"{}\"?", near),
           near.empty() || another_unit || !slip ? "" : fmt::format("\"{}\"", near));
  }
}

void JsonReader::finish() {
  report_unknown_keys(root_);
  if (sink_.has_errors()) throw UserError(sink_.sorted());
}

}  // namespace abbe
