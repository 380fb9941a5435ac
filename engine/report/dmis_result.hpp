// The result file of a machine in the form of ISO 22093: under the name that FILNAM gives it, or else that of
// the program, what each OUTPUT statement reports, features as FA, tolerances as TA, coordinate systems as
// DA. Sensors and reports are only named.
//
// Coordinates are in the system current at the OUTPUT statement, lengths mm, angles decimal degrees, whatever
// the program's own units. FA repeats the form of FEAT with the actual values. TA of a tolerance with one
// value is `word[,qualifier],value,INTOL|OUTOL`; distances put the status before NOMINL, as real result files
// do (DISTB, DISTWRT). DA is DATSET/TRMATX with the nine elements of R by rows and the origin t: p = R (p_mcs
// - t).
//
// What the standard has no place for, the uncertainty, stands in comments of a fixed form, behind the TA it
// belongs to, so that any reader of DMIS passes over it (lengths mm, angles degrees; lcl and ucl relative to
// the value of the error-free machine):
//
//   $$! u TA(LEN) 0.00052 lcl -0.00101 ucl 0.00104 conforms 0.98
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/run_report.hpp"
#include "engine/run/run.hpp"

namespace abbe {

/// `reports`: of the study that the records belong to; none: without uncertainties.
std::string dmis_result(const plan::Plan&, const std::vector<OutputRecord>&,
                        std::span<const CharacteristicReport> reports = {});

}  // namespace abbe
