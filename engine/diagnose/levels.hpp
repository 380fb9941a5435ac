// The levels at which a diagnosis decides, one for all of its steps.
#pragma once

namespace abbe::diagnose {

/// False alarms that a diagnosis allows itself.
inline constexpr double kAlarm = 0.01;
/// Probability that a set of names must reach. Names come whole, so that sets have more than they must: enough to hold
/// the truth in 95 of 100 recordings (docs/evidence.md).
inline constexpr double kCredible = 0.92;
/// Up to so many times less likely, what was not chosen is told beside what was.
inline constexpr double kAsWell = 3;
/// What can be seen or named is so in this share of recordings: so many standard deviations beyond the limit.
inline constexpr double kPowerShare = 0.8;
inline constexpr double kPowerDeviations = 0.84;

}  // namespace abbe::diagnose
