// What a statement with an error takes away (see lowering.hpp): labels, the measurement it stands
// in, the coordinate system, the units, the sensor, settings, what follows, characteristics.
#pragma once

#include "lang/lowering.hpp"

namespace abbe::lang {

/// `word` is the statement that was meant: the one written, or for a misspelt word the nearest.
void follow_up(Lowering&, const RawStatement&, std::string_view word);
/// Whether the statement, of a word that is not supported yet, would set the coordinate system.
bool sets_frame(const RawStatement&);
/// A setting without an error ends the doubt about what it sets.
void settle(Lowering&, const RawStatement&);

}  // namespace abbe::lang
