// Touches that no row says the stylus of, on surfaces that one stylus cannot have reached.
#include <fmt/format.h>

#include <algorithm>

#include "engine/diagnose/checks/data_problems.hpp"

namespace abbe::diagnose {

namespace {

/// How near to its equator the farthest touch of a straight stylus is, as n . s: 0 on the equator, 1 at the pole. `s`:
/// from the tip to the head.
double farthest(const Recording& r, const Vec3& s) {
  double least = 1;
  for (const RecordingRow& row : r.rows) least = std::min(least, row.normal ? dot(*row.normal, s) : 1);
  return least;
}

/// Of the orientation, among some hundred about 15 degrees apart, that has all touches nearest to its pole.
double farthest_of_the_best(const Recording& r) {
  constexpr int kFine = 3;
  double best = -1;
  for (int x = -kFine; x <= kFine; ++x)
    for (int y = -kFine; y <= kFine; ++y)
      for (int z = -kFine; z <= kFine; ++z)
        if (x != 0 || y != 0 || z != 0) best = std::max(best, farthest(r, unit({double(x), double(y), double(z)})));
  return best;
}

}  // namespace

bool styli_unlogged(const Recording& r, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kOutOfReach = -0.5;  // 30 degrees behind the equator there is the shaft
  const bool logged =
      std::any_of(r.rows.begin(), r.rows.end(), [](const RecordingRow& row) { return row.sensor || row.head_a_deg; });
  if (logged || farthest_of_the_best(r) > kOutOfReach) return false;
  messages.push_back(diagnostic(
      Code::W0725,
      fmt::format("{}: no one stylus in one orientation reaches all these surfaces, and no row says which touched it",
                  file),
      "log sensor, head_A_deg and head_B_deg: until then what belongs to a stylus or an orientation cannot be told from an error of the machine"));
  return true;
}

}  // namespace abbe::diagnose
