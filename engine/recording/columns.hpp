// The columns of a recording (docs/recording.md, "Recordings"), each once: what reads, writes and doubts them goes by this list.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "engine/recording/recording.hpp"

namespace abbe {

/// What one value of a row is, or one vector, which has three columns.
struct RecordingColumn {
  template <class... T>
  using One = std::variant<T RecordingRow::*...>;
  using Member = One<std::string, std::optional<std::string>, int, std::optional<int>, std::optional<double>, Vec3,
                     std::optional<Vec3>>;

  std::array<std::string_view, 3> names;  ///< of one value the first only
  Member member;
  double low = 0,
         high = 0;        ///< of numbers: what is beyond is no measurement but a slip, or the mark of a missing value
  int decimals = 0;       ///< of numbers that are written; lengths have 0.1 nm
  bool required = false;  ///< in every row
  bool unit_vector = false;
  /// It changes from touch to touch: a gap would be taken for its usual value beside what was logged.
  bool changes = false;
};

/// In the order in which they are written.
std::span<const RecordingColumn> recording_columns();

/// The name of a column, of a vector all three: "ax,ay,az".
std::string name(const RecordingColumn&);

}  // namespace abbe
