// Whether a name is of one size wherever it shows. An effect that is there is. Physics that only looks like it, at some
// places, at some times or with some styli, is larger there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// The factor over which the size of a name differs most. Touches are grouped by each factor: in thirds along it, or as
/// they were touched.
struct SizeDifference {
  Factor factor = Factor::position;
  std::vector<int> group;  ///< by row of the model
  double p = 1;            ///< that chance makes sizes differ so much over any of the factors
  double share = 0;        ///< what a size for each group explains beyond the name, of what the name explains
  /// The groups of which the size is largest and smallest, relative to that of all touches, of those that tell it: where,
  /// size and standard uncertainty.
  struct Size {
    std::string where;
    double times = 1, u = 0;
  };
  Size largest, smallest;
};

/// The laws of the catalogue are simpler than the world, and where the placement of the part takes up most of an effect,
/// touches tell a hundredth of its size: sizes that are nearer to one another, or explain a smaller share, are one.
inline constexpr double kApart = 0.5, kOneSize = 0.1;
/// Of the name with the signature `which` of all that was found. Nothing where it is of one size, or shows in one
/// group of each factor only.
std::optional<SizeDifference> size_difference(const Case&, const std::vector<const Matrix*>& found, std::size_t which,
                                              const Hyperparameters&);
/// Whether that is hardly chance.
bool of_several_sizes(const std::optional<SizeDifference>&);

/// "differs: 1.8 ± 0.3 times that of all touches at x 20 to 140 mm, 0.1 ± 0.2 times at x 300 to 420 mm"
std::string in_words(const SizeDifference&);

}  // namespace abbe::diagnose
