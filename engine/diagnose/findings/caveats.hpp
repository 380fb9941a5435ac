// What is said beside a name for those who might take it for more than the recording tells: sentences with a blank in
// front, "" where there is nothing to say.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/findings/search.hpp"

namespace abbe::diagnose {

/// A pattern without a name explains the finding as well.
std::string pattern_beside(const Case&, const Finding&);

/// What is there is of one size wherever it shows; this is not.
std::string not_of_one_size(const Finding&);

/// Beside it the machine's errors would have to be so many times those of its specification.
std::string beside_large_errors(double times);

/// Where no program says how the part lies, what an effect does there is told in coordinates that no other program shares.
std::string whose_coordinates(const Case&, const Effect&);

/// Of an effect that has no law but a spread: what would tell it from the others that look like it.
std::string much_like_it(const Effect&);

/// In which frame the direction of an effect of the probe is told: those of other effects are in the machine's.
std::string whose_direction(const Effect&);

/// With which expansion coefficient a temperature was reckoned, where the effect has one and a temperature is told.
std::string whose_coefficient(const Effect&, const std::vector<DiagnosedParameter>& told);

/// What another parameter of the effect would have to be to do nearly the same to these touches as the only one that is
/// told: at one temperature a wrong coefficient does what a wrong sensor does.
std::string what_does_nearly_the_same(const Effect&, const Variant&, const std::vector<DiagnosedParameter>& told);

/// Without a clock, moments and rates are those of the motion model.
std::string whose_clock(const Case&, const Effect&);

/// Whether the size of a parameter that is told goes by a value that nobody logged: which columns are missing.
std::string whose_surroundings(const Case&, const Effect&, const Variant&, const std::vector<DiagnosedParameter>& told);

/// That the part may have been warmer in one placement, where nobody logged how warm it was.
std::string warmer_in_one_placement(const Case&);
/// The same beside what the part does in one placement only.
std::string warmer_in_one_placement(const Case&, const Effect&, const Variant&);

/// The note, or "" where one of these has it already: an answer says once what holds for several of its effects.
std::string unless_said(const std::vector<DiagnosedEffect>&, const std::string& note);

inline constexpr const char* kNearlyCancelled =
    " What it does is nearly undone by what else was found: two large faults that cancel each other are seldom, and one of "
    "another kind may do what is left of them. Mend neither before a measurement shows it by itself.";

inline constexpr const char* kNoneIsSure =
    " None of its sizes by itself is surely other than 0: together they may stand in for something else.";

inline constexpr const char* kSeldomNew =
    " A part seldom changes its form between two runs: a tip that was changed or damaged in between may look like it. Touch "
    "the same places in another orientation of the head, or with the tip that was used before.";

inline constexpr const char* kSeenOnce =
    " Fewer than two periods of it were recorded: what came once and went, as through an open door, looks the same. Record for longer.";

inline constexpr const char* kSamePhase =
    " Wherever touches have the same direction, the scale was at the same phase: a pattern over direction would look the "
    "same. Repeat it with the part moved by a third of the period.";

inline constexpr const char* kUnproven =
    " It is believed by half at most, because touches that the model had not seen are predicted better by no more than chance may do.";

/// Whether what displaces touches by `largest_um` at most may be the rounding of positions: by less than their step, where
/// that counts for more than the noise of the probe. One point touched again is rounded alike each time.
bool may_be_rounding(const Case&, const std::optional<double>& largest_um);

}  // namespace abbe::diagnose
