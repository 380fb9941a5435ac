#include "programs/lsp/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lang/blocks.hpp"
#include "lang/format.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "lang/reference.hpp"
#include "programs/lsp/complete.hpp"
#include "programs/lsp/positions.hpp"

namespace abbe::lsp {

using nlohmann::json;

namespace {

/// Kinds of symbols in the outline (LSP 3.17, SymbolKind).
enum class Symbol {
  namespace_ = 3,
  method = 6,
  interface = 11,
  function = 12,
  variable = 13,
  constant = 14,
  object = 19,
  event = 24
};

Symbol symbol_of(std::string_view kind) {
  return kind == "F"                     ? Symbol::object
         : kind == "T"                   ? Symbol::constant
         : kind == "D" || kind == "DAT"  ? Symbol::namespace_
         : kind == "S"                   ? Symbol::interface
         : kind == "M"                   ? Symbol::function
                                         : Symbol::variable;
}

bool touches(Span a, Span b) { return a.begin <= b.end && b.begin <= a.end; }

/// The word around an offset: letters, digits and a sign before them.
std::string word_at(std::string_view text, std::size_t offset) {
  const auto part = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_');
  };
  std::size_t begin = offset, end = offset;
  while (begin > 0 && part(begin - 1)) --begin;
  while (part(end)) ++end;
  return std::string(text.substr(begin, end - begin));
}

json markdown(const std::string& text) {
  return {{"contents", {{"kind", "markdown"}, {"value", "```\n" + text + "\n```"}}}};
}

}  // namespace

std::string path_of(const std::string& uri) {
  constexpr std::string_view kScheme = "file://";
  if (!uri.starts_with(kScheme)) return uri;
  std::string path;
  for (std::size_t i = kScheme.size(); i < uri.size(); ++i) {
    unsigned value = 0;
    const char* const digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      path += static_cast<char>(value);
      i += 2;
    } else {
      path += uri[i];
    }
  }
  return path;
}

std::string uri_of(const std::string& path) {
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(path).generic_string())
    uri += std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/-._~").find(c) != std::string_view::npos
        ? std::string(1, c)
        : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

std::string label_text(const lang::LabelUse& use) {
  if (use.kind == lang::kJumpTarget) return fmt::format("({})", use.name);
  if (use.kind == lang::kQuotedArgument) return fmt::format("'{}'", use.name);
  return use.kind.empty() ? use.name : fmt::format("{}({})", use.kind, use.name);
}

Document::Document(std::string uri, std::string text) : uri_(std::move(uri)), source_(path_of(uri_), std::move(text)) {
  Sink sink;
  compilation_ = lang::compile(source_, sink);
  messages_ = sink.sorted();
  uses_ = lang::label_uses(source_);
  for (const std::string& path : compilation_.modules) {
    try {
      SourceFile module = read_source(path);
      std::vector<lang::LabelUse> uses = lang::label_uses(module);
      modules_.push_back({std::move(module), std::move(uses)});
    } catch (const UserError&) {  // it went while the program was compiled
    }
  }
}

json Document::location(const SourceFile& source, Span span) const {
  return {{"uri", &source == &source_ ? uri_ : uri_of(source.name())}, {"range", range(source, span)}};
}

bool Document::is_foreign(const Diagnostic& d) const { return !d.file.empty() && d.file != source_.name(); }

/// What is wrong in a module stands where the program calls it.
json Document::message(const Diagnostic& d) const {
  const int severity = d.severity() == Severity::error ? 1 : d.severity() == Severity::warning ? 2 : 3;
  const std::string text = d.help.empty() ? d.message : d.message + "\n" + d.help;
  json out = {{"range", range(source_, d.span.value_or(Span{}))},
              {"severity", severity},
              {"code", info(d.code).name},
              {"source", "abbe"},
              {"message", text}};
  if (!is_foreign(d)) return out;
  const auto call = compilation_.calls.find({d.file, d.span.value_or(Span{}).begin});
  out["range"] = range(source_, call == compilation_.calls.end() ? Span{} : call->second);
  out["message"] =
      fmt::format("{}, line {}: {}", std::filesystem::path(d.file).filename().string(), d.place.line, text);
  for (const Module& module : modules_)
    if (d.span && module.source.name() == d.file)
      out["relatedInformation"] = {{{"location", location(module.source, *d.span)}, {"message", d.message}}};
  return out;
}

json Document::diagnostics() const {
  json list = json::array();
  for (const Diagnostic& d : messages_) list.push_back(message(d));
  return list;
}

/// The innermost one: the variable in F(@NAME) rather than the label.
const lang::LabelUse* Document::use_at(std::uint32_t offset) const {
  const lang::LabelUse* found = nullptr;
  for (const lang::LabelUse& use : uses_)
    if (use.span.begin <= offset && offset <= use.span.end &&
        (!found || use.span.end - use.span.begin < found->span.end - found->span.begin))
      found = &use;
  return found;
}

std::optional<Document::Definition> Document::definition_of(const lang::LabelUse& use) const {
  if (const lang::LabelUse* found = lang::definition_of(uses_, use)) return Definition{&source_, found};
  for (const Module& module : modules_)
    if (use.scope == 0)
      if (const lang::LabelUse* found = lang::definition_of(module.uses, use)) return Definition{&module.source, found};
  return std::nullopt;
}

std::string Document::shown(const Definition& d) const {
  return fmt::format("{}\nline {}{}", d.source->text(d.use->statement), d.source->place(d.use->span.begin).line,
                     d.source == &source_ ? "" : " of " + std::filesystem::path(d.source->name()).filename().string());
}

json Document::hover(std::uint32_t offset) const {
  if (const lang::LabelUse* use = use_at(offset)) {
    const auto definition = definition_of(*use);
    if (use->computed)
      return markdown(fmt::format("{}: computed label{}", label_text(*use),
                                  definition && definition->use != use ? "\n" + shown(*definition) : ""));
    // Without one it may come from a computed label or from the machine file.
    return definition ? markdown(shown(*definition)) : json(nullptr);
  }
  const auto help = lang::explain_word(word_at(source_.text(), offset));
  return help ? markdown(*help) : json(nullptr);
}

json Document::definition(std::uint32_t offset) const {
  const lang::LabelUse* use = use_at(offset);
  const auto found = use ? definition_of(*use) : std::nullopt;
  return found ? location(*found->source, found->use->span) : json(nullptr);
}

json Document::references(std::uint32_t offset, bool with_definition) const {
  json list = json::array();
  const lang::LabelUse* use = use_at(offset);
  if (!use) return list;
  const auto add = [&](const SourceFile& source, const std::vector<lang::LabelUse>& uses) {
    for (const lang::LabelUse& other : uses)
      if (other.same_label(*use) && (with_definition || !other.definition))
        list.push_back(location(source, other.span));
  };
  add(source_, uses_);
  for (const Module& module : modules_)
    if (use->scope == 0) add(module.source, module.uses);
  return list;
}

json Document::highlights(std::uint32_t offset) const {
  enum class Highlight { read = 2, write = 3 };  // LSP 3.17, DocumentHighlightKind
  json list = json::array();
  const lang::LabelUse* use = use_at(offset);
  for (const lang::LabelUse& other : uses_)
    if (use && other.same_label(*use))
      list.push_back({{"range", range(source_, other.span)},
                      {"kind", static_cast<int>(other.definition ? Highlight::write : Highlight::read)}});
  return list;
}

json Document::completion(std::uint32_t offset) const {
  json items = json::array();
  std::vector<lang::LabelUse> uses = uses_;
  for (const Module& module : modules_)
    std::copy_if(module.uses.begin(), module.uses.end(), std::back_inserter(uses),
                 [](const lang::LabelUse& use) { return use.definition && use.scope == 0; });
  for (const Proposal& p : proposals(source_, uses, offset))
    items.push_back({{"label", p.text}, {"kind", static_cast<int>(p.kind)}, {"detail", p.detail}});
  return items;
}

json Document::outline() const {
  json list = json::array();
  const auto add = [&](std::string name, Symbol kind, Span span, Span inner, std::string detail) {
    list.push_back({{"name", std::move(name)},
                    {"kind", static_cast<int>(kind)},
                    {"detail", std::move(detail)},
                    {"range", range(source_, span)},
                    {"selectionRange", range(source_, inner)}});
  };
  for (const lang::LabelUse& use : uses_) {
    if (!use.definition) continue;
    const Span whole{std::min(use.span.begin, use.statement.begin), std::max(use.span.end, use.statement.end)};
    const std::string_view text = source_.text(whole);
    const std::size_t equals = text.find('=');
    add(label_text(use), symbol_of(use.kind), whole, use.span,
        std::string(equals == std::string_view::npos ? "" : text.substr(equals + 1)));
  }
  Sink ignored;
  for (const lang::LogicalLine& line : lang::logical_lines(source_)) {
    const auto raw = lang::parse_statement(line, source_, ignored);
    if (!raw) continue;
    const bool measures = raw->word == "MEAS" || raw->word == "RMEAS" || raw->word == "CALIB";
    if (measures || raw->word == "OUTPUT")
      add(std::string(source_.text(raw->span)), measures ? Symbol::method : Symbol::event, raw->span, raw->word_span,
          "");
  }
  return list;
}

json Document::folding() const {
  json list = json::array();
  std::vector<int> open;
  Sink ignored;
  for (const lang::LogicalLine& line : lang::logical_lines(source_)) {
    const auto raw = lang::parse_statement(line, source_, ignored);
    if (!raw) continue;
    const lang::Nesting nesting = lang::nesting_of(*raw);
    if (nesting.before < 0 && !open.empty()) {
      list.push_back({{"startLine", open.back() - 1}, {"endLine", line.line - 2}});
      open.pop_back();
    }
    if (nesting.after > 0) open.push_back(line.line);
  }
  return list;
}

json Document::fixes(Span wanted) const {
  json list = json::array();
  for (const Diagnostic& d : messages_) {
    if (d.replacement.empty() || !d.span || is_foreign(d) || !touches(*d.span, wanted)) continue;
    const json edit = {{"range", range(source_, *d.span)}, {"newText", d.replacement}};
    list.push_back({{"title", fmt::format("Write {}", d.replacement)},
                    {"kind", "quickfix"},
                    {"diagnostics", {message(d)}},
                    {"isPreferred", true},
                    {"edit", {{"changes", {{uri_, {edit}}}}}}});
  }
  return list;
}

json Document::formatting() const {
  const std::string text = lang::format(source_);
  if (text == source_.text()) return json::array();
  const Span all{0, static_cast<std::uint32_t>(source_.text().size())};
  return {{{"range", range(source_, all)}, {"newText", text}}};
}

}  // namespace abbe::lsp
