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

/// Signal-to-noise at which a search over the whole catalogue detects about half, and names. Where it must be known
/// more closely it is simulated (model/power.hpp).
inline constexpr double kDetects = 4.5, kNames = 5.5;
/// Share of the information beyond which nothing is left to tell two effects apart.
inline constexpr double kInseparable = 0.03;
/// Correlation of two signatures, beside all unknowns, from which on they are called confounded.
inline constexpr double kConfounded = 0.7;

/// Scatter of all touches over the probe's specification from which on it is worth telling: a ratio of standard deviations.
inline constexpr double kLeastExcess = 1.6;
/// Standard uncertainty of rounding over the noise from which on it counts beside that, and is told.
inline constexpr double kLeastRounding = 0.3;

/// Steps of the readings that a signal period must have to be seen in them: its second harmonic has four then.
inline constexpr double kLeastStepsInPeriod = 8;

}  // namespace abbe::diagnose
