// The list of statements. A new statement is one constant in a file of this folder and one name
// here.
#include <array>

#include "lang/statement.hpp"

namespace abbe::lang {

extern const Statement kDmismn, kFilnam, kEndfil, kUnits, kDecpl, kMode, kPrcomp, kSnset, kFedrat, kAclrat, kFly,
    kFinpos, kWkplan, kGeoalg, kTecomp, kSnsmnt, kSnsdef, kSnslct, kFeat, kConst, kMeas, kRmeas, kCalib, kPtmeas, kGoto,
    kFrom, kGohome, kEndmes, kDatdef, kDatset, kTrans, kRotate, kSave, kRecall, kTol, kOutput, kEval, kText, kDisply,
    kDevice, kOpen, kClose, kVform, kDmesw, kPause, kRead, kWrite, kDecl, kAssign, kObtain, kPrompt, kValue, kIf, kElse,
    kEndif, kDo, kEnddo, kSelect, kCase, kDftcas, kEndcas, kEndsel, kJumpto, kMacro, kEndmac, kCall, kInclud, kXtern,
    kExtfil, kEndxtn, kDmismd, kPartid, kPartrv, kPartsn, kLotid, kPlanid, kProcid, kPrevop, kOperid, kMfgdev, kDmeid,
    kDmeswi, kDmeswv, kFixtid, kFixtsn, kClmpid, kClmpsn, kQisdef;

std::span<const Statement* const> statements() {
  static constexpr std::array list = {
      // the frame of a program
      &kDmismn, &kFilnam, &kEndfil, &kUnits, &kMode, &kDmesw,
      // the machine
      &kPrcomp, &kSnset, &kFedrat, &kAclrat, &kFly, &kFinpos, &kWkplan, &kGeoalg, &kTecomp, &kSnsmnt, &kSnsdef,
      &kSnslct,
      // measuring
      &kFeat, &kMeas, &kRmeas, &kCalib, &kPtmeas, &kEndmes, &kGoto, &kFrom, &kGohome, &kConst,
      // coordinate systems
      &kDatdef, &kDatset, &kTrans, &kRotate, &kSave, &kRecall,
      // results
      &kTol, &kOutput, &kEval,
      // values
      &kDecl, &kAssign, &kObtain, &kPrompt, &kValue,
      // control
      &kIf, &kElse, &kEndif, &kDo, &kEnddo, &kSelect, &kCase, &kDftcas, &kEndcas, &kEndsel, &kJumpto, &kMacro, &kEndmac,
      &kCall, &kInclud, &kXtern, &kExtfil, &kEndxtn, &kDmismd,
      // what identifies
      &kPartid, &kPartrv, &kPartsn, &kLotid, &kPlanid, &kProcid, &kPrevop, &kOperid, &kMfgdev, &kDmeid, &kDmeswi,
      &kDmeswv, &kFixtid, &kFixtsn, &kClmpid, &kClmpsn, &kQisdef,
      // understood and skipped
      &kText, &kDisply, &kDevice, &kOpen, &kClose, &kVform, &kDecpl, &kPause, &kRead, &kWrite};
  return list;
}

const Statement* find_statement(std::string_view word) {
  for (const Statement* statement : statements())
    if (statement->word == word) return statement;
  return nullptr;
}

}  // namespace abbe::lang
