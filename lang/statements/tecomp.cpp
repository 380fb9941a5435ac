// TECOMP: temperature compensation by the controller. What it reckons with (coefficients, errors of the
// sensors) stands in the workpiece file, because a virtual machine has to know the true values as well.
#include "lang/statement.hpp"

namespace abbe::lang {

namespace {

void tecomp(Lowering& lowering, const RawStatement& raw, const Match& match) {
  if (match.used < raw.arguments.size())
    lowering.warn(Code::W0122, raw.span, "the coefficients and sensors of TECOMP have no effect here",
                  "what the compensation reckons with stands in the workpiece file, \"compensation\"");
  lowering.emit(plan::SetTemperatureCompensation{match.text("state") == "ON"});
}

}  // namespace

extern const Statement kTecomp;
const Statement kTecomp = {
    .word = "TECOMP",
    .label = "*",
    .signature = "[ scope:MACH|PART ], state:ON|OFF, ...",
    .help =
        "Switches temperature compensation. It acts when a workpiece file says how warm part and scales are; the coefficients that it "
        "reckons with stand there.",
    .example = "TECOMP/ON",
    .source = "ISO 22093, TECOMP",
    .lower = tecomp,
    .doubt = Doubt::setting,
};

}  // namespace abbe::lang
