// Touches that are paired with the wrong targets: a row of another feature, numbers that count from another
// touch. Labels and numbers agree then, but not the places. What a machine and a part do to a touch lies
// along the normal; beside its target it is only as far as the part was not aligned.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "engine/diagnose/checks/data_problems.hpp"
#include "engine/math/rigid_fit.hpp"
#include "engine/run/recorded_part.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kBeside_mm = 5;  // more than an alignment leaves

/// How far each row lies beside its target, in the direction in which it lies least: as the part was put on
/// its targets along the normals, or as whole places agree best, because some recordings leave shifts along a
/// surface open.
std::vector<double> beside_targets(const Recording& r) {
  std::map<int, std::pair<std::vector<Vec3>, std::vector<Vec3>>> setups;
  for (const RecordingRow& row : r.rows)
    setups[row.setup].first.push_back(row.position_mm), setups[row.setup].second.push_back(*row.target_mm);
  std::map<int, std::optional<Rigid>> places;
  for (const auto& [setup, points] : setups) places[setup] = rigid_fit(points.first, points.second);
  std::vector<double> beside;
  for (const RecordingRow& row : r.rows) {
    const auto off = [&](const Vec3& p) { return norm(perpendicular_part(p - *row.target_mm, *row.normal)); };
    const std::optional<Rigid>& X = places[row.setup];
    beside.push_back(X ? std::min(off(row.position_mm), off(*X * row.position_mm)) : off(row.position_mm));
  }
  return beside;
}

/// What is too far beside a target, by feature: in a narrow bore, where another direction of the surface begins.
std::vector<double> limits(const RecordedTouches& t) {
  std::vector<std::vector<int>> touches_of(t.features.size());
  for (std::size_t i = 0; i < t.touches.size(); ++i)
    touches_of[static_cast<std::size_t>(t.touches[i].scene.feature)].push_back(static_cast<int>(i));
  std::vector<double> out;
  for (const std::vector<int>& rows : touches_of) {
    const std::optional<double> radius = round_radius(t, rows);
    out.push_back(radius ? std::min(kBeside_mm, std::abs(*radius) / 2) : kBeside_mm);
  }
  return out;
}

}  // namespace

void check_tips(const RecordedTouches& t, const std::string& file) {
  constexpr std::size_t kEnough = 3;
  constexpr double kLarge_mm = 0.25, kAlike_mm = 0.05;
  std::map<std::pair<int, int>, std::vector<const RecordedTouch*>> features;
  for (const RecordedTouch& touch : t.touches) features[{touch.scene.feature, touch.scene.setup}].push_back(&touch);
  for (const auto& [of, touches] : features) {
    const double radius = touches.front()->scene.stylus.radius_mm, out = touches.front()->residual_mm;
    const bool alike = std::all_of(touches.begin(), touches.end(), [&](const RecordedTouch* touch) {
      return std::abs(touch->residual_mm - out) < kAlike_mm;
    });
    if (touches.size() < kEnough || std::abs(out) < kLarge_mm || !alike) continue;
    for (const auto& [size, name] : {std::pair(radius, "radius"), std::pair(2 * radius, "diameter")})
      if (std::abs(std::abs(out) - size) < kAlike_mm)
        throw UserError(diagnostic(
            Code::E0701,
            fmt::format("{}: every touch of '{}' is {:.3f} mm too far {} along its normal, which is the {} of its tip",
                        file, t.features[static_cast<std::size_t>(of.first)], std::abs(out), out > 0 ? "out" : "in",
                        name),
            "check the compensation of that feature, INNER or OUTER, and whether its targets are tip centres; where it is really so, say '# surfaces: unknown'"));
  }
}

void check_pairing(const Recording& r, const RecordedTouches& t, const std::string& file,
                   std::vector<Diagnostic>& messages) {
  constexpr double kFew = 0.1;
  constexpr std::size_t kTold = 3;
  const std::vector<double> beside = beside_targets(r), limit = limits(t);
  std::vector<std::string> astray;
  for (const RecordedTouch& touch : t.touches) {
    const double off = beside[static_cast<std::size_t>(touch.row)];
    if (off < limit[static_cast<std::size_t>(touch.scene.feature)]) continue;
    const RecordingRow& row = r.rows[static_cast<std::size_t>(touch.row)];
    astray.push_back(fmt::format("touch {} of '{}' (line {}) lies {:.1f} mm beside its target", row.touch, row.feature,
                                 row.line, off));
  }
  if (astray.empty()) return;
  const std::size_t all = astray.size();
  astray.resize(std::min(all, kTold));
  const std::string text = fmt::format("{}: {}{}", file, fmt::join(astray, ", "),
                                       all > kTold ? fmt::format(", and {} more do", all - kTold) : "");
  const std::string help =
      "rows are paired with targets by feature and touch, counted from 1: check labels and numbers";
  if (double(all) > kFew * double(t.touches.size())) throw UserError(diagnostic(Code::E0711, text, help));
  messages.push_back(diagnostic(Code::W0712, text, help));
}

}  // namespace abbe::diagnose
