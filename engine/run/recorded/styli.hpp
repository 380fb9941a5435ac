// The stylus system of each row of a recording.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/machine.hpp"
#include "engine/plan/plan.hpp"
#include "engine/recording/recording.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

/// Head angles that differ by less are one orientation.
inline constexpr double kReadBack_deg = 0.1;

/// The stylus systems of a recording, resolved once each: by name, and by the angles of the head where rows give them.
/// Angles that were read back scatter by thousandths of a degree about those that the head was sent to.
class RecordedStyli {
 public:
  /// `file`: what the whole recording is called.
  RecordedStyli(const Recording& recording, const Machine& machine, const std::string& file);

  /// That of a row, which stays where it is. Throws UserError: a name that neither the recording nor the machine knows.
  const Sensor& of(const RecordingRow&);

  /// By StylusScene::ordinal - 1: the name of the first sensor with that stylus.
  const std::vector<std::string>& names() const { return names_; }
  /// Qualified tips: styli in each of their orientations.
  int tips() const { return static_cast<int>(met_.size()); }
  /// Whether it is known which stylus made a touch: the row says it, or there is only one.
  bool tells_stylus(const RecordingRow&) const;
  /// Whether it is known at which angles of the head: the row or its stylus says it, or there is no head.
  bool tells_head(const RecordingRow&) const;
  /// W0541 where a stylus had to be assumed.
  const std::vector<Diagnostic>& messages() const { return messages_; }

 private:
  struct Known {
    std::optional<double> a_deg, b_deg;
    Sensor sensor;
  };

  Sensor resolve(const std::string& name, const RecordingRow&);
  void require_sensor(const std::string& label, const RecordingRow&) const;
  void assume(const RecordingRow&, plan::SensorDef&);

  const Recording& recording_;
  Machine machine_;  ///< has a head where rows were made at angles of one
  std::string file_;
  std::map<std::string, std::deque<Known>> known_;  ///< by name
  std::vector<Sensor> met_;
  std::vector<std::string> names_;
  std::vector<Diagnostic> messages_;
};

}  // namespace abbe
