// What would mend a recording: its axes in another order, or one of them with the other sign.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "engine/base/diagnostic.hpp"
#include "engine/math/vec.hpp"

namespace abbe::diagnose {

/// The axes in another order.
inline constexpr std::array<std::array<int, 3>, 5> kOrders = {{{1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}};

inline Vec3 in_order(const Vec3& v, const std::array<int, 3>& o) { return {v[o[0]], v[o[1]], v[o[2]]}; }

inline Vec3 turned_round(Vec3 v, int axis) {
  v[axis] = -v[axis];
  return v;
}

/// Throws UserError (E0701): what is wrong with the whole file, and what mends it.
[[noreturn]] inline void refuse(const std::string& file, const std::string& what, std::string remedy) {
  throw UserError(diagnostic(Code::E0701, fmt::format("{}: {}", file, what), std::move(remedy)));
}

}  // namespace abbe::diagnose
