// Statements without meaning for a virtual machine: understood, kept in the tree, skipped without
// noise; and those whose effect is not modelled, which say so.
#include <fmt/format.h>

#include "lang/statement.hpp"

namespace abbe::lang {

void skip(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (raw.label) lowering.skipped_labels.insert(raw.label->kind);
}

namespace {

void no_effect(Lowering& lowering, const RawStatement& raw, const Match&) {
  lowering.warn(Code::W0122, raw.span, fmt::format("{} has no effect here yet", raw.word),
                "the results are those without it");
}

void name_result(Lowering& lowering, const RawStatement&, const Match& match) {
  lowering.out.plan.result_name = match.text("name");
}

void read_file(Lowering& lowering, const RawStatement& raw, const Match&) {
  lowering.error(Code::E0258, raw.span, "READ takes values from a file of the real machine, which is not here",
                 "give the values with ASSIGN, or ask for them: X=PROMPT/'text' and --answer X=VALUE");
}

/// Lowering refuses POL under another plane than XYPLAN.
void choose_plane(Lowering& lowering, const RawStatement& raw, const Match& match) {
  const MatchedValue& plane = *match.find("plane");
  if (plane.text == "XYPLAN" || !lowering.reported_words.insert(raw.word).second) return;
  lowering.warn(Code::W0122, plane.span,
                "RADIUS and ANGLE of CORTOL, and POS,2D of points and spheres, stay in the plane of x and y",
                "the features themselves carry their own vectors");
}

void write_file(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (!lowering.reported_words.insert(raw.word).second) return;
  lowering.warn(Code::W0122, raw.word_span, "WRITE makes no file here and is skipped wherever it stands",
                "results: `abbe run --csv`, `--dmo` or `--format json`");
}

}  // namespace

extern const Statement kFilnam, kDisply, kText, kDevice, kOpen, kClose, kVform, kDecpl, kFinpos, kWkplan, kPause, kRead,
    kWrite;

const Statement kFilnam = {
    .word = "FILNAM",
    .signature = "name:text, [ version:number ]",
    .help = "Names the result file: what --dmo writes begins with it.",
    .example = "FILNAM/'results',5.2",
    .source = "ISO 22093, FILNAM",
    .lower = name_result,
};
const Statement kDisply = {
    .word = "DISPLY",
    .signature = "...",
    .help = "Where results are shown. Skipped.",
    .example = "DISPLY/TERM,DMIS",
    .source = "ISO 22093, DISPLY",
    .lower = skip,
};
const Statement kText = {
    .word = "TEXT",
    .signature = "to:OPER|MAN|OUTFIL|QUERY, ...",
    .help = "Text for the operator or the result file. Skipped.",
    .example = "TEXT/OUTFIL,'bore'",
    .source = "ISO 22093, TEXT",
    .lower = skip,
};
const Statement kDevice = {
    .word = "DEVICE",
    .label = "*",
    .signature = "medium:word, ...",
    .help = "Names a device. Skipped.",
    .example = "DID(OUT)=DEVICE/STOR,'results.dmo'",
    .source = "ISO 22093, DEVICE",
    .lower = skip,
};
const Statement kOpen = {
    .word = "OPEN",
    .signature = "device:label, ...",
    .help = "Opens a device. Skipped.",
    .example = "OPEN/DID(OUT),FDATA,DMIS,OUTPUT",
    .source = "ISO 22093, OPEN",
    .lower = skip,
};
const Statement kClose = {
    .word = "CLOSE",
    .signature = "device:label, ...",
    .help = "Closes a device. Skipped.",
    .example = "CLOSE/DID(OUT)",
    .source = "ISO 22093, CLOSE",
    .lower = skip,
};
const Statement kVform = {
    .word = "VFORM",
    .label = "*",
    .signature = "...",
    .help = "Form of a report. Skipped.",
    .example = "V(R)=VFORM/ALL",
    .source = "ISO 22093, VFORM",
    .lower = skip,
};
const Statement kDecpl = {
    .word = "DECPL",
    .label = "*",
    .signature = "...",
    .help = "Decimal places of results. Skipped: reports show what the uncertainty allows.",
    .example = "DECPL/ALL,DV(3)",
    .source = "ISO 22093, DECPL",
    .lower = skip,
};
const Statement kFinpos = {
    .word = "FINPOS",
    .signature = "state:ON|OFF",
    .help = "Fine positioning. Skipped: it is part of the machine's specification.",
    .example = "FINPOS/ON",
    .source = "ISO 22093, FINPOS",
    .lower = skip,
};
const Statement kWkplan = {
    .word = "WKPLAN",
    .signature = "plane:XYPLAN|YZPLAN|ZXPLAN",
    .help =
        "Working plane. Features carry their own vectors and do not depend on it; POL is an error under another plane "
        "than XYPLAN.",
    .example = "WKPLAN/XYPLAN",
    .source = "ISO 22093, WKPLAN",
    .lower = choose_plane,
};
const Statement kPause = {
    .word = "PAUSE",
    .signature = "...",
    .help = "Waits for the operator (not in the standard). Accepted with a warning: it has no effect.",
    .example = "PAUSE",
    .source = "production programs",
    .lower = no_effect,
};
const Statement kRead = {
    .word = "READ",
    .signature = "device:label, ...",
    .help = "Reads values from a file. An error: give them with ASSIGN or PROMPT instead.",
    .example = "READ/DID(IN),X,Y",
    .source = "ISO 22093, READ",
    .lower = read_file,
};
const Statement kWrite = {
    .word = "WRITE",
    .signature = "device:label, ...",
    .help = "Writes to a file. Skipped, with one warning: no file is written.",
    .example = "WRITE/DID(OUT),'bore ',X",
    .source = "ISO 22093, WRITE",
    .lower = write_file,
};

}  // namespace abbe::lang
