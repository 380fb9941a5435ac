// OTHER: patterns for what the catalogue does not have.
#pragma once

#include <string>
#include <vector>

#include "engine/diagnose/model/explanation.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// Appends those of every family (families.hpp).
void add_other(const RecordedTouches&, const std::vector<int>& rows, Explanations&);

/// One pattern more, believed as most of them, with these columns; `shape`: what it is.
void add_pattern(Explanations&, Factor, std::string shape, const Matrix& columns);

}  // namespace abbe::diagnose
