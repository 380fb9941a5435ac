// Help and the language reference, written from the tables that the compiler itself uses:
// statements, kinds of features, tolerances, constructions, directives. What is not in a table
// cannot be explained, and what is explained is what compiles.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace abbe::lang {

/// Help for a word of the language (GOTO, CIRCLE, FLAT, INTOF, expect), whatever its case; nothing
/// for any other word.
std::optional<std::string> explain_word(std::string_view word);

/// Where a word stands that has no help of its own: MMC, in the arguments of TOL/POS and others. Nothing for a
/// word that no signature has.
std::optional<std::string> explain_argument_word(std::string_view word);

/// Every word that explain_word knows: for lists and suggestions.
std::vector<std::string_view> explained_words();

/// Words below their title, in lines of 78 columns.
std::string list_of_group(std::string_view title, const std::vector<std::string_view>& words);

/// The words by group, for people: what `abbe explain` shows without a word.
std::string list_of_words();

/// The tables of docs/language.md.
std::string reference_markdown();

}  // namespace abbe::lang
