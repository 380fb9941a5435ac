#include "lang/blocks.hpp"

#include <array>

namespace abbe::lang {

std::span<const Block> blocks() {
  static constexpr std::array table = {
      Block{"MEAS", "", "ENDMES"},       Block{"RMEAS", "", "ENDMES"},  Block{"CALIB", "", "ENDMES"},
      Block{"GOTARG", "", "ENDGO"},      Block{"MACRO", "", "ENDMAC"},  Block{"IF", "ELSE", "ENDIF"},
      Block{"DO", "", "ENDDO"},          Block{"SELECT", "", "ENDSEL"}, Block{"CASE", "", "ENDCAS"},
      Block{"DFTCAS", "", "ENDCAS"},     Block{"XTERN", "", "ENDXTN"},  Block{"CRGDEF", "", "ENDCRG"},
      Block{"SIMREQT", "", "ENDSIMREQT"}};
  return table;
}

Nesting nesting_of(const RawStatement& statement) {
  for (const Block& block : blocks()) {
    if (statement.word.empty()) break;
    if (statement.word == block.begin) return {0, 1};
    if (statement.word == block.middle) return {-1, 1};
    if (statement.word == block.end) return {-1, 0};
  }
  return {};
}

}  // namespace abbe::lang
