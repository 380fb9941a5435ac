// Which features are curved: their touches have normals that are neither parallel nor opposite, in one placement of the
// part (a gauge block that is put down in seven directions has two faces in each). Single points are curved where all of a
// placement lie on one ball: many programs measure a reference sphere as points. A recording says no more of a
// feature, so the same is taken of simulated touches: what is diagnosed is what was simulated.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/math/vec.hpp"

namespace abbe {

class CurvedFeatures {
 public:
  /// A touch on the surface, mm, and its normal, in axes that are the same throughout a setup. By label: a label defined
  /// again is one feature in a recording.
  void add(const std::string& feature, int setup, const Vec3& point, const Vec3& normal);
  bool touched(const std::string& feature) const { return touched_.count(feature) > 0; }
  /// Of what was touched so far.
  std::set<std::string> curved() const;

 private:
  struct InSetup {
    Vec3 point, normal;   ///< of its first touch
    bool single = true;   ///< touched at one place only
    bool curved = false;  ///< by its own normals
  };
  std::map<int, std::map<std::string, InSetup>> by_setup_;
  std::set<std::string> touched_;
};

}  // namespace abbe
