#include "engine/diagnose/planning/second_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "engine/diagnose/baseline/calibrated_part.hpp"
#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/baseline/machine_effects.hpp"
#include "engine/diagnose/planning/path.hpp"
#include "engine/diagnose/planning/reach.hpp"
#include "engine/run/motion.hpp"

namespace abbe::diagnose {

namespace {

constexpr double kPause_s = 600;  // until the second recording begins

/// The run that is repeated: the longest, of equal ones the first.
int repeated_run(const Recording& r) {
  std::map<int, int> rows;
  for (const RecordingRow& row : r.rows) ++rows[row.run];
  return std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// The rows that are repeated: indices in the order of measuring.
std::vector<int> selected(const Case& c, bool reversed, std::size_t most) {
  const int run = repeated_run(*c.recording);
  std::vector<int> all, out;
  for (const RecordedTouch& t : c.touches.touches)
    if (t.scene.run == run) all.push_back(t.row);
  const std::size_t n = all.size(), m = std::min(n, most);
  for (std::size_t k = 0; k < n; ++k)
    if ((k + 1) * m / n > k * m / n) out.push_back(all[k]);
  if (reversed) std::reverse(out.begin(), out.end());
  return out;
}

/// The last of each count, so that what is new counts on.
struct Last {
  int run = 0, setup = 0, visit = 0;
  double time_s = 0;
};
Last last_of(const Recording& r) {
  Last last;
  for (const RecordingRow& row : r.rows) {
    last.run = std::max(last.run, row.run);
    last.setup = std::max(last.setup, row.setup);
    last.visit = std::max(last.visit, row.visit.value_or(0));
    last.time_s = std::max(last.time_s, row.time_s.value_or(0));
  }
  return last;
}

/// The setup in which the part can stay: a repetition begins with it, and the recording has left the part there. A part that is
/// put down anew is elsewhere, by micrometres at least. Nothing where it begins with another.
std::optional<int> setup_that_stays(const Case& c, const Change& change) {
  const int begins_with =
      c.recording->rows[selected(c, change.reversed, std::numeric_limits<std::size_t>::max()).front()].setup;
  const bool stays = !change.new_setup && begins_with == c.touches.touches.back().scene.setup;
  return stays ? std::optional(begins_with) : std::nullopt;
}

bool inside(const Machine& machine, const Vec3& reading) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z})
    if (!machine[axis].reaches(reading[static_cast<int>(axis)])) return false;
  return true;
}

void move_by(const Rigid& X, RecordingRow& row) {
  row.target_mm = X * *row.target_mm;
  row.normal = X.R * *row.normal;
  if (row.travel) row.travel = X.R * *row.travel;
}

bool displaced(const RecordedTouches& t) {
  return std::any_of(t.messages.begin(), t.messages.end(), [](const Diagnostic& d) { return d.code == Code::W0542; });
}

/// These rows once more, after the change.
Longer with_repeated(const Case& c, const Change& change, const std::vector<int>& rows) {
  Longer out{*c.recording, *c.machine, {}, 0, {}, 0};
  const Last last = last_of(*c.recording);
  const std::optional<int> stays = setup_that_stays(c, change);
  const double begin_s = c.recording->rows[rows.front()].time_s.value_or(0);
  for (const int k : rows) {
    RecordingRow row = c.recording->rows[k];
    const double residual_mm = dot(*row.normal, row.position_mm - *row.target_mm);
    row.run = last.run + 1;
    if (!row.qualification) row.qualification = 2;  // as of a second file that does not say otherwise
    if (row.visit) row.visit = change.reversed ? 2 * last.visit + 1 - *row.visit : *row.visit + last.visit;
    if (row.time_s) row.time_s = last.time_s + kPause_s + std::abs(*row.time_s - begin_s);
    if (row.setup != stays) row.setup += last.setup;
    if (change.move) move_by(*change.move, row);
    change.apply(row, out.machine);
    row.position_mm = *row.target_mm + residual_mm * *row.normal;
    row.reading_mm.reset();  // of the first recording; where the axes will stand follows from the target
    out.recording.rows.push_back(std::move(row));
  }
  out.touches = recorded_touches(out.recording, out.machine, "");
  out.first = c.touches.touches.size();
  std::vector<int> touch_of_row(c.recording->rows.size());
  for (std::size_t i = 0; i < out.first; ++i) touch_of_row[c.touches.touches[i].row] = static_cast<int>(i);
  for (const RecordedTouch& t : out.touches.touches) {
    const auto row = static_cast<std::size_t>(t.row), own = touch_of_row.size();
    out.same_as.push_back(touch_of_row[row < own ? row : static_cast<std::size_t>(rows[row - own])]);
  }
  constexpr unsigned kReadings = static_cast<unsigned>(Covariate::raw_reading);
  out.touches.known |= c.touches.known & kReadings;
  out.touches.varying |= c.touches.known & kReadings;
  return out;
}

}  // namespace

std::optional<Longer> repeated(const Case& c, const Change& change, std::size_t most) {
  std::vector<int> rows = selected(c, change.reversed, most);
  Longer out = with_repeated(c, change, rows);
  const double least = least_facing(c.touches);
  std::set<int> beyond_reach;
  for (std::size_t k = out.first; k < out.touches.touches.size(); ++k)
    if (const RecordedTouch& t = out.touches.touches[k]; facing(t.scene.normal, t.scene.stylus) < least)
      beyond_reach.insert(rows[static_cast<std::size_t>(t.row) - c.recording->rows.size()]);
  if (2 * beyond_reach.size() > rows.size()) return std::nullopt;
  if (!beyond_reach.empty()) {
    std::erase_if(rows, [&](int row) { return beyond_reach.contains(row); });
    out = with_repeated(c, change, rows);
    out.left_out = beyond_reach.size();
  }
  if (displaced(out.touches) && !displaced(c.touches)) return std::nullopt;
  for (std::size_t k = out.first; k < out.touches.touches.size(); ++k)
    if (!inside(out.machine, out.touches.touches[k].scene.reading)) return std::nullopt;
  return out;
}

Baseline baseline_of(const Case& c, const Longer& longer) {
  const KnownGeometry geometry{c.baseline.mean, c.baseline.factor};
  const bool known = c.machine->known_state.has_value();
  Baseline out = baseline_of(longer.touches, longer.machine,
                             {.surfaces = c.baseline.surfaces,
                              .known = known ? &geometry : nullptr,
                              .seed = c.options.seed,
                              .threads = c.options.threads,
                              .sampled = &geometry});
  if (c.baseline.beyond) hold_to_specification(out.model);
  add_uncertainties(EffectSet(longer.machine.effects, EffectUse::left_in, longer.machine.name), longer.touches, out);
  if (c.options.workpiece)
    calibrate(recorded_part(*c.options.workpiece, longer.recording, longer.touches, ""), longer.touches, out);
  if (c.rounding_um > 0) add_rounding(longer.machine, c.rounding_um, out.model);
  LinearModel& m = out.model;
  m.noise_groups = c.baseline.model.noise_groups;
  for (std::size_t i = 0; i < m.noise_group.size(); ++i)
    m.noise_group[i] = c.baseline.model.noise_group[longer.same_as[i]];
  for (std::size_t i = 1; i < m.follows.size(); ++i) m.follows[i] &= m.noise_group[i] == m.noise_group[i - 1];
  return out;
}

double minutes_of(const Longer& longer) {
  // No touch is made without a speed or an acceleration: where 0 stands, that of the machine counts.
  const MotionSettings usual = default_motion(longer.machine);
  const auto moving = [](double logged, double otherwise) { return logged > 0 ? logged : otherwise; };
  const std::vector<RecordedTouch>& all = longer.touches.touches;
  constexpr double kPlacing_min = 5;
  int placed = 0;
  for (std::size_t k = longer.first + 1; k < all.size(); ++k) placed += all[k].scene.setup != all[k - 1].scene.setup;
  const Path path = path_of(longer);
  Motion motion(path.steps.front().kind == Step::Kind::go ? path.steps.front().to : all[longer.first].scene.point,
                usual);
  for (const Step& step : path.steps) {
    const TouchScene& s = all[step.touch].scene;
    if (step.kind == Step::Kind::go) motion.move_to(step.to);
    if (step.kind == Step::Kind::stylus && s.stylus.indexed) motion.index_head();
    if (step.kind != Step::Kind::touch) continue;
    motion.settings().measuring_mm_s = moving(s.speed_mm_s, usual.measuring_mm_s);
    motion.settings().measuring_mm_s2 = moving(s.acceleration_mm_s2, usual.measuring_mm_s2);
    motion.touch(s.point + s.stylus.radius_mm * s.normal, s.normal);
  }
  return motion.time_s() / 60 + placed * kPlacing_min;
}

}  // namespace abbe::diagnose
