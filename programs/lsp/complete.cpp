#include "programs/lsp/complete.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lang/directives.hpp"
#include "lang/lines.hpp"
#include "lang/parser.hpp"
#include "lang/statement.hpp"
#include "lang/vocabulary.hpp"

namespace abbe::lsp {

namespace {

using Kind = Proposal::Kind;
using Proposals = std::vector<Proposal>;

/// The logical line up to the cursor; nothing before the first statement.
lang::LogicalLine typed_line(const SourceFile& source, std::uint32_t offset) {
  const SourceFile typed(source.name(), std::string(source.text().substr(0, offset)));
  std::vector<lang::LogicalLine> lines = lang::logical_lines(typed);
  return lines.empty() ? lang::LogicalLine{} : std::move(lines.back());
}

void add_labels(Proposals& out, const std::vector<lang::LabelUse>& uses, std::string_view kind,
                const std::string& form) {
  for (const lang::LabelUse& use : uses)
    if (use.definition && use.kind == kind)
      out.push_back({fmt::format(fmt::runtime(form), use.name), kind.empty() ? Kind::variable : Kind::reference, ""});
}

/// Labels whole, in the form that the signature of the statement takes.
void add_labels_of(Proposals& out, const lang::Statement& statement, const std::vector<lang::LabelUse>& uses) {
  struct Form {
    std::string_view type, kind, form;
  };
  const bool nominal = statement.word == "MEAS" || statement.word == "CONST" || statement.word == "RMEAS";
  const std::array forms = {Form{":feature", "F", nominal ? "F({})" : "FA({})"}, Form{":tolerance", "T", "TA({})"},
                            Form{":datum", "DAT", "DAT({})"}, Form{":sensor", "S", "S({})"},
                            Form{":frame", "D", "D({})"}};
  for (const Form& form : forms)
    if (statement.signature.find(form.type) != std::string_view::npos)
      add_labels(out, uses, form.kind, std::string(form.form));
  // What a kind of feature, tolerance or construction takes is published elsewhere.
  if (statement.word == "CONST") add_labels(out, uses, "F", "FA({})");
  if (statement.word == "TOL") add_labels(out, uses, "DAT", "DAT({})"), add_labels(out, uses, "F", "FA({})");
  if (statement.word == "CALL") add_labels(out, uses, "M", "M({})");
  if (statement.word == "JUMPTO") return add_labels(out, uses, lang::kJumpTarget, "({})");
  add_labels(out, uses, "", "{}");
}

void add_in_directive(Proposals& out, const lang::JoinedText& comment, const std::vector<lang::LabelUse>& uses) {
  const lang::DirectiveNext next = lang::next_in_directive(comment);
  for (const lang::DirectiveHelp& d : next.words)
    out.push_back({std::string(d.word), Kind::keyword, std::string(d.help)});
  for (const std::string_view kind : next.kinds)
    add_labels(out, uses, lang::shared_kind(kind), fmt::format("{}({{}})", kind));
}

void add_major_words(Proposals& out) {
  for (const std::string_view word : lang::major_words()) {
    const lang::Statement* statement = lang::find_statement(word);
    out.push_back(
        {std::string(word), Kind::keyword, statement ? std::string(statement->example) : "not supported yet"});
  }
}

/// Behind `KIND(`, inside the parenthesis that is open: the kind, else nothing.
std::string open_label_kind(std::string_view code) {
  const std::size_t open = code.rfind('(');
  if (open == std::string_view::npos || code.find(')', open) != std::string_view::npos) return "";
  std::size_t begin = open;
  while (begin > 0 && std::isalpha(static_cast<unsigned char>(code[begin - 1]))) --begin;
  return upper(code.substr(begin, open - begin));
}

/// The statement as far as it is typed, complete enough to be parsed: a last argument that is being
/// typed does not count.
std::optional<lang::RawStatement> statement_so_far(std::string_view code) {
  const std::size_t last = code.find_last_of(",/");
  const SourceFile text("", std::string(code.substr(0, last + 1)));
  Sink ignored;
  const std::vector<lang::LogicalLine> lines = lang::logical_lines(text);
  return lines.empty() ? std::nullopt : lang::parse_statement(lines.front(), text, ignored);
}

void add_behind_slash(Proposals& out, std::string_view code, const std::vector<lang::LabelUse>& uses) {
  if (const std::string kind = open_label_kind(code); !kind.empty())
    return add_labels(out, uses, lang::shared_kind(kind), "{}");
  const auto raw = statement_so_far(code);
  const lang::Statement* statement = raw ? lang::find_statement(raw->word) : nullptr;
  if (!statement) return;
  for (std::string& word : lang::argument_words(raw->word, raw->arguments))
    out.push_back({std::move(word), Kind::constant, ""});
  add_labels_of(out, *statement, uses);
}

}  // namespace

Proposals proposals(const SourceFile& source, const std::vector<lang::LabelUse>& uses, std::uint32_t offset) {
  const lang::LogicalLine line = typed_line(source, offset);
  const std::string& code = line.code.text();
  Proposals out;
  if (line.comment && line.comment->text().starts_with('!')) {
    if (const std::string kind = open_label_kind(line.comment->text()); !kind.empty())
      add_labels(out, uses, lang::shared_kind(kind), "{}");
    else
      add_in_directive(out, *line.comment, uses);
  } else if (line.comment) {
    return out;
  } else if (std::count(code.begin(), code.end(), '\'') % 2 != 0) {
    return out;  // inside a text
  } else if (code.find('/') != std::string::npos) {
    add_behind_slash(out, code, uses);
  } else if (const std::string kind = open_label_kind(code); !kind.empty()) {
    add_labels(out, uses, lang::shared_kind(kind), "{}");
  } else {
    add_major_words(out);
  }
  std::sort(out.begin(), out.end(), [](const Proposal& a, const Proposal& b) { return a.text < b.text; });
  out.erase(std::unique(out.begin(), out.end(), [](const Proposal& a, const Proposal& b) { return a.text == b.text; }),
            out.end());
  return out;
}

}  // namespace abbe::lsp
