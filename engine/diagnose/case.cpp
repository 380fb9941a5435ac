#include "engine/diagnose/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "engine/diagnose/baseline/calibrated_part.hpp"
#include "engine/diagnose/baseline/known_state.hpp"
#include "engine/diagnose/baseline/length_errors.hpp"
#include "engine/diagnose/baseline/machine_effects.hpp"
#include "engine/diagnose/checks/normals.hpp"
#include "engine/diagnose/checks/pairing.hpp"
#include "engine/diagnose/checks/unlogged_styli.hpp"
#include "engine/diagnose/warnings.hpp"

namespace abbe::diagnose {

Case case_of(const Recording& recording, const Machine& machine, const DiagnoseOptions& options,
             std::optional<Surfaces> surfaces, const std::string& file, Diagnosis& out) {
  Case c;
  c.recording = &recording;
  c.machine = &machine;
  c.options = options;
  c.touches = recorded_touches(recording, machine, file);
  out.messages.insert(out.messages.end(), c.touches.messages.begin(), c.touches.messages.end());
  c.styli_unlogged = styli_unlogged(recording, file, out.messages);
  constexpr int kLeastTouches = 12;
  if (static_cast<int>(c.touches.touches.size()) < kLeastTouches)
    throw UserError(diagnostic(
        Code::E0705, fmt::format("{}: too few touches to judge a machine by: {}", file, c.touches.touches.size()),
        fmt::format("at least {} are needed: each placement of the part has six unknowns of its own", kLeastTouches)));
  if (!options.design_only) check_pairing(recording, c.touches, file, out.messages);
  if (!options.design_only) doubt_hollow_balls(recording, c.touches, file, out.messages);
  if (!options.design_only && !surfaces) check_tips(c.touches, file);
  const EffectSet effects(machine.effects, EffectUse::left_in, machine.name);
  remove_estimates(effects, c.touches);
  std::optional<RecordedPart> part;
  if (options.workpiece) part = recorded_part(*options.workpiece, recording, c.touches, file);
  if (part)
    remove_expected(*part, c.touches),
        out.messages.insert(out.messages.end(), part->messages.begin(), part->messages.end());
  std::optional<KnownGeometry> known;
  if (machine.known_state) known = known_geometry(*machine.known_state);
  if (!surfaces && within_mm(c.touches, kHalfOfThem) > kBeyondMachines_mm) {
    surfaces = Surfaces::unknown;
    out.messages.push_back(not_its_targets(c.touches, kHalfOfThem, file));
  }
  c.baseline =
      baseline_of(c.touches, machine,
                  {surfaces.value_or(Surfaces::calibrated), known ? &*known : nullptr, options.seed, options.threads});
  if (c.baseline.surfaces == Surfaces::calibrated && !options.design_only)
    out.worst_length = worst_length(c.touches, without_placement(c.baseline.model), machine.specification);
  if (!known) out.beyond = c.baseline.beyond = beyond_specification(out.worst_length, machine);
  if (out.beyond) hold_to_specification(c.baseline.model);
  add_uncertainties(effects, c.touches, c.baseline);
  if (part) calibrate(*part, c.touches, c.baseline);
  return c;
}

void judge_rounding(double step_um, Case& c) {
  c.step_um = step_um;
  const double rounding_um = step_um / std::sqrt(12.0);
  LinearModel& model = c.baseline.model;
  if (rounding_um < kLeastRounding * model.noise_um.mean()) return;
  c.rounding_um = rounding_um;
  add_rounding(*c.machine, rounding_um, model);
}

bool runs_share_a_setup(const Case& c) {
  std::map<int, int> run_of;
  return std::any_of(c.rows.begin(), c.rows.end(), [&](int row) {
    const TouchScene& s = c.touches.touches[row].scene;
    return run_of.try_emplace(s.setup, s.run).first->second != s.run;
  });
}

bool begins_within_a_setup(const Case& c, const RunChange& change) {
  std::map<int, bool> acts;
  return std::any_of(c.rows.begin(), c.rows.end(), [&](int row) {
    const TouchScene& s = c.touches.touches[row].scene;
    return acts.try_emplace(s.setup, change.acts_in(s.run)).first->second != change.acts_in(s.run);
  });
}

std::vector<std::size_t> by_time(const RecordedTouches& t) {
  std::vector<std::size_t> order(t.touches.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return t.touches[a].scene.time_s < t.touches[b].scene.time_s; });
  return order;
}

}  // namespace abbe::diagnose
