// Words for axes and directions that several statements share, and vectors from matched numbers.
#pragma once

#include <optional>
#include <string_view>

#include "engine/math/axis.hpp"
#include "engine/math/vec.hpp"
#include "lang/lowering.hpp"

namespace abbe::lang {

/// "XAXIS", "XDIR", "-XDIR", "XORIG": the axis that the word names. Precondition: the signature
/// admitted it.
inline Axis axis_of(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return word[0] == 'X' ? Axis::x : word[0] == 'Y' ? Axis::y : Axis::z;
}
inline AxisDirection direction_of(std::string_view word) { return {axis_of(word), word.starts_with('-') ? -1 : 1}; }

/// Three numbers of the match that begin at the one named `first`.
inline Vec3 vector_of(const Match& match, std::string_view first) {
  const plan::Point p = Lowering::point(match, first);
  return {p[0].constant, p[1].constant, p[2].constant};
}

/// Whether one of the three depends on what is measured.
inline bool is_varying(const Match& match, std::string_view first) {
  const plan::Point p = Lowering::point(match, first);
  return p[0].column.valid() || p[1].column.valid() || p[2].column.valid();
}

/// The same as a unit vector; an error at its first component when it is zero.
inline std::optional<Vec3> direction_vector(Lowering& lowering, const Match& match, std::string_view first) {
  const Vec3 v = vector_of(match, first);
  const double length = norm(v);
  if (length > 0) return v / length;
  lowering.error(Code::E0208, match.find(first)->span, "this vector is zero", "give a direction, for example 0,0,1");
  return std::nullopt;
}

/// The words of all kinds of features.
std::vector<std::string_view> feature_words();
/// Compares the kind named in MEAS or CONST with that of the definition: a warning when they
/// differ, an error when there is no such kind.
void check_kind(Lowering&, const MatchedValue& written, plan::FeatureId);
/// The error for a word that no registry has: `what` is the statement, `role` what the word should
/// have named.
void unknown_kind(Lowering&, const MatchedValue& written, std::string_view what, std::string_view role,
                  const std::vector<std::string_view>& known);

}  // namespace abbe::lang
