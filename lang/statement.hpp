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

/// Words that decide which statements run (flow.hpp).
enum class Control {
  none,
  condition,      ///< IF
  otherwise,      ///< ELSE
  end_condition,  ///< ENDIF
  loop,           ///< DO
  end_loop,       ///< ENDDO
  choice,         ///< SELECT
  one_case,       ///< CASE
  any_case,       ///< DFTCAS
  end_case,       ///< ENDCAS
  end_choice,     ///< ENDSEL
  jump,           ///< JUMPTO
  macro,          ///< MACRO
  end_macro,      ///< ENDMAC
  call,           ///< CALL
  module,         ///< INCLUD, EXTFIL
  lost,           ///< one of these that opens or closes nothing, already reported
};

/// What an error in a statement takes away besides its label (follow_up.hpp).
enum class Doubt {
  none,
  measurement,     ///< the feature that it begins to measure, or the sensor that it calibrates
  construction,    ///< the feature that it constructs
  datum,           ///< the one that it defines
  frame,           ///< the current coordinate system
  recall,          ///< that too, where a frame is recalled
  units,           ///< of all that follows
  sensor,          ///< the one in use
  setting,         ///< how touches are made, compensated and fitted
  one_setting,     ///< of several: the one that its first argument names
  characteristic,  ///< the one that it evaluates
  course,          ///< which statements run; so does every word of control
};

struct Statement {
  std::string_view word;  ///< upper case
  std::string_view label =
      {};  ///< kind of label before the `=`: "F"; "=" for a variable; "" for none; "*" for any or none
  std::string_view signature = {};  ///< notation: engine/base/arguments.hpp and lang/signature.hpp
  std::string_view help;            ///< what it does, in a line or two
  std::string_view example;         ///< a complete statement
  std::string_view source;          ///< standard, or where else the form was read
  /// nullptr for a word of control
  void (*lower)(Lowering&, const RawStatement&, const Match&) = nullptr;
  Varying varying = Varying::refused;  ///< whether its numbers may depend on what is measured
  Control control = Control::none;
  Doubt doubt = Doubt::none;
};

/// `lower` of a statement that means nothing to a virtual machine: understood, and skipped without a message. OUTPUT may
/// name its label.
void skip(Lowering&, const RawStatement&, const Match&);

/// Every statement that Abbe knows, in the order of the language reference.
std::span<const Statement* const> statements();
/// nullptr when there is none. Upper case.
const Statement* find_statement(std::string_view word);

/// The major words of ISO 22093, whether Abbe knows them or not.
std::span<const std::string_view> standard_words();
bool is_standard_word(std::string_view word);

}  // namespace abbe::lang
