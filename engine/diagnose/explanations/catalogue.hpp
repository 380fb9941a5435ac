// From the registry of effects, and the patterns beside it, to the explanations of a recording.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/model/explanation.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// Covariates that have an assumed value where nobody logged them, so that what they act on stays an explanation.
inline constexpr unsigned kMayBeAssumed = Covariate::part_temperature | Covariate::scale_temperature | Covariate::load;

/// Every explanation for these touches but those that look at raw readings, which are added once the readings
/// are free of noise (own_noise.cpp); `rows`: which touches take part.
Explanations explanations_without_readings(const RecordedTouches&, const std::vector<int>& rows);
/// `step_um`: of the recorded positions. What their rounding does is periodic in the readings too, and so
/// nothing is sought within a few steps.
void add_explanations_of_readings(const RecordedTouches&, const std::vector<int>& rows, double step_um, Explanations&);

/// What cannot be judged, in the order of the catalogue, with the columns that are missing.
std::vector<CannotJudge> cannot_judge(const Explanations&);

/// Adds the effects that could be judged but would not show at any size, as what is unknown of the part hides them.
void add_hidden(const Explanations&, Diagnosis&);

/// The effects of these names only, in the order of the names.
Explanations named_explanations(const RecordedTouches&, const std::vector<int>& rows,
                                const std::vector<std::string>& names);

/// A variant of an effect with the parameters, the group and the change of another; no columns where the effect does
/// nothing there.
Variant variant_like(const Variant&, const Effect&, const RecordedTouches&, const std::vector<int>& rows);

/// Whether a parameter of a variant would do anything else to these touches at another of the values that are tried: where a
/// step lies along an axis, it has no moment.
bool matters(const Variant&, const Effect&, std::size_t parameter, const std::vector<TriedValue>& tried,
             const RecordedTouches&, const std::vector<int>& rows);

}  // namespace abbe::diagnose
