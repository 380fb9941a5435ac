#include "engine/diagnose/checks/unlogged_styli.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace abbe::diagnose {

double least_along_the_best(const std::vector<Vec3>& normals) {
  constexpr int kFine = 3;
  double best = -1;
  for (int x = -kFine; x <= kFine; ++x)
    for (int y = -kFine; y <= kFine; ++y)
      for (int z = -kFine; z <= kFine; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 direction = unit({double(x), double(y), double(z)});
        double least = 1;
        for (const Vec3& n : normals) least = std::min(least, dot(n, direction));
        best = std::max(best, least);
      }
  return best;
}

bool styli_unlogged(const Recording& r, const std::string& file, std::vector<Diagnostic>& messages) {
  // Of a straight stylus, from the tip to the head, 1 is the pole of its ball and 0 the equator; 30 degrees behind the
  // equator there is the shaft.
  constexpr double kOutOfReach = -0.5;
  std::vector<Vec3> normals;
  for (const RecordingRow& row : r.rows)
    if (row.normal) normals.push_back(*row.normal);
  const bool logged =
      std::any_of(r.rows.begin(), r.rows.end(), [](const RecordingRow& row) { return row.sensor || row.head_a_deg; });
  if (logged || least_along_the_best(normals) > kOutOfReach) return false;
  messages.push_back(diagnostic(
      Code::W0725,
      fmt::format("{}: no one stylus in one orientation reaches all these surfaces, and no row says which touched it",
                  file),
      "log sensor, head_A_deg and head_B_deg: until then what belongs to a stylus or an orientation cannot be told from an error of the machine"));
  return true;
}

}  // namespace abbe::diagnose
