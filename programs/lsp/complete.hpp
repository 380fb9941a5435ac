// What may stand at a place of a program that is being typed: words at the beginning of a
// statement, the minor words and labels that the statement takes behind its slash, names behind
// `FA(`, directives behind `$$!`. From the statement tables and the labels of the program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/source.hpp"
#include "lang/labels.hpp"

namespace abbe::lsp {

struct Proposal {
  /// LSP 3.17, CompletionItemKind.
  enum class Kind { variable = 6, keyword = 14, reference = 18, constant = 21 };
  std::string text;
  Kind kind{};
  std::string detail;  ///< one line of help; may be empty
};

/// In alphabetical order, each once. The editor filters by what is typed already.
std::vector<Proposal> proposals(const SourceFile&, const std::vector<lang::LabelUse>&, std::uint32_t offset);

}  // namespace abbe::lsp
