// Whether a periodic error of a scale can be told from something that depends on the direction of the touch alone.
#pragma once

#include <vector>

#include "engine/diagnose/model/linear.hpp"
#include "engine/run/recorded/touch.hpp"

namespace abbe::diagnose {

/// Touches of one direction at different places of a recording.
class SameDirection {
 public:
  SameDirection(const RecordedTouches&, const std::vector<int>& rows);

  /// Whether a signature (of these rows) is a function of the normal here: wherever two places were touched in the same
  /// direction, it is the same. Of a period of a scale, the readings were at the same phase then; balls at round heights,
  /// all touched alike, and step gauges do that.
  bool is_alike(const Matrix& signature) const;

 private:
  std::vector<std::vector<Eigen::Index>> directions_;
};

}  // namespace abbe::diagnose
