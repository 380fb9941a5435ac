// How unequal scatter is judged: of a recording (noise_effects.cpp), and of a plan (planning/noise_design.cpp).
//
// Residuals that are each predicted from all other touches are nearly independent, with a variance of 1 when the noise
// is what was fitted. A model of the variance is judged by what it gains in likelihood over equal ones.
#pragma once

#include <utility>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// The looks at the scatter: four kinds of groups, three axes, all touches, outliers.
inline constexpr int kLooks = 9;
/// Together they may not cost more false alarms than a tenth of what the search allows itself.
inline constexpr double kNoiseAlarm = kAlarm / 10 / kLooks;

/// From where on a difference is worth telling: of a group, along an axis, and of all touches over the probe's
/// specification; as ratios of standard deviations.
inline constexpr double kLeastRatio = 1.1, kLeastAlong = 1.2, kLeastExcess = 1.6;
/// Touches that a group, and the others, must have at least.
inline constexpr int kEnoughOfGroup = 20;
/// By how much outliers lie in the mean beyond the limit from which on they are left out: the ends of a pattern that the
/// search has missed are just beyond it.
inline constexpr double kFarOut = 1.5;

/// Standard uncertainty of rounding over the noise from which on it counts beside that, and is told.
inline constexpr double kLeastRounding = 0.3;

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

/// How many times the variance of a sum of squares over rows is that of as many independent normal residuals: tails and
/// correlations.
double inflation(double tails, const Matrix& coupling, const Vector& rows);

/// The probability that equal variances gain so much: size is never below 0, so half a chi-squared law.
double chance_of_excess(double chi2);
/// Of a ratio to the probe's specification as large as this where the true one is what is worth telling; `relative_u`: its
/// relative standard uncertainty. Squares of so uncertain a ratio have the law of chi-squared (Wilson & Hilferty 1931).
double chance_of_ratio(double ratio, double relative_u);

/// A group of noise.unequal.
struct Split {
  const char* group;
  std::string touches;                        ///< in words: "touches with long styli"
  std::pair<std::string, std::string> where;  ///< of a location
  Factor factor;
  Vector in;                              ///< 1: in the group
  std::vector<DiagnosedParameter> which;  ///< parameters of the effect that part it from the others
  int of_its_kind = 1;  ///< the groups of one kind are one look: the chance of each counts so many times
};
/// All of them; a group that these touches do not part is empty or holds all.
std::vector<Split> splits_of(const Case&);
inline bool parts(const Split& s) {
  return s.in.sum() >= kEnoughOfGroup && double(s.in.size()) - s.in.sum() >= kEnoughOfGroup;
}
/// Standard uncertainty of a ratio of standard deviations over that ratio.
double relative_u(const Split&);

/// How much of the variance along the normal is along an axis. Nothing where the normals do not differ in it.
std::optional<Vector> share_along(const Case&, int axis);

/// Repeats of one touch, with the same stylus at the same place, among rows of which more than half counts: the first
/// and a later one. Where there are enough of them, they tell scatter from a pattern too fine for the recording.
std::vector<std::pair<Eigen::Index, Eigen::Index>> repeats_in(const Case&, const Vector& in);
inline constexpr int kEnoughRepeats = 20;
/// Of the share of the variance that is new: what repeats may have in common at most.
inline constexpr double kInCommon = 0.5;

}  // namespace abbe::diagnose
