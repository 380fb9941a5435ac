// Values of the language: what variables hold and expressions give.
//
// A number is a plan expression. While nothing measured is in it, it is one constant and folds as the program
// is compiled; as soon as a measured value is in it, it is arithmetic over columns that every virtual machine
// does for itself. So one code path serves both, and a value is the same either way.
//
// Texts are interned: a text is the number of an entry in a table. A CHAR variable that holds one text on one
// path and another on the next is then a column like any other, and texts compare by number.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/plan/expression.hpp"

namespace abbe::lang {

enum class Type { boolean, integer, real, text, vector };
/// As DECL names it: BOOL, INTGR, REAL, CHAR, VECTOR.
std::string_view name_of(Type);

struct Value {
  Type type = Type::real;
  std::vector<plan::Expression> parts;  ///< three for a vector, else one; of a text its number in Texts

  bool is_number() const { return type == Type::integer || type == Type::real; }
  /// Whether it may name an element of an array: a whole number, or one that only the machines know.
  bool is_index() const;
  /// True while nothing in it depends on what is measured.
  bool known() const;
  /// Precondition: known.
  double constant(std::size_t part = 0) const { return *plan::constant(parts[part]); }
};

Value number(double);
Value integer(double);
Value boolean(bool);

/// The texts of a program, each once.
class Texts {
 public:
  Value value(std::string_view text);
  /// Precondition: a text that is known.
  const std::string& operator[](const Value& v) const { return texts_[static_cast<std::size_t>(v.constant())]; }

 private:
  std::vector<std::string> texts_;
};

}  // namespace abbe::lang
