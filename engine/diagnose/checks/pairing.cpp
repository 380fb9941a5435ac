#include "engine/diagnose/checks/pairing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/diagnose/checks/most_agree.hpp"
#include "engine/diagnose/model/noise_law.hpp"
#include "engine/diagnose/quantile.hpp"
#include "engine/recording/units.hpp"
#include "engine/run/recorded/part.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kBeside_mm = 5;  // more than an alignment leaves

/// How far each row lies from its target, by a measure of that: as the part was put on its targets along the normals, or
/// as whole places agree best, because some recordings leave shifts along a surface open.
template <class Measure>
std::vector<double> from_targets(const Recording& r, Measure measure) {
  std::map<int, std::pair<std::vector<Vec3>, std::vector<Vec3>>> setups;
  for (const RecordingRow& row : r.rows)
    setups[row.setup].first.push_back(row.position_mm), setups[row.setup].second.push_back(*row.target_mm);
  std::map<int, std::optional<Rigid>> places;
  for (const auto& [setup, points] : setups) places[setup] = placement_of_most(points.first, points.second);
  std::vector<double> out;
  for (const RecordingRow& row : r.rows) {
    const auto off = [&](const Vec3& p) { return measure(p - *row.target_mm, *row.normal); };
    const std::optional<Rigid>& X = places[row.setup];
    out.push_back(X ? std::min(off(row.position_mm), off(*X * row.position_mm)) : off(row.position_mm));
  }
  return out;
}

std::vector<double> beside_targets(const Recording& r) {
  return from_targets(r, [](const Vec3& off, const Vec3& n) { return norm(perpendicular_part(off, n)); });
}

/// The unit other than millimetres in which a row alone has its position.
std::optional<ForeignUnit> own_unit(const RecordingRow& row) {
  constexpr double kAlong = 0.99;  // cosine
  const Vec3 &p = row.position_mm, &t = *row.target_mm;
  return dot(p, t) > kAlong * norm(p) * norm(t) ? foreign_unit(norm(p), norm(t)) : std::nullopt;
}

/// What is too far beside a target, by feature: in a narrow bore, where another direction of the surface begins.
std::vector<double> limits(const RecordedTouches& t) {
  std::vector<std::vector<int>> touches_of(t.features.size());
  for (std::size_t i = 0; i < t.touches.size(); ++i)
    touches_of[t.touches[i].scene.feature].push_back(static_cast<int>(i));
  std::vector<double> out;
  for (const std::vector<int>& rows : touches_of) {
    const std::optional<double> radius = round_radius(t, rows);
    out.push_back(radius ? std::min(kBeside_mm, std::abs(*radius) / 2) : kBeside_mm);
  }
  return out;
}

/// Rows that lie elsewhere than their targets.
class Astray {
 public:
  explicit Astray(const Recording& of) : of_(of) {}

  void add(const RecordingRow& row, const std::string& where) {
    const std::optional<ForeignUnit> in = own_unit(row);
    if (rows_.empty()) unit_ = in;
    if (!in || !unit_ || in->mm != unit_->mm) unit_.reset();
    rows_.push_back(fmt::format("touch {} of '{}' ({}) {}", row.touch, row.feature, line_of(of_, row), where));
  }

  /// Throws UserError (E0711) where they are many of `all`; warns of a few (W0712). `and_so`: what becomes of these.
  void tell(std::size_t all, const std::string& file, std::string_view and_so,
            std::vector<Diagnostic>& messages) const {
    constexpr double kFew = 0.1;
    constexpr std::size_t kTold = 3;
    if (rows_.empty()) return;
    const std::vector<std::string> told(rows_.begin(), rows_.begin() + std::ptrdiff_t(std::min(rows_.size(), kTold)));
    const std::string text =
        fmt::format("{}: {}{}", file, fmt::join(told, ", "),
                    rows_.size() > kTold ? fmt::format(", and {} more do", rows_.size() - kTold) : "");
    const std::string help = unit_
        ? fmt::format("x, y, z are in {} there: multiply them by {:g}", unit_->name, unit_->mm)
        : "rows are paired with targets by feature and touch, counted from 1: check labels and numbers";
    if (double(rows_.size()) > kFew * double(all)) throw UserError(diagnostic(Code::E0711, text, help));
    messages.push_back(diagnostic(Code::W0712, text + std::string(and_so), help));
  }

 private:
  const Recording& of_;
  std::vector<std::string> rows_;
  std::optional<ForeignUnit> unit_;  ///< of all of them
};

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
    const bool elsewhere = std::any_of(features.begin(), features.end(), [&of = of](const auto& other) {
      return other.first.first == of.first && other.first.second != of.second;
    });
    const std::string where = elsewhere ? fmt::format(" in setup {}", of.second) : "";
    for (const auto& [size, name] : {std::pair(radius, "radius"), std::pair(2 * radius, "diameter")})
      if (std::abs(std::abs(out) - size) < kAlike_mm)
        throw UserError(diagnostic(
            Code::E0701,
            fmt::format(
                "{}: every touch of '{}'{} is {:.3f} mm too far {} along its normal, which is the {} of its tip", file,
                t.features[of.first], where, std::abs(out), out > 0 ? "out" : "in", name),
            "check the compensation of that feature, INNER or OUTER, and whether its targets are tip centres; where it is really so, say '# surfaces: unknown'"));
  }
}

void leave_out_targets(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr std::size_t kFew = 3;  // those that make the coordinates of a part are their targets by definition
  constexpr double kByChance = 1e-6;
  const auto is_target = [](const RecordingRow& row) { return row.position_mm == *row.target_mm; };
  std::vector<double> off_mm;
  for (const RecordingRow& row : recording.rows)
    if (!is_target(row)) off_mm.push_back(std::abs(dot(row.position_mm - *row.target_mm, *row.normal)));
  const std::size_t all = recording.rows.size(), targets = all - off_mm.size();
  if (targets <= kFew || off_mm.empty()) return;
  constexpr double kMiddleOfNormal = 0.6745;
  const double sd_mm = median(std::move(off_mm)) / kMiddleOfNormal, step_mm = common_step_mm(recording);
  const double rounded = sd_mm > 0 ? std::min(1.0, step_mm / (std::sqrt(2 * kPi) * sd_mm)) : 1;
  if (poisson_tail(double(targets), double(all) * rounded) > kByChance) return;
  const auto first = std::find_if(recording.rows.begin(), recording.rows.end(), is_target);
  messages.push_back(diagnostic(
      Code::W0717,
      fmt::format("{}: {} of {} touches are exactly their targets, the first is touch {} of '{}' ({}): left out", file,
                  targets, all, first->touch, first->feature, line_of(recording, *first)),
      "a real machine differs in the last digits: check that measured positions were recorded there, and not targets"));
  std::erase_if(recording.rows, is_target);
}

void leave_out_astray(Recording& recording, const std::string& file, std::vector<Diagnostic>& messages) {
  constexpr double kAstray_mm = 100;
  const std::vector<double> far = from_targets(recording, [](const Vec3& off, const Vec3&) { return norm(off); });
  Astray astray(recording);
  std::vector<RecordingRow> kept;
  for (std::size_t i = 0; i < far.size(); ++i) {
    const RecordingRow& row = recording.rows[i];
    if (far[i] > kAstray_mm)
      astray.add(row, fmt::format("lies {:.1f} mm from its target", far[i]));
    else
      kept.push_back(row);
  }
  astray.tell(recording.rows.size(), file, ": left out", messages);
  recording.rows = std::move(kept);
}

void check_pairing(const Recording& r, const RecordedTouches& t, const std::string& file,
                   std::vector<Diagnostic>& messages) {
  const std::vector<double> beside = beside_targets(r), limit = limits(t);
  Astray astray(r);
  for (const RecordedTouch& touch : t.touches) {
    const double off = beside[touch.row];
    if (off >= limit[touch.scene.feature])
      astray.add(r.rows[touch.row], fmt::format("lies {:.1f} mm beside its target", off));
  }
  astray.tell(t.touches.size(), file, "", messages);
}

}  // namespace abbe::diagnose
