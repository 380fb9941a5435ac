// Moves of the tip without measuring: GOTO, and the way home (FROM, GOHOME).
#include <fmt/format.h>

#include "lang/statement.hpp"
#include "lang/statements/words.hpp"

namespace abbe::lang {

namespace {

plan::Point point_of(Lowering& lowering, const Match& match) {
  return match.has("x") ? Lowering::point(match, "x") : lowering.polar(match);
}

/// INCR: a distance along a vector, from where the tip is.
void go_by(Lowering& lowering, const Match& match) {
  if (is_varying(match, "i"))
    return lowering.error(Code::E0231, match.find("i")->span,
                          "the direction of GOTO/INCR must be known before the machine runs",
                          "give the point instead: GOTO/x,y,z takes measured values");
  const std::optional<Vec3> along = direction_vector(lowering, match, "i");
  if (!along) return;
  const plan::Expression distance = Lowering::expression(Lowering::operand(*match.find("distance")));
  plan::Move move{{}, true};
  for (int k = 0; k < 3; ++k)
    move.to[k] = lowering.operand(combine(plan::Op2::multiply, distance, {plan::PushConstant{(*along)[k]}}));
  lowering.emit(move);
}

void go(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (const MatchedValue* turn = match.find("turn")) {
    lowering.error(Code::E0256, turn->span,
                   fmt::format("GOTO does not turn the head here: {} and what follows it cannot be used", turn->text),
                   "define a sensor for every orientation with SNSDEF and turn the head with SNSLCT");
    lowering.sensor_doubt = lowering.blame();
    return;
  }
  if (match.used < raw.arguments.size())
    return lowering.error(Code::E0108, raw.arguments[match.used].span, "GOTO has an argument too many",
                          "for example: GOTO/10,20,30");
  if (match.has("distance")) return go_by(lowering, match);
  lowering.emit(plan::Move{point_of(lowering, match)});
}

void set_home(Lowering& lowering, const RawStatement&, const Match& match) {
  lowering.emit(plan::SetHome{point_of(lowering, match)});
  lowering.home_known = true;
}

void go_home(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (!lowering.home_known)
    lowering.warn(Code::W0257, raw.word_span, "no FROM says where home is: GOHOME moves nowhere",
                  "write FROM/x,y,z before it");
  lowering.emit(plan::GoHome{});
}

}  // namespace

extern const Statement kGoto, kFrom, kGohome;

const Statement kGoto = {
    .word = "GOTO",
    .signature =
        "( POL, r:length, a:angle, h:length ; INCR, distance:length, i:number, j:number, k:number ; "
        "[ CART ], x:length, y:length, z:length ), [ turn:HEADCS|PROBCS|DATUMCS|SNSLCT|WRIST ], ...",
    .help =
        "Moves the centre of the tip to a point of the current coordinate system; POL: radius, angle, "
        "height; INCR: by a distance along a vector. The head is turned by SNSLCT; a GOTO that "
        "would turn it is refused (E0256).",
    .example = "GOTO/10,20,30",
    .source = "ISO 22093, GOTO",
    .lower = go,
    .varying = Varying::taken,
};
const Statement kFrom = {
    .word = "FROM",
    .signature = "( POL, r:length, a:angle, h:length ; [ CART ], x:length, y:length, z:length )",
    .help = "Says where the tip is at home: a point of the coordinate system current here. GOHOME moves there.",
    .example = "FROM/0,0,200",
    .source = "ISO 22093, FROM",
    .lower = set_home,
    .varying = Varying::taken,
};
const Statement kGohome = {
    .word = "GOHOME",
    .help = "Moves the centre of the tip to where FROM says.",
    .example = "GOHOME",
    .source = "ISO 22093, GOHOME",
    .lower = go_home,
};

}  // namespace abbe::lang
