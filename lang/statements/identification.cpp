// Statements that identify: which part, on which machine, by whom, with what. They stand at the head of production
// programs and results. Nothing that is simulated depends on them; OUTPUT may name their labels.
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

constexpr Statement identifies(std::string_view word, std::string_view help, std::string_view example) {
  return {.word = word,
          .label = "*",
          .signature = "...",
          .help = help,
          .example = example,
          .source = "ISO 22093, identification of measurements",
          .lower = skip};
}

}  // namespace

extern const Statement kPartid, kPartrv, kPartsn, kLotid, kPlanid, kProcid, kPrevop, kOperid, kMfgdev, kDmeid, kDmeswi,
    kDmeswv, kFixtid, kFixtsn, kClmpid, kClmpsn, kQisdef;

const Statement kPartid = identifies("PARTID", "Names the part. Skipped.", "PN(1)=PARTID/'housing'");
const Statement kPartrv = identifies("PARTRV", "Revision of the part. Skipped.", "PR(1)=PARTRV/'C'");
const Statement kPartsn = identifies("PARTSN", "Serial number of the part. Skipped.", "PS(1)=PARTSN/'0815'");
const Statement kLotid = identifies("LOTID", "Names the lot. Skipped.", "LI(1)=LOTID/'week 12'");
const Statement kPlanid = identifies("PLANID", "Names the inspection plan. Skipped.", "PL(1)=PLANID/'IP-7'");
const Statement kProcid = identifies("PROCID", "Names the inspection procedure. Skipped.", "PC(1)=PROCID/'first part'");
const Statement kPrevop = identifies("PREVOP", "Names the operation before. Skipped.", "PV(1)=PREVOP/'milling'");
const Statement kOperid = identifies("OPERID", "Names the operator. Skipped.", "OP(1)=OPERID/'second shift'");
const Statement kMfgdev =
    identifies("MFGDEV", "Names the machine that made the part. Skipped.", "MD(1)=MFGDEV/'mill 3'");
const Statement kDmeid = identifies("DMEID", "Names the measuring machine. Skipped.", "DI(1)=DMEID/'CMM 2'");
const Statement kDmeswi =
    identifies("DMESWI", "Names the software of the measuring machine. Skipped.", "DS(1)=DMESWI/'Abbe'");
const Statement kDmeswv = identifies("DMESWV", "Version of that software. Skipped.", "DV(1)=DMESWV/'4.0'");
const Statement kFixtid = identifies("FIXTID", "Names the fixture. Skipped.", "FI(1)=FIXTID/'plate'");
const Statement kFixtsn = identifies("FIXTSN", "Serial number of the fixture. Skipped.", "FS(1)=FIXTSN/'12'");
const Statement kClmpid = identifies("CLMPID", "Names the clamp. Skipped.", "CI(1)=CLMPID/'vice'");
const Statement kClmpsn = identifies("CLMPSN", "Serial number of the clamp. Skipped.", "CS(1)=CLMPSN/'3'");
const Statement kQisdef =
    identifies("QISDEF", "A quality information item: a keyword and its text. Skipped.", "Q(1)=QISDEF/'ORDER','4711'");

}  // namespace abbe::lang
