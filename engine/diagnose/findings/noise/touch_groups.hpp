// Groups of touches of which one may scatter more than the others: what was measured with, where the head stood, how fast,
// which surface, which placement, when.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/diagnosis.hpp"
#include "engine/diagnose/findings/noise/scatter.hpp"

namespace abbe::diagnose {

/// A group of noise.unequal.
struct TouchGroup {
  const char* kind;                           ///< as the effect has it
  std::string touches;                        ///< in words: "touches with long styli"
  std::pair<std::string, std::string> where;  ///< of a location
  Factor factor;
  Vector in;                              ///< by touch, 1: in the group
  std::vector<DiagnosedParameter> which;  ///< parameters of the effect that part it from the others
  int of_its_kind = 1;  ///< the groups of one kind are one look: the chance of each counts so many times
};

/// All that have enough touches, and leave enough. One that holds the same touches as another is left out.
std::vector<TouchGroup> touch_groups(const Case&);

/// Of those touches that take part.
Vector among_rows(const Case&, const Vector& by_touch);

/// A group that scatters more by less than chance.
struct NoisyGroup {
  TouchGroup group;
  Excess excess;
  double p = 1;
  double ratio = 1, u = 0;  ///< of standard deviations, and its standard uncertainty
};
/// The one that chance explains least.
std::optional<NoisyGroup> noisiest(const Case&, const Residuals&);

/// Dirt strikes any touch. The group that gross outliers strike more often than by chance, if there is one: it scatters more,
/// rather.
std::optional<TouchGroup> struck_most(const Case&);

/// Standard uncertainty of a ratio of standard deviations over that ratio. `in`: by row.
double relative_u(const Vector& in);
/// From where on a ratio of standard deviations is worth telling.
inline constexpr double kLeastRatio = 1.1;
/// Touches that a group, and the others, must have at least.
inline constexpr int kEnoughOfGroup = 20;

}  // namespace abbe::diagnose
