#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "engine/base/json_reader.hpp"
#include "engine/base/utf8.hpp"

namespace abbe {

namespace {

constexpr std::size_t kDeepest = 64;

// nlohmann's parser tells what it read, not where. The tree builder follows in the text: between
// two tokens stand only white space, commas and colons, so each token begins where the last one
// ended and those are skipped.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit TreeBuilder(const SourceFile& source) : source_(source), text_(source.text()) {
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }

  bool null() override { return scalar(JsonNode::Kind::null, 4); }
  bool boolean(bool value) override { return scalar(JsonNode::Kind::boolean, value ? 4 : 5, value ? 1 : 0); }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    JsonNode& node = place();
    node.kind = JsonNode::Kind::text;
    node.span = string_token();
    node.text = value;
    return true;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonNode::Kind::object); }
  bool start_array(std::size_t) override { return open(JsonNode::Kind::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    auto& members = open_.back()->members;
    const Span span = string_token();
    const auto same = [&](const JsonNode::Member& m) { return m.key == name; };
    if (const auto first = std::find_if(members.begin(), members.end(), same); first != members.end()) {
      fail(span, Code::E0403,
           fmt::format("the key \"{}\" stands twice in this object, first in line {}", name,
                       source_.place(first->key_span.begin).line),
           "keep one of the two");
    }
    members.push_back({name, span, {}});
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    const auto offset = static_cast<std::uint32_t>(std::min(position ? position - 1 : 0, text_.size()));
    constexpr int kOverflow = 406;  // of nlohmann's exceptions
    if (error.id == kOverflow)
      fail({offset, offset + 1}, Code::E0406, "this number is too large",
           "numbers in JSON files are at most 1e12 in size");
    if (const std::size_t foreign = first_foreign(text_); foreign < text_.size() && foreign <= offset) {
      const auto at = static_cast<std::uint32_t>(foreign);
      fail({at, at + 1}, Code::E0401, "this is not JSON: a character that is no UTF-8", "save the file as UTF-8");
    }
    std::string what = error.what();
    if (const auto cut = what.find("column"); cut != std::string::npos) what.erase(0, what.find(": ", cut) + 2);
    fail({offset, offset + 1}, Code::E0401, "this is not JSON: " + what,
         "JSON has double quotes around keys and texts, commas between members, none after the "
         "last, no comments, and no number that is not finite (NaN)");
  }

  /// The parser takes it for the end of the file, and would not read what follows.
  void refuse_nul() const {
    const auto at = static_cast<std::uint32_t>(std::min(text_.find('\0'), text_.size()));
    if (at < text_.size())
      fail({at, at + 1}, Code::E0401, "this is not JSON: a NUL character", "write the file as text, in UTF-8");
  }

  JsonNode root;

 private:
  [[noreturn]] void fail(Span span, Code code, std::string message, std::string help) const {
    throw UserError(diagnostic_at(source_, span, code, std::move(message), std::move(help)));
  }

  JsonNode& place() {
    if (open_.empty()) return root;
    JsonNode& parent = *open_.back();
    return parent.kind == JsonNode::Kind::object ? parent.members.back().value : parent.items.emplace_back();
  }
  std::uint32_t skip() {
    while (at_ < text_.size() && std::strchr(" \t\r\n,:", text_[at_])) ++at_;
    return static_cast<std::uint32_t>(at_);
  }
  Span token(std::size_t length) {
    const std::uint32_t begin = skip();
    at_ += length;
    return {begin, static_cast<std::uint32_t>(at_)};
  }
  Span string_token() {
    const std::uint32_t begin = skip();
    for (++at_; text_[at_] != '"'; ++at_) at_ += text_[at_] == '\\';
    return {begin, static_cast<std::uint32_t>(++at_)};
  }
  bool scalar(JsonNode::Kind kind, std::size_t length, double value = 0) {
    JsonNode& node = place();
    node.kind = kind;
    node.span = token(length);
    node.number = value;
    return true;
  }
  bool number(double value) {
    const std::uint32_t begin = skip();
    const std::size_t end = std::min(text_.find_first_not_of("0123456789+-.eE", begin), text_.size());
    JsonNode& node = place();
    node.kind = JsonNode::Kind::number;
    node.span = token(end - begin);
    node.number = value;
    return true;
  }
  bool open(JsonNode::Kind kind) {
    const Span bracket = token(1);
    if (open_.size() == kDeepest)
      fail(bracket, Code::E0401, fmt::format("objects and lists are nested more than {} deep", kDeepest),
           "no file of this program needs that");
    JsonNode& node = place();
    node.kind = kind;
    node.span = bracket;
    open_.push_back(&node);
    return true;
  }
  bool close() {
    open_.back()->span.end = token(1).end;
    open_.pop_back();
    return true;
  }

  const SourceFile& source_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<JsonNode*> open_;  ///< the objects and lists around the next token; none moves while it is open
};

}  // namespace

JsonNode parse_json(const SourceFile& source) {
  TreeBuilder builder(source);
  builder.refuse_nul();
  nlohmann::json::sax_parse(source.text(), &builder);
  return std::move(builder.root);
}

}  // namespace abbe
