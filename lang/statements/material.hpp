// MMC and LMC of TOL: which features widen the zone of a characteristic (engine/tolerances/material.hpp
// says how).
//
// The tolerance of size comes from the statement that evaluates: the one that names the geometric
// tolerance, or an earlier OUTPUT or EVAL of the same feature. So OUTPUT/FA(H),TA(SIZE),TA(POS) is
// complete, and so is a datum whose size was evaluated when it was measured. Where there is none,
// conformity is judged without the bonus, which is the safe side, and a warning says so.
#pragma once

#include <vector>

#include "lang/lowering.hpp"

namespace abbe::lang {

/// Notes that the tolerance of size `id` is evaluated of `feature`; tolerances of other kinds are
/// passed over.
void remember_size(Lowering&, plan::FeatureId feature, plan::ToleranceId id);

/// What MMC and LMC in `symbol`, evaluated of `feature`, come to; `use` is where it is evaluated.
std::vector<plan::MaterialCondition> material_conditions(Lowering&, const ToleranceSymbol& symbol,
                                                         plan::FeatureId feature, const MatchedValue& use);

}  // namespace abbe::lang
