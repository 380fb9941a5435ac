// What a second recording may do otherwise than the first: the menu of changes that separate effects.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/diagnose/case.hpp"

namespace abbe::diagnose {

/// One change to how touches are made.
struct Change {
  std::string text;              ///< "repeat with probing speed 3 mm/s"
  std::string instruction = {};  ///< for the operator, or empty when the program does it all
  double minutes = 0;            ///< beyond the measuring itself
  /// What becomes of a row; a stylus that is new joins the sensors of the machine.
  std::function<void(RecordingRow&, Machine&)> apply = [](RecordingRow&, Machine&) {};
  std::optional<Rigid> move{};  ///< of the part, in the coordinates of the recording
  std::string placed = {};      ///< how the part stands then: "turned by 90 degrees about the vertical"
  std::string mounted = {};     ///< what the stylus that is mounted has: "a length of 40 mm"
  bool new_setup = false;       ///< the part is placed anew, or does not stay put to micrometres
  bool reversed = false;        ///< the sequence runs from its end to its beginning
  bool changes_touches = true;  ///< not only their order and time
};

/// Whether a tip lies along the last link of the head; no arm of a star does.
inline bool is_straight(const Vec3& tip_in_r_mm) {
  return std::hypot(tip_in_r_mm.x, tip_in_r_mm.y) < 1e-6 * norm(tip_in_r_mm);
}

/// The part is placed anew and aligned: moved so, which `how` tells as Change::placed does.
Change placed_anew(const std::string& how, const Rigid& move);

/// Both at once: a part is put down once, and one stylus has what both mount.
Change joined(const Change&, const Change&);

/// The changes that a recording like this one can hold.
std::vector<Change> changes_for(const Case&);

}  // namespace abbe::diagnose
