// The major words of ISO 22093:2011 and of the older editions that programs still use.
#include <algorithm>
#include <array>

#include "lang/statement.hpp"

namespace abbe::lang {

std::span<const std::string_view> standard_words() {
  using namespace std::string_view_literals;
  static constexpr std::array words = {
      "ACLRAT"sv,    "ALGDEF"sv,     "ASSIGN"sv, "BADTST"sv,   "BOUND"sv,    "CALIB"sv,  "CALL"sv,   "CASE"sv,
      "CLMPID"sv,    "CLMPSN"sv,     "CLOSE"sv,  "CMPNTGRP"sv, "CNFRMRUL"sv, "CONST"sv,  "CRGDEF"sv, "CRMODE"sv,
      "CROSCL"sv,    "CRSLCT"sv,     "CUTCOM"sv, "CZONE"sv,    "CZSLCT"sv,   "DATDEF"sv, "DATSET"sv, "DATTRGDEF"sv,
      "DECL"sv,      "DECPL"sv,      "DELETE"sv, "DEVICE"sv,   "DFTCAS"sv,   "DISPLY"sv, "DMEHW"sv,  "DMEID"sv,
      "DMESW"sv,     "DMESWI"sv,     "DMESWV"sv, "DMISMD"sv,   "DMISMN"sv,   "DO"sv,     "ELSE"sv,   "ENDAT"sv,
      "ENDCAS"sv,    "ENDCRG"sv,     "ENDDO"sv,  "ENDFIL"sv,   "ENDGO"sv,    "ENDIF"sv,  "ENDMAC"sv, "ENDMES"sv,
      "ENDSEL"sv,    "ENDSIMREQT"sv, "ENDXTN"sv, "EQUATE"sv,   "ERROR"sv,    "EVAL"sv,   "EXTENS"sv, "EXTFIL"sv,
      "FEAT"sv,      "FEDRAT"sv,     "FILDEF"sv, "FILNAM"sv,   "FINPOS"sv,   "FIXTID"sv, "FIXTSN"sv, "FLY"sv,
      "FROM"sv,      "GECOMP"sv,     "GEOALG"sv, "GEOM"sv,     "GOHOME"sv,   "GOTARG"sv, "GOTO"sv,   "GROUP"sv,
      "IF"sv,        "INCLUD"sv,     "ITERAT"sv, "JUMPTO"sv,   "KEYCHAR"sv,  "LITDEF"sv, "LOCATE"sv, "LOTID"sv,
      "MACRO"sv,     "MATDEF"sv,     "MEAS"sv,   "MFGDEV"sv,   "MODE"sv,     "OBTAIN"sv, "OPEN"sv,   "OPERID"sv,
      "OUTPUT"sv,    "PAMEAS"sv,     "PARTID"sv, "PARTRV"sv,   "PARTSN"sv,   "PATH"sv,   "PLANID"sv, "POP"sv,
      "PRCOMP"sv,    "PREVOP"sv,     "PROCID"sv, "PROMPT"sv,   "PSTHRU"sv,   "PTBUFF"sv, "PTMEAS"sv, "PUSH"sv,
      "QISDEF"sv,    "RAPID"sv,      "READ"sv,   "RECALL"sv,   "REFMNT"sv,   "REPORT"sv, "RESUME"sv, "RMEAS"sv,
      "ROTAB"sv,     "ROTATE"sv,     "ROTDEF"sv, "ROTSET"sv,   "SAVE"sv,     "SCAN"sv,   "SCNMOD"sv, "SCNPLN"sv,
      "SCNSET"sv,    "SELECT"sv,     "SENSOR"sv, "SGAGE"sv,    "SIMREQT"sv,  "SNSDEF"sv, "SNSET"sv,  "SNSGRP"sv,
      "SNSLCT"sv,    "SNSMNT"sv,     "TECOMP"sv, "TEXT"sv,     "THLDEF"sv,   "TOL"sv,    "TOOLDF"sv, "TRANS"sv,
      "UNCERTALG"sv, "UNCERTSET"sv,  "UNITS"sv,  "VALUE"sv,    "VFORM"sv,    "WINDEF"sv, "WKPLAN"sv, "WRIST"sv,
      "WRITE"sv,     "XTERN"sv,      "XTRACT"sv};
  return words;
}

bool is_standard_word(std::string_view word) {
  const auto words = standard_words();
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace abbe::lang
