// The intrinsic functions of ISO 22093: one table with form, argument types, help and meaning.
//
// Numbers may depend on what is measured; texts may not: a function of texts is computed while the program is
// compiled, and STR of a measured value is refused. Angles are in radians; DTOR and RTOD convert.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "lang/value.hpp"

namespace abbe::lang {

struct Intrinsic {
  std::string_view name;  ///< upper case
  std::string_view form;  ///< for people: "ATAN2(y,x)"
  /// a letter each: n number, v vector; known while compiling: k number, t text, s any; after ? optional; +
  /// repeats
  std::string_view arguments;
  std::string_view help;
  /// The arguments have the types of `arguments`; those of texts are known. Throws Mistake without a place.
  Value (*value)(std::vector<Value>&, Texts&);
};

std::span<const Intrinsic> intrinsics();
/// nullptr when there is none. Upper case.
const Intrinsic* find_intrinsic(std::string_view name);

/// Checks the arguments and applies the function; throws Mistake without a place.
Value apply(const Intrinsic&, std::vector<Value> arguments, Texts&);

}  // namespace abbe::lang
