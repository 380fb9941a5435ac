// Statements without meaning for a virtual machine: understood, kept in the tree, skipped without
// noise; and those whose effect is not modelled, which say so.
#include <fmt/format.h>

#include "lang/statement.hpp"

namespace abbe::lang {

void skip(Lowering&, const RawStatement&, const Match&) {}

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

void write_file(Lowering& lowering, const RawStatement& raw, const Match&) {
  if (!lowering.reported_words.insert(raw.word).second) return;
  lowering.warn(Code::W0122, raw.word_span, "WRITE makes no file here and is skipped wherever it stands",
                "results: `abbe run --csv`, `--dmo` or `--format json`");
}

}  // namespace

extern const Statement kFilnam, kDisply, kText, kDevice, kOpen, kClose, kVform, kDecpl, kFinpos, kWkplan, kPause, kRead,
    kWrite;

const Statement kFilnam = {"FILNAM",
                           "",
                           "name:text, [ version:number ]",
                           "Names the result file: what --dmo writes begins with it.",
                           "FILNAM/'results',5.2",
                           "ISO 22093, FILNAM",
                           name_result};
const Statement kDisply = {
    "DISPLY", "", "...", "Where results are shown. Skipped.", "DISPLY/TERM,DMIS", "ISO 22093, DISPLY", skip};
const Statement kText = {"TEXT",
                         "",
                         "to:OPER|MAN|OUTFIL|QUERY, ...",
                         "Text for the operator or the result file. Skipped.",
                         "TEXT/OUTFIL,'bore'",
                         "ISO 22093, TEXT",
                         skip};
const Statement kDevice = {"DEVICE",
                           "*",
                           "kind:word, ...",
                           "Names a device. Skipped.",
                           "DID(OUT)=DEVICE/STOR,'results.dmo'",
                           "ISO 22093, DEVICE",
                           skip};
const Statement kOpen = {
    "OPEN", "", "device:label, ...", "Opens a device. Skipped.", "OPEN/DID(OUT),FDATA,DMIS,OUTPUT", "ISO 22093, OPEN",
    skip};
const Statement kClose = {
    "CLOSE", "", "device:label, ...", "Closes a device. Skipped.", "CLOSE/DID(OUT)", "ISO 22093, CLOSE", skip};
const Statement kVform = {"VFORM", "*", "...", "Form of a report. Skipped.", "V(R)=VFORM/ALL", "ISO 22093, VFORM",
                          skip};
const Statement kDecpl = {"DECPL",
                          "*",
                          "...",
                          "Decimal places of results. Skipped: reports show what the uncertainty allows.",
                          "DECPL/ALL,DV(3)",
                          "ISO 22093, DECPL",
                          skip};
const Statement kFinpos = {"FINPOS",
                           "",
                           "state:ON|OFF",
                           "Fine positioning. Skipped: it is part of the machine's specification.",
                           "FINPOS/ON",
                           "ISO 22093, FINPOS",
                           skip};
const Statement kWkplan = {
    "WKPLAN",
    "",
    "plane:XYPLAN|YZPLAN|ZXPLAN",
    "Working plane. Every feature here carries its own vector, so nothing depends on it. Skipped.",
    "WKPLAN/XYPLAN",
    "ISO 22093, WKPLAN",
    skip};
const Statement kPause = {
    "PAUSE",  "",
    "...",    "Waits for the operator (not in the standard). Accepted with a warning: it has no effect.",
    "PAUSE",  "production programs",
    no_effect};
const Statement kRead = {"READ",
                         "",
                         "device:label, ...",
                         "Reads values from a file. An error: give them with ASSIGN or PROMPT instead.",
                         "READ/DID(IN),X,Y",
                         "ISO 22093, READ",
                         read_file};
const Statement kWrite = {"WRITE",
                          "",
                          "device:label, ...",
                          "Writes to a file. Skipped, with one warning: no file is written.",
                          "WRITE/DID(OUT),'bore ',X",
                          "ISO 22093, WRITE",
                          write_file};

}  // namespace abbe::lang
