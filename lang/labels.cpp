#include "lang/labels.hpp"

#include <algorithm>
#include <set>

#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "lang/vocabulary.hpp"

namespace abbe::lang {

namespace {

bool part_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool is_label_kind(std::string_view word) {
  const auto kinds = label_kinds();
  return std::any_of(kinds.begin(), kinds.end(), [&](const LabelKind& k) { return k.kind == word; });
}

class Collector {
 public:
  explicit Collector(const SourceFile& source) : source_(source) {}

  std::vector<LabelUse> run() {
    Sink ignored;
    for (const LogicalLine& line : logical_lines(source_))
      if (const auto raw = parse_statement(line, source_, ignored)) one(*raw);
    // A word is a variable when the program declares or assigns one of that name.
    std::erase_if(uses_, [&](const LabelUse& use) { return use.kind.empty() && !variables_.count(upper(use.name)); });
    std::stable_sort(uses_.begin(), uses_.end(),
                     [](const LabelUse& a, const LabelUse& b) { return a.span.begin < b.span.begin; });
    return std::move(uses_);
  }

 private:
  void one(const RawStatement& raw) {
    if (raw.target) return add(raw, "", raw.target->name, raw.target->span, true);
    if (raw.label) add(raw, raw.label->kind, raw.label->name, raw.label->span, true);
    for (const RawArgument& argument : raw.arguments) {
      if (argument.kind == RawArgument::Kind::text) continue;
      const bool declares = raw.word == "DECL" || (raw.word == "DATDEF" && argument.label.kind == "DAT");
      scan(raw, argument.span, declares);
    }
  }

  /// Labels and words in the text of an argument, which may be an expression.
  void scan(const RawStatement& raw, Span span, bool declares) {
    const std::string_view text = source_.text(span);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\'') {
        i = std::min(text.find('\'', i + 1), text.size() - 1);
        continue;
      }
      if (!part_of_name(text[i])) continue;
      std::size_t end = i;
      while (end < text.size() && part_of_name(text[end])) ++end;
      const std::size_t close = text.find(')', end);
      const std::string word = upper(text.substr(i, end - i));
      const auto place = [&](std::size_t from, std::size_t to) {
        return Span{span.begin + static_cast<std::uint32_t>(from), span.begin + static_cast<std::uint32_t>(to)};
      };
      if (end < text.size() && text[end] == '(' && is_label_kind(word) && close != std::string_view::npos) {
        add(raw, word, std::string(text.substr(end + 1, close - end - 1)), place(i, close + 1), declares);
        i = close;
      } else {
        add(raw, "", std::string(text.substr(i, end - i)), place(i, end), declares);
        i = end - 1;
      }
    }
  }

  void add(const RawStatement& raw, std::string_view kind, std::string name, Span span, bool definition) {
    if (kind.empty() && definition) variables_.insert(upper(name));
    uses_.push_back({std::string(shared_kind(kind)), std::move(name), span, raw.span, definition});
  }

  const SourceFile& source_;
  std::vector<LabelUse> uses_;
  std::set<std::string> variables_;
};

}  // namespace

bool LabelUse::same_label(const LabelUse& other) const {
  return kind == other.kind && upper(name) == upper(other.name);
}

std::vector<LabelUse> label_uses(const SourceFile& source) { return Collector(source).run(); }

const LabelUse* definition_of(const std::vector<LabelUse>& uses, const LabelUse& use) {
  const LabelUse* found = nullptr;
  for (const LabelUse& other : uses) {
    if (!other.definition || !other.same_label(use)) continue;
    if (found && other.span.begin > use.span.begin) break;
    found = &other;
  }
  return found;
}

}  // namespace abbe::lang
