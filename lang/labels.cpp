#include "lang/labels.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "lang/directives.hpp"
#include "lang/intrinsics.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "lang/vocabulary.hpp"

namespace abbe::lang {

namespace {

using ArgumentOf = RawArgument::Kind;

bool part_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool is_label_kind(std::string_view word) {
  const auto kinds = label_kinds();
  return std::any_of(kinds.begin(), kinds.end(), [&](const LabelKind& k) { return k.kind == word; });
}

/// X of `X [3]`.
std::string_view without_index(std::string_view text) { return text.substr(0, text.find_first_of(" \t[(")); }

/// The first argument of a DECL that is a variable: what comes before says where it holds, its type and the length of
/// a text.
std::size_t first_variable(const RawStatement& raw) {
  const std::vector<RawArgument>& a = raw.arguments;
  const auto is_word = [&](std::size_t k, std::initializer_list<std::string_view> words) {
    return k < a.size() && std::find(words.begin(), words.end(), a[k].word) != words.end();
  };
  const std::size_t type = is_word(0, {"GLOBAL", "COMMON", "LOCAL"}) ? 1 : 0;
  const bool length = is_word(type, {"CHAR"}) && type + 1 < a.size() && a[type + 1].kind == ArgumentOf::number;
  return type + (length ? 2 : 1);
}

/// Whether an argument is a variable that the statement declares or gives a value.
bool sets_variable(const RawStatement& raw, std::size_t k) {
  return (raw.word == "DECL" && k >= first_variable(raw)) || (raw.word == "DO" && k == 0);
}

/// What has names of its own: the program, or a macro.
struct Scope {
  int around = -1;
  std::set<std::string> arguments;  ///< of the macro, upper case; in quotes as MACRO has them
  std::set<std::string> variables;  ///< upper case
};

class Collector {
 public:
  explicit Collector(const SourceFile& source) : source_(source) {}

  std::vector<LabelUse> run() {
    read();
    for (const bool in_macro : {false, true})
      for (const Read& r : statements_)
        if ((r.scope > 0) == in_macro) set_variables(r);
    for (const Read& r : statements_) one(r);
    for (const auto& [label, directive] : in_directives_)
      if (!label.kind.empty() || scope_of(label.name, 0)) add_in_directive(label, directive);
    std::stable_sort(uses_.begin(), uses_.end(),
                     [](const LabelUse& a, const LabelUse& b) { return a.span.begin < b.span.begin; });
    return std::move(uses_);
  }

 private:
  struct Read {
    RawStatement raw;
    int scope = 0;   ///< in which it stands
    int behind = 0;  ///< in which its arguments stand, if it is a MACRO
  };

  Scope& scope(int k) { return scopes_[static_cast<std::size_t>(k)]; }

  void read() {
    Sink ignored;
    int at = 0;
    for (const LogicalLine& line : logical_lines(source_)) {
      for (LabelRef& label : directive_labels(line))
        in_directives_.push_back({std::move(label), line.comment->span(0, line.comment->text().size())});
      std::optional<RawStatement> raw = parse_statement(line, source_, ignored);
      if (!raw) continue;
      if (raw->word == "ENDMAC" && at > 0) at = scope(at).around;
      const bool global = raw->word == "DECL" && !raw->arguments.empty() &&
          (raw->arguments[0].word == "GLOBAL" || raw->arguments[0].word == "COMMON");
      for (std::size_t k = 0; raw->word == "DECL" && k < raw->arguments.size(); ++k)
        if (sets_variable(*raw, k))
          scope(global ? 0 : at).variables.insert(upper(without_index(raw->arguments[k].text)));
      const int around = at;
      if (raw->word == "MACRO") {
        Scope macro{around, {}, {}};
        for (const RawArgument& a : raw->arguments)
          macro.arguments.insert(upper(a.kind == ArgumentOf::text ? "'" + a.text + "'" : a.text));
        at = static_cast<int>(scopes_.size());
        scopes_.push_back(std::move(macro));
      }
      statements_.push_back({std::move(*raw), around, at});
    }
  }

  /// Variables that are given a value without being declared.
  void set_variables(const Read& r) {
    const auto set = [&](std::string_view written) {
      const std::string name = upper(without_index(written));
      if (!scope_of(name, r.scope)) scope(r.scope).variables.insert(name);
    };
    if (r.raw.label && r.raw.label->kind.empty()) set(r.raw.label->name);
    if (r.raw.word == "DO" && !r.raw.arguments.empty()) set(r.raw.arguments[0].text);
  }

  /// In which of the scopes from `at` outwards a name is a variable or an argument.
  std::optional<int> scope_of(std::string_view name, int at, bool only_arguments = false) {
    for (const std::string key = upper(name); at >= 0; at = scope(at).around)
      if (scope(at).arguments.count(key) || (!only_arguments && scope(at).variables.count(key))) return at;
    return std::nullopt;
  }

  void one(const Read& r) {
    raw_ = &r.raw;
    scope_ = r.scope;
    const std::string& code = raw_->code->text();
    if (raw_->target) return label(kJumpTarget, code.find('('), code.find('('), code.rfind(')'), true);
    if (raw_->label) {
      const std::size_t begin = code.find_first_not_of(" \t"), equals = code.find('=');
      if (raw_->label->kind.empty())
        variable(begin, equals);
      else if (const std::size_t open = code.find('('); open != std::string::npos)
        label(raw_->label->kind, begin, open, code.find(')', open), true);
    }
    for (std::size_t k = 0; k < raw_->arguments.size(); ++k) argument(r, k);
  }

  void argument(const Read& r, std::size_t k) {
    const RawArgument& a = raw_->arguments[k];
    if (raw_->word == "MACRO") {
      const bool quoted = a.kind == ArgumentOf::text;
      const std::string kind(quoted ? kQuotedArgument : "");
      if (quoted || a.kind == ArgumentOf::word)
        add({kind, "", a.span, {}, {}, true, false, r.behind}, {a.begin + quoted, a.end - quoted});
    } else if (raw_->word == "JUMPTO") {
      if (a.text.starts_with('(') && a.text.ends_with(')')) label(kJumpTarget, a.begin, a.begin, a.end - 1, false);
    } else if (sets_variable(*raw_, k)) {
      variable(a.begin, a.end);
    } else if (a.kind != ArgumentOf::word || !is_word(a)) {
      scan(a.begin, a.end, raw_->word == "DATDEF" && a.label.kind == "DAT");
    }
  }

  /// Whether the statement knows this word, so that no variable is meant.
  bool is_word(const RawArgument& a) {
    if (!scope_of(a.word, scope_)) return true;
    if (scope_of(a.word, scope_, true)) return false;
    const std::vector<std::string> words = argument_words(raw_->word, raw_->arguments);
    return std::find(words.begin(), words.end(), a.word) != words.end();
  }

  struct Range {
    std::size_t begin = 0, end = 0;  ///< in the code of the statement
  };

  /// A variable that is given a value, perhaps an element of it.
  void variable(std::size_t begin, std::size_t end) {
    const std::string_view text = std::string_view(raw_->code->text()).substr(begin, end - begin);
    const std::size_t length = without_index(text).size();
    const auto scope = scope_of(text.substr(0, length), scope_);
    if (!scope) return;
    const Range name{begin, begin + length};
    add({"", "", span(name), {}, {}, true, false, *scope}, name);
    scan(name.end, end, false);
  }

  /// Labels, variables and arguments of macros in an expression.
  void scan(std::size_t begin, std::size_t end, bool defines) {
    const std::string_view code = std::string_view(raw_->code->text()).substr(0, end);
    for (std::size_t at = begin; at < end;) {
      const std::size_t to = token_end(code, at);
      const std::size_t open = code.find_first_not_of(" \t", to);
      const bool called = open != std::string_view::npos && code[open] == '(';
      const std::size_t close = called ? code.find(')', open) : std::string_view::npos;
      const std::string word = upper(code.substr(at, to - at));
      const bool is_operator = at > 0 && code[at - 1] == '.' && to < end && code[to] == '.';
      if (part_of_name(code[at]) && close != std::string_view::npos && is_label_kind(word)) {
        label(word, at, open, close, defines);
        at = close + 1;
        continue;
      }
      if (!is_operator && !(called && find_intrinsic(word))) name(code, {at, to});
      at = to;
    }
  }

  /// A quoted text, a name, or one character.
  static std::size_t token_end(std::string_view code, std::size_t at) {
    std::size_t end = at + 1;
    if (code[at] == '\'') return std::min(code.find('\'', end), code.size() - 1) + 1;
    if (part_of_name(code[at]))
      while (end < code.size() && part_of_name(code[end])) ++end;
    return end;
  }

  /// A token, if it is a variable or an argument of a macro.
  void name(std::string_view code, Range r) {
    const bool quoted = code[r.begin] == '\'' && r.end > r.begin + 2;
    if (!quoted && (!part_of_name(code[r.begin]) || std::isdigit(static_cast<unsigned char>(code[r.begin])))) return;
    const auto scope = scope_of(code.substr(r.begin, r.end - r.begin), scope_);
    if (scope && quoted)
      add({std::string(kQuotedArgument), "", span(r), {}, {}, false, false, *scope}, {r.begin + 1, r.end - 1});
    else if (scope)
      add({"", "", span(r), {}, {}, false, false, *scope}, r);
  }

  /// KIND(...) or the target of a jump, and what its name is computed from: variables behind @, arguments of the macro.
  void label(std::string_view kind, std::size_t begin, std::size_t open, std::size_t close, bool defines) {
    const std::string_view code = std::string_view(raw_->code->text()).substr(0, close);
    bool computed = false;
    const std::size_t place = uses_.size();
    for (std::size_t at = open + 1; at < close;) {
      const bool holder = code[at] == '@' && at + 1 < close;
      if (holder) ++at;
      const std::size_t to = token_end(code, at);
      const bool argument = scope_of(code.substr(at, to - at), scope_, true).has_value();
      if (holder || argument) name(code, {at, to});
      computed = computed || holder || argument;
      at = to;
      if (!holder || at >= close || code[at] != '[') continue;
      const std::size_t bracket = std::min(code.find(']', at), close);
      scan(at, bracket, false);
      at = bracket;
    }
    add({std::string(shared_kind(kind)),
         "",
         span({begin, close + 1}),
         {},
         {},
         defines,
         computed,
         computed ? scope_ : 0},
        {open + 1, close});
    std::rotate(uses_.begin() + static_cast<std::ptrdiff_t>(place), uses_.end() - 1, uses_.end());
  }

  Span span(Range r) const { return raw_->code->span(r.begin, r.end); }

  /// `name`: where the name of `use` stands, perhaps between blanks.
  void add(LabelUse use, Range name) {
    const std::string& code = raw_->code->text();
    while (name.begin < name.end && (code[name.begin] == ' ' || code[name.begin] == '\t')) ++name.begin;
    while (name.end > name.begin && (code[name.end - 1] == ' ' || code[name.end - 1] == '\t')) --name.end;
    use.name = code.substr(name.begin, name.end - name.begin);
    use.name_span = span(name);
    use.statement = raw_->span;
    uses_.push_back(std::move(use));
  }

  void add_in_directive(const LabelRef& label, Span directive) {
    Span name = label.span;
    if (!label.kind.empty()) {
      name.begin += static_cast<std::uint32_t>(source_.text(label.span).find('(') + 1);
      name.end -= 1;
    }
    uses_.push_back({std::string(shared_kind(label.kind)), label.name, label.span, name, directive});
  }

  const SourceFile& source_;
  std::vector<Scope> scopes_ = std::vector<Scope>(1);  ///< the program first
  std::vector<Read> statements_;
  std::vector<std::pair<LabelRef, Span>> in_directives_;
  std::vector<LabelUse> uses_;
  const RawStatement* raw_ = nullptr;
  int scope_ = 0;
};

}  // namespace

bool LabelUse::same_label(const LabelUse& other) const {
  return kind == other.kind && computed == other.computed && scope == other.scope && upper(name) == upper(other.name);
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
