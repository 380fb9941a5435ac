#include "engine/recording/copies.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace abbe {

namespace {

constexpr double kCoarse_mm = 1.5e-3, kNearlyAll = 0.9;

double step_of(const std::vector<const RecordingRow*>& rows) {
  std::vector<double> lengths;
  for (const RecordingRow* row : rows)
    for (int k = 0; k < 3; ++k) lengths.push_back(row->position_mm[k]);
  return common_step_mm(lengths);
}

}  // namespace

std::optional<Copied> copied_group(const std::vector<const RecordingRow*>& rows, const std::vector<int>& group,
                                   std::size_t fewest) {
  if (rows.empty() || step_of(rows) > kCoarse_mm) return std::nullopt;
  using Touch = std::tuple<std::string, int, double, double, double>;
  std::map<Touch, std::vector<int>> groups_with;  // each once
  std::map<int, std::size_t> size;
  std::map<std::pair<int, int>, std::size_t> in_common;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RecordingRow& row = *rows[i];
    ++size[group[i]];
    if (row.target_mm == row.position_mm) continue;
    const Vec3& p = row.position_mm;
    std::vector<int>& with = groups_with[{row.feature, row.touch, p.x, p.y, p.z}];
    if (std::find(with.begin(), with.end(), group[i]) != with.end()) continue;
    for (const int other : with) ++in_common[std::minmax(other, group[i])];
    with.push_back(group[i]);
  }
  for (const auto& [pair, count] : in_common) {
    const std::size_t smaller = std::min(size[pair.first], size[pair.second]);
    if (smaller >= fewest && double(count) >= kNearlyAll * double(smaller)) return Copied{pair.first, pair.second};
  }
  return std::nullopt;
}

}  // namespace abbe
