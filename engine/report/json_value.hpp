// Numbers in JSON. JSON has no NaN and no infinity: what has no value is null.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace abbe {

/// Keys keep the order in which they are written.
using Json = nlohmann::ordered_json;

/// Null when it is not finite.
inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// Null when there is none, or it is not finite.
inline Json number(const std::optional<double>& value) { return value ? number(*value) : Json(); }

}  // namespace abbe
