// One program that is open in an editor, and the answers to what an editor asks about it. Every
// answer comes from the compiler's own tables and messages: what the editor shows is what `abbe
// check` says.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "lang/compile.hpp"
#include "lang/labels.hpp"

namespace abbe::lsp {

/// A wish that cannot be granted, and why: a name that cannot be changed.
struct Refused {
  std::string reason;
};

class Document {
 public:
  /// `uri` as the editor names the file, `text` in UTF-8.
  Document(std::string uri, std::string text);

  nlohmann::json diagnostics() const;
  nlohmann::json hover(std::uint32_t offset) const;
  nlohmann::json definition(std::uint32_t offset) const;
  nlohmann::json references(std::uint32_t offset, bool with_definition) const;
  nlohmann::json highlights(std::uint32_t offset) const;
  nlohmann::json completion(std::uint32_t offset) const;
  /// The name that is to be changed and its place; null where there is none. Throws Refused.
  nlohmann::json prepare_rename(std::uint32_t offset) const;
  /// The edits that give a name another one, wherever it stands in this program. Throws Refused.
  nlohmann::json rename(std::uint32_t offset, const std::string& name) const;
  nlohmann::json outline() const;
  nlohmann::json folding() const;
  /// Quick fixes for the messages that touch the range.
  nlohmann::json fixes(Span) const;
  /// The edits that bring the text into the style of `abbe format`.
  nlohmann::json formatting() const;

  const SourceFile& source() const { return source_; }

 private:
  /// A file that the program reads.
  struct Module {
    SourceFile source;
    std::vector<lang::LabelUse> uses;
  };
  /// What defines a name, in the program or in a module.
  struct Definition {
    const SourceFile* source;
    const lang::LabelUse* use;
  };

  const lang::LabelUse* use_at(std::uint32_t offset) const;
  std::optional<Definition> definition_of(const lang::LabelUse&) const;
  std::string shown(const Definition&) const;
  nlohmann::json location(const SourceFile&, Span) const;
  bool is_foreign(const Diagnostic&) const;
  nlohmann::json message(const Diagnostic&) const;
  void check_renamable(const lang::LabelUse&) const;
  void check_new_name(const lang::LabelUse&, const std::string& name) const;
  void check_meaning(const std::vector<Span>& places, const std::string& name) const;

  std::string uri_;
  SourceFile source_;
  lang::Compilation compilation_;
  std::vector<Diagnostic> messages_;
  std::vector<lang::LabelUse> uses_;
  std::vector<Module> modules_;
};

/// The path of a `file:` URI, percent signs decoded; other URIs as they are.
std::string path_of(const std::string& uri);
/// The other way round.
std::string uri_of(const std::string& path);

/// A label as programs write it; of a variable its name.
std::string label_text(const lang::LabelUse&);

}  // namespace abbe::lsp
