// Variables while a program is compiled (DECL, ASSIGN, OBTAIN, PROMPT, VALUE, DO).
//
// A variable whose value does not depend on what is measured is known: it lives here, costs nothing at run
// time, and may stand anywhere, in labels too. One that depends on a measurement lives in columns of the
// plan. Before machines part at a condition, what may change on either path is stored in its columns; where
// the paths meet again a variable stays known if both agree.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lang/expression.hpp"

namespace abbe::lang {

class Lowering;

/// One number of a variable: of a vector there are three, of an array as many for each element.
struct Cell {
  bool set = false;     ///< assigned on some path
  bool known = false;   ///< then `constant` is the value
  bool stored = false;  ///< the column holds the value
  double constant = 0;
};

struct Variable {
  std::string name;  ///< as declared
  Type type = Type::real;
  int length = 0;        ///< of a CHAR: characters; 0 for any number of them
  int size = 0;          ///< of an array; 0 for a single value
  std::string slot;      ///< names its columns, which it gets when it needs them
  plan::ColumnId first;  ///< the first of them, or none yet
  std::vector<Cell> cells;

  int width() const { return type == Type::vector ? 3 : 1; }
};

/// By name in upper case, after the prefix of the macro call that it is local to.
using Variables = std::map<std::string, Variable>;

/// Names of variables; `all` for a set that cannot be told from the text.
struct VariableNames {
  std::set<std::string> names;  ///< upper case
  bool all = false;
};

/// nullptr when nothing of that name is declared here.
Variable* find_variable(Lowering&, std::string_view name);
/// Declares, or declares anew. `size` and `length` as in Variable.
Variable& declare(Lowering&, std::string_view name, Type, int length, int size, bool global);
/// The value or the element. Throws Mistake without a place.
Value read(Lowering&, Variable&, const std::optional<Value>& index);
/// Converts to the type of the variable: INTGR cuts fractions off, CHAR what is too long. Throws Mistake
/// without a place.
void assign(Lowering&, Variable&, const std::optional<Value>& index, Value);

/// Puts what is known of these variables into their columns as well.
void store(Lowering&, const VariableNames&);
/// From here on these variables are what their columns hold. Precondition: stored.
void forget(Lowering&, const VariableNames&);
/// The state of variables where two paths meet. Precondition: stored on both.
void merge(Variables& into, const Variables& other);

}  // namespace abbe::lang
