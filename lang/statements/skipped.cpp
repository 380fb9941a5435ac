// Statements without meaning for a virtual machine: understood, kept in the tree, skipped without
// noise; and those whose effect is not modelled, which say so.
#include <fmt/format.h>

#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

void skip(Lowering&, const RawStatement&, const Match&) {}

void no_effect(Lowering& lowering, const RawStatement& raw, const Match&) {
  lowering.warn(Code::W0122, raw.span, fmt::format("{} has no effect here yet", raw.word),
                "the results are those without it");
}

}  // namespace

extern const Statement kFilnam, kDisply, kText, kDevice, kOpen, kClose, kVform, kDecpl, kFinpos,
    kWkplan, kPause;

const Statement kFilnam = {"FILNAM",
                           "",
                           "name:text, [ version:number ]",
                           "Names the result file. Skipped.",
                           "FILNAM/'results',5.2",
                           "ISO 22093, FILNAM",
                           skip};
const Statement kDisply = {"DISPLY",
                           "",
                           "...",
                           "Where results are shown. Skipped.",
                           "DISPLY/TERM,DMIS",
                           "ISO 22093, DISPLY",
                           skip};
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
const Statement kOpen = {"OPEN",
                         "",
                         "device:label, ...",
                         "Opens a device. Skipped.",
                         "OPEN/DID(OUT),FDATA,DMIS,OUTPUT",
                         "ISO 22093, OPEN",
                         skip};
const Statement kClose = {"CLOSE",
                          "",
                          "device:label, ...",
                          "Closes a device. Skipped.",
                          "CLOSE/DID(OUT)",
                          "ISO 22093, CLOSE",
                          skip};
const Statement kVform = {
    "VFORM", "*", "...", "Form of a report. Skipped.", "V(R)=VFORM/ALL", "ISO 22093, VFORM", skip};
const Statement kDecpl = {
    "DECPL",
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
    "PAUSE",
    "",
    "...",
    "Waits for the operator (not in the standard). Accepted with a warning: it has no effect.",
    "PAUSE",
    "production programs",
    no_effect};

}  // namespace abbe::lang
