#include "engine/run/part_frame.hpp"

#include <utility>
#include <vector>

#include "engine/math/rigid_fit.hpp"

namespace abbe {

PartFrames::PartFrames(const Recording& recording) {
  std::map<int, std::map<std::pair<std::string, int>, Vec3>> targets;
  for (const RecordingRow& row : recording.rows) targets[row.setup][{row.feature, row.touch}] = *row.target_mm;
  const auto& first = targets.begin()->second;
  Vec3 centre;
  for (const auto& [key, point] : first) centre += point / static_cast<double>(first.size());
  const Rigid X_P1{Mat3{}, -centre};
  for (const auto& [setup, points] : targets) {
    std::vector<Vec3> here, there;
    Vec3 middle;
    for (const auto& [key, point] : points) {
      middle += point / static_cast<double>(points.size());
      const auto same = first.find(key);
      if (same != first.end()) here.push_back(point), there.push_back(same->second);
    }
    const std::optional<Rigid> X_1W = rigid_fit(here, there);
    X_PW_[setup] = X_1W ? X_P1 * *X_1W : Rigid{Mat3{}, -middle};
  }
}

}  // namespace abbe
