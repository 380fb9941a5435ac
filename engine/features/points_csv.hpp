// Points from a CSV file: a header x,y,z and one point a line, mm. Strict, so that a decimal comma or a lost
// column is a message and not a wrong feature. "nan" and "inf" are numbers here: the fit refuses them with
// better words than a parser could.
#pragma once

#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/math/vec.hpp"

namespace abbe {

/// Accepts LF and CRLF, spaces around values, a byte order mark, blank lines at the end. Throws UserError
/// with the places of the first mistakes (E0501, E0502, E0503).
std::vector<Vec3> points_from_csv(const SourceFile& file);

}  // namespace abbe
