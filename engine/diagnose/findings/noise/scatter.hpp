// How unequal scatter is judged: of a recording (judge_noise.hpp), and of a plan (scatter_design.hpp).
//
// Residuals that are each predicted from all other touches are nearly independent, with a variance of 1 when the noise
// is what was fitted. A model of the variance is judged by what it gains in likelihood over equal ones.
#pragma once

#include <optional>
#include <utility>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// The kinds of groups of touches (touch_groups.cpp).
inline constexpr int kGroupKinds = 8;
/// The looks at the scatter: at each kind of group, along three axes, at all touches, at outliers.
inline constexpr int kLooks = kGroupKinds + 3 + 1 + 1;
/// Together they may not cost more false alarms than a tenth of what the search allows itself.
inline constexpr double kNoiseAlarm = kAlarm / 10 / kLooks;

struct Residuals {
  Vector standardised;  ///< variance 1 under the fitted noise
  double noise_um = 1;  ///< that noise
  double tails = 1;     ///< by how much squares scatter more than those of normal residuals
  Matrix coupling;      ///< squares of their correlations: what is common to many rows counts less
};

/// Variances 1 + size * share, times a common factor.
struct Excess {
  double size = 0;
  double chi2 = 0;  ///< twice what they gain over equal ones, of one degree of freedom
};
Excess excess_along(const Residuals&, const Vector& share);

/// How much of the variance along the normal is along an axis. Nothing where the normals do not differ in it.
std::optional<Vector> share_along(const Case&, int axis);

/// How many times the variance of a sum of squares over rows is that of as many independent normal residuals: tails and
/// correlations.
double inflation(double tails, const Matrix& coupling, const Vector& rows);

/// The probability that equal variances gain so much: size is never below 0, so half a chi-squared law.
double chance_of_excess(double chi2);
/// Of a ratio to the probe's specification as large as this where the true one is what is worth telling; `relative_u`: its
/// relative standard uncertainty. Squares of so uncertain a ratio have the law of chi-squared (Wilson & Hilferty 1931).
double chance_of_ratio(double ratio, double relative_u);

/// Repeats of one touch, with the same stylus at the same place, among rows of which more than half counts: the first
/// and a later one. Where there are enough of them, they tell scatter from a pattern too fine for the recording.
std::vector<std::pair<Eigen::Index, Eigen::Index>> repeats_in(const Case&, const Vector& in);
inline constexpr int kEnoughRepeats = 20;
/// Of the share of the variance that is new: what repeats may have in common at most.
inline constexpr double kInCommon = 0.5;

}  // namespace abbe::diagnose
