// What is around a program: DMISMN, ENDFIL, UNITS, MODE, DMESW.
#include <fmt/format.h>

#include <algorithm>

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
  const std::string length = match.text("unit");
  lowering.units.mm_per_unit = length == "MM" ? 1
      : length == "CM"                        ? 10
      : length == "M"                         ? 1000
      : length == "INCH"                      ? 25.4
                                              : 304.8;
  lowering.units.rad_per_unit = match.text("angle") == "ANGRAD" ? 1 : Units::kRadPerDegree;
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

extern const Statement kDmismn, kEndfil, kUnits, kMode, kDmesw, kDmeswv;

const Statement kDmismn = {"DMISMN",
                           "",
                           "name:text, [ version:number, ... ]",
                           "Begins a program and names it. One program per file.",
                           "DMISMN/'gauge block',5.2",
                           "ISO 22093, DMISMN",
                           begin_program};
const Statement kEndfil = {"ENDFIL", "", "", "Ends the program.", "ENDFIL", "ISO 22093, ENDFIL", end_program};
const Statement kUnits = {"UNITS",
                          "",
                          "unit:MM|CM|M|INCH|FEET, angle:ANGDEC|ANGDMS|ANGRAD, [ temperature:TEMPC|TEMPF ]",
                          "Units of all lengths and angles that follow. ANGDMS also takes degrees:minutes:seconds. "
                          "Without it: mm, degrees.",
                          "UNITS/MM,ANGDEC",
                          "ISO 22093, UNITS",
                          set_units};
const Statement kMode = {
    "MODE",
    "",
    "mode:AUTO|PROG|MAN, { mode:AUTO|PROG|MAN }",
    "Who chooses the touches, in order of preference: the machine (AUTO), the program (PROG), the "
    "operator (MAN). "
    "A block is measured at its PTMEAS points; one without them at the default points of its feature, "
    "unless MODE leaves AUTO out.",
    "MODE/PROG,MAN",
    "ISO 22093, MODE",
    set_mode};
const Statement kDmesw = {"DMESW",
                          "",
                          "( state:ON|OFF ; ... )",
                          "OFF: the statements up to DMESW/ON are for another program and are "
                          "skipped. Other forms speak to the "
                          "software of a real machine and are skipped themselves.",
                          "DMESW/OFF",
                          "ISO 22093, DMESW; the region as written by production software",
                          switch_software};
const Statement kDmeswv = {"DMESWV",
                           "",
                           "...",
                           "Names the version of the software of a real machine. Skipped.",
                           "DMESWV/'4.0'",
                           "ISO 22093, DMESWV",
                           skip};

}  // namespace abbe::lang
