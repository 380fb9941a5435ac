// The words that decide which statements run. Their meaning is in flow.hpp; here they get their form and their help.
#include <fmt/format.h>

#include "lang/statement.hpp"

namespace abbe::lang {

extern const Statement kIf, kElse, kEndif, kDo, kEnddo, kSelect, kCase, kDftcas, kEndcas, kEndsel, kJumpto, kMacro,
    kEndmac, kCall, kInclud, kExtfil, kXtern, kEndxtn, kDmismd;

const Statement kIf = {
    "IF",
    "",
    "condition:condition",
    "Runs the statements up to ELSE or ENDIF when the condition holds. It may depend on what was measured.",
    "IF/(X .GT. 10.05)",
    "ISO 22093, IF",
    nullptr,
    Varying::taken,
    Control::condition};
const Statement kElse = {"ELSE",
                         "",
                         "",
                         "The statements up to ENDIF run when the condition of IF does not hold.",
                         "ELSE",
                         "ISO 22093, ELSE",
                         nullptr,
                         Varying::taken,
                         Control::otherwise};
const Statement kEndif = {
    "ENDIF", "", "", "Ends an IF.", "ENDIF", "ISO 22093, ENDIF", nullptr, Varying::taken, Control::end_condition};
const Statement kDo = {
    "DO",
    "",
    "variable:word, first:number, limit:number, [ step:number ]",
    "Runs the statements up to ENDDO with the variable at first, first + step, ... as long as it has not passed the limit. First, limit and "
    "step are read once, at the beginning.",
    "DO/I,1,10",
    "ISO 22093, DO",
    nullptr,
    Varying::taken,
    Control::loop};
const Statement kEnddo = {
    "ENDDO", "", "", "Ends a turn of a DO.", "ENDDO", "ISO 22093, ENDDO", nullptr, Varying::taken, Control::end_loop};
const Statement kSelect = {
    "SELECT",       "",
    "value:value",  "Runs the first CASE, up to its ENDCAS, that names this value, or else DFTCAS.",
    "SELECT/N",     "ISO 22093, SELECT",
    nullptr,        Varying::taken,
    Control::choice};
const Statement kCase = {"CASE",
                         "",
                         "value:value, { value:value }",
                         "The statements up to ENDCAS run when SELECT has one of these values.",
                         "CASE/1,2",
                         "ISO 22093, CASE",
                         nullptr,
                         Varying::taken,
                         Control::one_case};
const Statement kDftcas = {"DFTCAS",
                           "",
                           "",
                           "The statements up to ENDCAS run when no CASE suits.",
                           "DFTCAS",
                           "ISO 22093, DFTCAS",
                           nullptr,
                           Varying::taken,
                           Control::any_case};
const Statement kEndcas = {
    "ENDCAS",         "", "", "Ends a CASE or DFTCAS.", "ENDCAS", "ISO 22093, ENDCAS", nullptr, Varying::taken,
    Control::end_case};
const Statement kEndsel = {
    "ENDSEL", "", "", "Ends a SELECT.", "ENDSEL", "ISO 22093, ENDSEL", nullptr, Varying::taken, Control::end_choice};
const Statement kJumpto = {
    "JUMPTO",
    "",
    "...",
    "Goes on at the line that holds nothing but the name in parentheses. A jump may leave blocks, not enter them.",
    "JUMPTO/(AGAIN)",
    "ISO 22093, JUMPTO",
    nullptr,
    Varying::taken,
    Control::jump};
const Statement kMacro = {
    "MACRO",
    "M",
    "...",
    "Statements up to ENDMAC that CALL runs. An argument stands for what CALL gives, wherever its name occurs; one in quotes only where it occurs in "
    "quotes, in labels too: F('NAME').",
    "M(HOLE)=MACRO/'NAME',X,Y",
    "ISO 22093, MACRO",
    nullptr,
    Varying::taken,
    Control::macro};
const Statement kEndmac = {
    "ENDMAC", "", "", "Ends a MACRO.", "ENDMAC", "ISO 22093, ENDMAC", nullptr, Varying::taken, Control::end_macro};
const Statement kCall = {"CALL",
                         "",
                         "...",
                         "Runs a macro; or, as CALL/EXTERN,DMIS,'file', the statements of a file beside the program.",
                         "CALL/M(HOLE),'H1',10,20",
                         "ISO 22093, CALL",
                         nullptr,
                         Varying::taken,
                         Control::call};
const Statement kInclud = {"INCLUD",
                           "",
                           "DMIS, file:text",
                           "Runs the statements of a file beside the program, as if they stood here.",
                           "INCLUD/DMIS,'sensors.dmi'",
                           "ISO 22093, INCLUD",
                           nullptr,
                           Varying::taken,
                           Control::module};
const Statement kExtfil = {"EXTFIL",
                           "",
                           "DMIS, file:text",
                           "Makes the macros of a file beside the program known; between XTERN and ENDXTN.",
                           "EXTFIL/DMIS,'macros.dmi'",
                           "ISO 22093, EXTFIL",
                           nullptr,
                           Varying::taken,
                           Control::module};

namespace {
void begin_list(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (lowering.external_files)
    return lowering.error(Code::E0118, raw.word_span, "a list of external files is open already", "end it with ENDXTN");
  if (lowering.file == &lowering.source) lowering.external_files = raw.word_span;
}

void end_list(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (lowering.file == &lowering.source && !lowering.external_files)
    lowering.error(Code::E0116, raw.word_span, "ENDXTN closes nothing",
                   "remove it, or write XTERN before the list of external files");
  lowering.external_files.reset();
}

/// A module may be checked by itself.
void begin_module(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (lowering.file != &lowering.source) return;
  if (lowering.begin_line != 0)
    return lowering.error(Code::E0209, raw.word_span,
                          fmt::format("a module begins here, inside the program of line {}", lowering.begin_line),
                          "give the module a file of its own");
  lowering.begin_line = raw.line;
}
}  // namespace

const Statement kXtern = {"XTERN",   "", "", "Begins the list of external files.", "XTERN", "ISO 22093, XTERN",
                          begin_list};
const Statement kEndxtn = {"ENDXTN", "", "", "Ends the list of external files.", "ENDXTN", "ISO 22093, ENDXTN",
                           end_list};
const Statement kDmismd = {"DMISMD",
                           "",
                           "name:text, [ version:number, ... ]",
                           "Begins a module: a file that programs read with INCLUD, EXTFIL or CALL.",
                           "DMISMD/'sensors',5.2",
                           "ISO 22093, DMISMD",
                           begin_module};

}  // namespace abbe::lang
