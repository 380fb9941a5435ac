// What a proposed program calls the features and tips of a recording: words that DMIS can hold, and no two of them alike.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/diagnose/planning/second_recording.hpp"

namespace abbe::diagnose {

struct Labels {
  std::vector<std::string> features;  ///< by TouchScene::feature
  /// by StylusScene::tip_ordinal, those of the new touches: the names of their styli, numbered where a recording has one
  /// stylus in several orientations of the head
  std::map<int, std::string> tips;
};
Labels labels_of(const Longer&);

/// Each name as it is where DMIS can hold it; the others with what it cannot replaced, and numbered where that is taken.
std::vector<std::string> dmis_labels(const std::vector<std::string>& names);

}  // namespace abbe::diagnose
