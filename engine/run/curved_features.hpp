// Which features are curved: their touches have normals that are neither parallel nor opposite, in one placement of the
// part (a gauge block that is put down in seven directions has two faces in each). A recording says no more of a
// feature, so the same is taken of simulated touches: what is diagnosed is what was simulated.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "engine/math/vec.hpp"

namespace abbe {

/// By label: a label defined again is one feature in a recording.
class CurvedFeatures {
 public:
  void add(const std::string& feature, int setup, const Vec3& normal) {
    constexpr double kParallel = 0.1;  // sine of 6 degrees: faces are wavy, vectors are rounded
    touched_.insert(feature);
    const Vec3& first = first_normal_.emplace(std::pair(feature, setup), normal).first->second;
    if (norm(cross(first, normal)) > kParallel) curved_.insert(feature);
  }
  bool touched(const std::string& feature) const { return touched_.count(feature) > 0; }
  bool has(const std::string& feature) const { return curved_.count(feature) > 0; }

 private:
  std::map<std::pair<std::string, int>, Vec3> first_normal_;  ///< by feature and setup
  std::set<std::string> touched_, curved_;
};

}  // namespace abbe
