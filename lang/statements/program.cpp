// What is around a program: DMISMN, ENDFIL, UNITS, MODE, DMESW.
#include <fmt/format.h>

#include <algorithm>

#include "engine/math/units.hpp"
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

void begin_program(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (lowering.begin_line != 0)
    return lowering.error(Code::E0209, raw.word_span,
                          fmt::format("a second program begins here; the first began in line {}", lowering.begin_line),
                          "keep one program in a file; what follows is not part of this plan");
  lowering.begin_line = raw.line;
  lowering.out.plan.name = match.text("name");
}

void end_program(Lowering& lowering, const RawStatement& raw, const Match&) { lowering.end_line = raw.line; }

void set_units(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const Units before = lowering.units;
  lowering.units = {*length_unit_mm(match.text("unit")), angle_unit_rad(match.text("angle")).value_or(kDegree)};
  lowering.unit_doubt.clear();
  const bool changed =
      before.mm_per_unit != lowering.units.mm_per_unit || before.rad_per_unit != lowering.units.rad_per_unit;
  if (lowering.parted > 0 && changed)
    lowering.error(Code::E0238, raw.span, "the units may not depend on a measured value",
                   "write UNITS before the condition");
}

void set_mode(Lowering& lowering, const RawStatement&, const Match& match) {
  lowering.machine_chooses.set(
      std::any_of(match.values.begin(), match.values.end(), [](const MatchedValue& v) { return v.text == "AUTO"; }));
}

void switch_software(Lowering& lowering, const RawStatement&, const Match& match) {
  if (match.has("state")) lowering.skipping = match.text("state") == "OFF";
}

}  // namespace

extern const Statement kDmismn, kEndfil, kUnits, kMode, kDmesw;

const Statement kDmismn = {
    .word = "DMISMN",
    .signature = "name:text, [ version:number, ... ]",
    .help = "Begins a program and names it. One program per file.",
    .example = "DMISMN/'gauge block',5.2",
    .source = "ISO 22093, DMISMN",
    .lower = begin_program,
};
const Statement kEndfil = {
    .word = "ENDFIL",
    .help = "Ends the program.",
    .example = "ENDFIL",
    .source = "ISO 22093, ENDFIL",
    .lower = end_program,
};
const Statement kUnits = {
    .word = "UNITS",
    .signature = "unit:MM|CM|M|INCH|FEET, [ angle:ANGDEC|ANGDMS|ANGRAD ], [ temperature:TEMPC|TEMPF ]",
    .help =
        "Units of all lengths and angles that follow. ANGDMS also takes degrees:minutes:seconds. "
        "Without it: mm, degrees.",
    .example = "UNITS/MM,ANGDEC",
    .source = "ISO 22093, UNITS",
    .lower = set_units,
    .doubt = Doubt::units,
};
const Statement kMode = {
    .word = "MODE",
    .signature = "mode:AUTO|PROG|MAN, { mode:AUTO|PROG|MAN }",
    .help =
        "Who chooses the touches, in order of preference: the machine (AUTO), the program (PROG), the "
        "operator (MAN). "
        "A block is measured at its PTMEAS points; one without them at the default points of its feature, "
        "unless MODE leaves AUTO out.",
    .example = "MODE/PROG,MAN",
    .source = "ISO 22093, MODE",
    .lower = set_mode,
    .doubt = Doubt::setting,
};
const Statement kDmesw = {
    .word = "DMESW",
    .signature = "( state:ON|OFF ; ... )",
    .help =
        "OFF: the statements up to DMESW/ON are for another program and are "
        "skipped. Other forms speak to the "
        "software of a real machine and are skipped themselves.",
    .example = "DMESW/OFF",
    .source = "ISO 22093, DMESW; the region as written by production software",
    .lower = switch_software,
    .doubt = Doubt::course,
};

}  // namespace abbe::lang
