// The variable before the `=` of ASSIGN, OBTAIN, PROMPT and VALUE.
#pragma once

#include "lang/lowering.hpp"

namespace abbe::lang {

/// Assigns to X or X[i] as the statement's label names it; a variable that is not declared takes the type of
/// the value, with a warning. False after an error.
bool assign_to_label(Lowering&, const RawStatement&, Value);

}  // namespace abbe::lang
