// The words that decide which statements run. Their meaning is in flow.hpp; here they get their form and their help.
#include <fmt/format.h>

#include "lang/statement.hpp"

namespace abbe::lang {

extern const Statement kIf, kElse, kEndif, kDo, kEnddo, kSelect, kCase, kDftcas, kEndcas, kEndsel, kJumpto, kMacro,
    kEndmac, kCall, kInclud, kExtfil, kXtern, kEndxtn, kDmismd;

const Statement kIf = {
    .word = "IF",
    .signature = "condition:condition",
    .help = "Runs the statements up to ELSE or ENDIF when the condition holds. It may depend on what was measured.",
    .example = "IF/(X .GT. 10.05)",
    .source = "ISO 22093, IF",
    .varying = Varying::taken,
    .control = Control::condition,
};
const Statement kElse = {
    .word = "ELSE",
    .help = "The statements up to ENDIF run when the condition of IF does not hold.",
    .example = "ELSE",
    .source = "ISO 22093, ELSE",
    .varying = Varying::taken,
    .control = Control::otherwise,
};
const Statement kEndif = {
    .word = "ENDIF",
    .help = "Ends an IF.",
    .example = "ENDIF",
    .source = "ISO 22093, ENDIF",
    .varying = Varying::taken,
    .control = Control::end_condition,
};
const Statement kDo = {
    .word = "DO",
    .signature = "variable:word, first:number, limit:number, [ step:number ]",
    .help =
        "Runs the statements up to ENDDO with the variable at first, first + step, ... as long as it has not passed the limit. First, limit and "
        "step are read once, at the beginning.",
    .example = "DO/I,1,10",
    .source = "ISO 22093, DO",
    .varying = Varying::taken,
    .control = Control::loop,
};
const Statement kEnddo = {
    .word = "ENDDO",
    .help = "Ends a turn of a DO.",
    .example = "ENDDO",
    .source = "ISO 22093, ENDDO",
    .varying = Varying::taken,
    .control = Control::end_loop,
};
const Statement kSelect = {
    .word = "SELECT",
    .signature = "value:value",
    .help = "Runs the first CASE, up to its ENDCAS, that names this value, or else DFTCAS.",
    .example = "SELECT/N",
    .source = "ISO 22093, SELECT",
    .varying = Varying::taken,
    .control = Control::choice,
};
const Statement kCase = {
    .word = "CASE",
    .signature = "value:value, { value:value }",
    .help = "The statements up to ENDCAS run when SELECT has one of these values.",
    .example = "CASE/1,2",
    .source = "ISO 22093, CASE",
    .varying = Varying::taken,
    .control = Control::one_case,
};
const Statement kDftcas = {
    .word = "DFTCAS",
    .help = "The statements up to ENDCAS run when no CASE suits.",
    .example = "DFTCAS",
    .source = "ISO 22093, DFTCAS",
    .varying = Varying::taken,
    .control = Control::any_case,
};
const Statement kEndcas = {
    .word = "ENDCAS",
    .help = "Ends a CASE or DFTCAS.",
    .example = "ENDCAS",
    .source = "ISO 22093, ENDCAS",
    .varying = Varying::taken,
    .control = Control::end_case,
};
const Statement kEndsel = {
    .word = "ENDSEL",
    .help = "Ends a SELECT.",
    .example = "ENDSEL",
    .source = "ISO 22093, ENDSEL",
    .varying = Varying::taken,
    .control = Control::end_choice,
};
const Statement kJumpto = {
    .word = "JUMPTO",
    .signature = "...",
    .help =
        "Goes on at the line that holds nothing but the name in parentheses. A jump may leave blocks, not enter them.",
    .example = "JUMPTO/(AGAIN)",
    .source = "ISO 22093, JUMPTO",
    .varying = Varying::taken,
    .control = Control::jump,
};
const Statement kMacro = {
    .word = "MACRO",
    .label = "M",
    .signature = "...",
    .help =
        "Statements up to ENDMAC that CALL runs. An argument stands for what CALL gives, wherever its name occurs; one in quotes only where it occurs in "
        "quotes, in labels too: F('NAME').",
    .example = "M(HOLE)=MACRO/'NAME',X,Y",
    .source = "ISO 22093, MACRO",
    .varying = Varying::taken,
    .control = Control::macro,
};
const Statement kEndmac = {
    .word = "ENDMAC",
    .help = "Ends a MACRO.",
    .example = "ENDMAC",
    .source = "ISO 22093, ENDMAC",
    .varying = Varying::taken,
    .control = Control::end_macro,
};
const Statement kCall = {
    .word = "CALL",
    .signature = "...",
    .help = "Runs a macro; or, as CALL/EXTERN,DMIS,'file', the statements of a file beside the program.",
    .example = "CALL/M(HOLE),'H1',10,20",
    .source = "ISO 22093, CALL",
    .varying = Varying::taken,
    .control = Control::call,
};
const Statement kInclud = {
    .word = "INCLUD",
    .signature = "DMIS, file:text",
    .help = "Runs the statements of a file beside the program, as if they stood here.",
    .example = "INCLUD/DMIS,'sensors.dmi'",
    .source = "ISO 22093, INCLUD",
    .varying = Varying::taken,
    .control = Control::module,
};
const Statement kExtfil = {
    .word = "EXTFIL",
    .signature = "DMIS, file:text",
    .help = "Makes the macros of a file beside the program known; between XTERN and ENDXTN.",
    .example = "EXTFIL/DMIS,'macros.dmi'",
    .source = "ISO 22093, EXTFIL",
    .varying = Varying::taken,
    .control = Control::module,
};

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

const Statement kXtern = {
    .word = "XTERN",
    .help = "Begins the list of external files.",
    .example = "XTERN",
    .source = "ISO 22093, XTERN",
    .lower = begin_list,
};
const Statement kEndxtn = {
    .word = "ENDXTN",
    .help = "Ends the list of external files.",
    .example = "ENDXTN",
    .source = "ISO 22093, ENDXTN",
    .lower = end_list,
};
const Statement kDmismd = {
    .word = "DMISMD",
    .signature = "name:text, [ version:number, ... ]",
    .help = "Begins a module: a file that programs read with INCLUD, EXTFIL or CALL.",
    .example = "DMISMD/'sensors',5.2",
    .source = "ISO 22093, DMISMD",
    .lower = begin_module,
};

}  // namespace abbe::lang
