// A recording: what one machine reported, touch by touch, and everything logged beside it (docs/recording.md,
// "Recordings"). One row is one scalar observation along n. What was not logged is absent, never zero: an
// effect that needs it cannot be judged.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/base/source.hpp"
#include "engine/math/vec.hpp"

namespace abbe {

struct RecordingRow {
  std::string feature;
  int touch = 1;  ///< 1-based, within the feature
  int setup = 1, run = 1;
  Vec3 position_mm;                       ///< recorded, tip centre or surface point as the recording says
  std::optional<Vec3> target_mm, normal;  ///< where it should be, and the outward unit normal there
  std::optional<std::string> sensor;
  std::optional<double> head_a_deg, head_b_deg;
  std::optional<int> qualification, visit;
  std::optional<double> time_s, speed_mm_s, accel_mm_s2;
  std::optional<Vec3> travel;  ///< unit vector of the motion at the touch
  /// From the program, for a part that stands where it has it: target and normal; travel, for one on its targets. In no file.
  bool target_as_planned = false, travel_as_planned = false;
  std::optional<double> temp_part_C, temp_x_C, temp_y_C, temp_z_C, temp_air_C, load_kg;
  std::optional<Vec3> reading_mm;  ///< raw scale readings
  /// Point of the surface and its normal in the part's own coordinates (engine/run/part_frame.hpp); from the
  /// program that was measured, in no file.
  std::optional<Vec3> on_part_mm, normal_on_part;
  int line = 0;  ///< of the file it was read from; 0: made by a simulation
  int file = 0;  ///< which of Recording::files that is
};

enum class RecordedPoint { tip_centre, surface };

/// Whether the true places of surfaces are known: entirely, but for a size by feature, or not at all.
enum class Surfaces { calibrated, unknown_size, unknown };
/// As a line `# surfaces: ...` says it; nothing of another word.
std::optional<Surfaces> find_surfaces(std::string_view word);

/// The lines `# key: value` of a recording.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// What the first line of that key says.
std::optional<std::string> said(const Metadata&, std::string_view key);

struct Recording {
  Metadata metadata;           ///< beyond the next two
  bool in_part_frame = false;  ///< `frame: part`, else machine coordinates
  RecordedPoint point = RecordedPoint::tip_centre;
  std::vector<RecordingRow> rows;
  std::vector<Diagnostic> messages;     ///< of reading it: what is doubtful and no error
  std::vector<std::string> files = {};  ///< names of those that were joined; none of a recording that never was
};

/// The name of the file that a row was read from; `all`: what the whole recording is called.
inline const std::string& file_of(const Recording& r, const RecordingRow& row, const std::string& all) {
  return r.files.empty() ? all : r.files[static_cast<std::size_t>(row.file)];
}
/// Where a row stands: "line 7", or of several files "line 7 of b.csv".
std::string line_of(const Recording&, const RecordingRow&);

/// The step of which all these lengths are multiples: their greatest common divisor, down to 1 nm, or where that is less than
/// 10 nm a step of any size from 0.1 um on, if a dozen tell that there is one; 0 without any length. mm.
double common_step_mm(const std::vector<double>& lengths_mm);
/// Of all recorded positions.
double common_step_mm(const Recording&);

/// Makes positions and scale readings multiples of a step, as counters and software with few digits do.
void round_readings(Recording&, double step_mm);

/// RFC 4180 with `#` lines before the header; a column appears when any row has it. Lengths with 7 decimals (0.1 nm).
std::string to_csv(const Recording&);

/// Whether a row needs a recorded position; a plan may have its target instead.
enum class Positions { recorded, or_targets };

/// Reads the contract of docs/recording.md. Throws UserError with the place of every mistake: lines before the table
/// that contradict each other, unknown or missing column, value that is no number, incomplete vector, direction that is no
/// unit vector.
Recording read_recording(const SourceFile&, Positions = Positions::recorded);

/// Whether the file is a table of values of characteristics (value_recording.hpp) and not of touches, complete or not.
/// Throws UserError where it is no table.
bool is_value_recording(const SourceFile&);

}  // namespace abbe
