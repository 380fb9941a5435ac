// GOTO: moves the tip in a straight line without measuring.
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

void go(Lowering& lowering, const RawStatement&, const Match& match) {
  if (match.has("x")) return lowering.emit(plan::Move{Lowering::point(match, "x")});
  lowering.emit(plan::Move{lowering.polar(match)});
}

}  // namespace

extern const Statement kGoto;

const Statement kGoto = {
    "GOTO",
    "",
    "( POL, r:length, a:angle, h:length ; [ CART ], x:length, y:length, z:length )",
    "Moves the centre of the tip to a point of the current coordinate system; POL: radius, angle, "
    "height.",
    "GOTO/10,20,30",
    "ISO 22093, GOTO",
    go,
    Varying::taken};

}  // namespace abbe::lang
