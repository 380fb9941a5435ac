// Rows that were copied and called repeats: nothing was measured again.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/recording/recording.hpp"

namespace abbe {

/// Two groups of rows of which the smaller stands in the larger.
struct Copied {
  int earlier = 0, later = 0;
};

/// The first two groups of which nine tenths of the smaller stand in the other one, feature, touch and position to the last
/// digit. `group`: of each row, from 0. Not told of groups with fewer rows than `fewest`, of rows that hold their targets,
/// and where all positions are multiples of a step from which on they repeat by themselves (1.5 um).
std::optional<Copied> copied_group(const std::vector<const RecordingRow*>& rows, const std::vector<int>& group,
                                   std::size_t fewest = 1);

}  // namespace abbe
