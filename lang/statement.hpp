// One statement of DMIS: what it looks like, what it means in a plan, and how to explain it.
//
// A statement is one constant in a file of lang/statements and one line in all.cpp there. Its
// signature matches the arguments, makes the messages about them, and prints the help; `lower` is
// called with arguments that match and writes operations and definitions to the plan.
#pragma once

#include <span>
#include <string_view>

#include "lang/lowering.hpp"

namespace abbe::lang {

struct Statement {
  std::string_view word;   ///< upper case
  std::string_view label;  ///< kind of label before the `=`: "F"; "" for none; "*" for any or none
  std::string_view signature;  ///< notation: engine/base/arguments.hpp and lang/signature.hpp
  std::string_view help;       ///< what it does, in a line or two
  std::string_view example;    ///< a complete statement
  std::string_view source;     ///< standard, or where else the form was read
  void (*lower)(Lowering&, const RawStatement&, const Match&);
};

/// Every statement that Abbe knows, in the order of the language reference.
std::span<const Statement* const> statements();
/// nullptr when there is none. Upper case.
const Statement* find_statement(std::string_view word);

/// The major words of ISO 22093, whether Abbe knows them or not.
std::span<const std::string_view> standard_words();
bool is_standard_word(std::string_view word);

}  // namespace abbe::lang
