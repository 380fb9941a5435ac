#include "engine/run/recorded/part.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "engine/base/letter_case.hpp"
#include "engine/math/round_fit.hpp"
#include "engine/recording/units.hpp"
#include "engine/run/sensor.hpp"

namespace abbe {

std::optional<double> round_radius(const RecordedTouches& t, const std::vector<int>& rows, double form_mm) {
  struct Mean {
    Vec3 point, normal;
    double n = 0;
  };
  std::map<int, Mean> mean;
  for (const int i : rows) {
    Mean& m = mean[t.touches[i].scene.setup];
    m.point += t.touches[i].scene.point, m.normal += t.touches[i].scene.normal, m.n += 1;
  }
  std::vector<Vec3> points, normals;  // about the means of their setup
  for (const int i : rows) {
    const TouchScene& s = t.touches[i].scene;
    const Mean& m = mean[s.setup];
    points.push_back(s.point - m.point / m.n), normals.push_back(s.normal - m.normal / m.n);
  }
  const RoundFit round = round_fit(points, normals);
  // the means and the radius share what one touch is off
  constexpr double kSpread = 1e-3, kRound_mm = 1e-3, kFormShare = 4;
  if (round.spread < kSpread) return std::nullopt;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::abs(dot(round.rest(points[i], normals[i]), normals[i])) > kRound_mm + kFormShare * form_mm)
      return std::nullopt;
  return round.radius;
}

namespace {

/// Whether the targets of the recording are those of this very part.
bool targets_are_true(const Workpiece& w, const Recording& recording, const std::string& file) {
  const std::optional<std::string> name = said(recording.metadata, "workpiece");
  if (!name || *name == w.name) return name.has_value();
  throw UserError(diagnostic(
      Code::E0548,
      fmt::format("{}: the targets are those of workpiece '{}', the file given describes '{}'", file, *name, w.name),
      "give the workpiece file that the recording was made with, or remove the line '# workpiece:' when the targets are nominal"));
}

/// No part deviates by such a share of a diameter from its drawing.
constexpr double kNoDeviation = 0.1;

class PartReader {
 public:
  PartReader(const Workpiece& w, const RecordedTouches& t, bool shifts) : w_(w), t_(t), shifts_(shifts) {
    out_.expected_mm.assign(t.touches.size(), 0.0);
    out_.calibrated.assign(t.features.size(), 0);
    for (std::size_t i = 0; i < t.touches.size(); ++i)
      touches_of_[t.touches[i].scene.feature].push_back(static_cast<int>(i));
  }

  RecordedPart read() {
    for (const Surface& s : w_.surfaces) add_surface(s);
    if (w_.part_expands() || w_.scales_expand()) add_expansion();
    if (!errors_.empty()) throw UserError(std::move(errors_));
    return std::move(out_);
  }

 private:
  void add_surface(const Surface& s) {
    const auto found = std::find_if(t_.features.begin(), t_.features.end(),
                                    [&](const std::string& label) { return same_label(label, s.label); });
    if (found == t_.features.end()) return refuse_unknown(s);
    const int feature = static_cast<int>(found - t_.features.begin());
    const std::vector<int>& rows = touches_of_[feature];
    const std::optional<Uncertain> offset = offset_of(s, rows);
    if (!offset) return;
    out_.calibrated[feature] = 1;
    if (shifts_)
      for (const int i : rows) out_.expected_mm[i] += offset->value;
    if (!offset->exact()) set(add_doubt(), rows, offset->u());
    if (s.random_form_mm.value > 0) add_random_form(rows, s.random_form_mm.value);
    if (!targets_hold_form(s))
      out_.messages.push_back(
          diagnostic_at(w_.source, s.label_span, Code::W0549,
                        fmt::format("{} of surface '{}' is not used: a diagnosis takes it as round",
                                    shifts_ ? "the form" : "what the targets do not hold of the form", s.label),
                        shifts_ ? "give targets with the form in them, or \"random_form_um\""
                                : "give waves of unknown phase or amplitude as \"random_form_um\""));
  }

  void refuse_unknown(const Surface& s) {
    const std::vector<std::string_view> labels(t_.features.begin(), t_.features.end());
    const std::string near = nearest_word(s.label, labels);
    errors_.push_back(diagnostic_at(
        w_.source, s.label_span, Code::E0546, fmt::format("the recording has no feature '{}'", s.label),
        near.empty()
            ? fmt::format("it has: {}",
                          fmt::join(labels.begin(),
                                    labels.begin() + std::ptrdiff_t(std::min<std::size_t>(8, labels.size())), ", "))
            : fmt::format("did you mean '{}'?", near)));
  }

  /// The waves that true targets hold: those of known phase.
  static double known_form_mm(const Surface& s) {
    double sum = 0;
    for (const FormHarmonic& wave : s.form)
      if (wave.phase_half_turns) sum += std::abs(wave.amplitude_mm.value);
    return sum;
  }

  bool targets_hold_form(const Surface& s) const {
    const auto exact = [](const FormHarmonic& wave) { return wave.phase_half_turns && wave.amplitude_mm.exact(); };
    return s.form.empty() || (!shifts_ && std::all_of(s.form.begin(), s.form.end(), exact));
  }

  /// How far the surface lies beyond its target, along the outward normal.
  std::optional<Uncertain> offset_of(const Surface& s, const std::vector<int>& rows) {
    if (!s.diameter_mm && !s.diameter_deviation_mm) return s.offset_mm;
    const std::optional<double> radius = round_radius(t_, rows, shifts_ ? 0 : known_form_mm(s));
    if (!radius) {
      errors_.push_back(diagnostic_at(
          w_.source, s.label_span, Code::E0547,
          fmt::format("the targets of '{}' do not lie on a circle, cylinder or sphere", s.label),
          "a diameter belongs to a round feature with touches on several sides; give \"offset_um\" instead"));
      return std::nullopt;
    }
    const double per_diameter = *radius > 0 ? 0.5 : -0.5;
    if (s.diameter_deviation_mm) return per_diameter * *s.diameter_deviation_mm;
    Uncertain deviation = *s.diameter_mm;
    deviation.value -= 2 * std::abs(*radius);
    if (std::abs(deviation.value) > kNoDeviation * 2 * std::abs(*radius)) return refuse_size(s, 2 * std::abs(*radius));
    return per_diameter * deviation;
  }

  std::optional<Uncertain> refuse_size(const Surface& s, double drawn_mm) {
    const double given = s.diameter_mm->value;
    const auto unit = foreign_unit(given, drawn_mm);
    constexpr double kAgree = 0.02;
    const std::string cause = unit                    ? fmt::format(": it is in {}", unit->name)
        : std::abs(2 * given / drawn_mm - 1) < kAgree ? ": that is its radius"
                                                      : "";
    errors_.push_back(diagnostic_at(
        w_.source, s.label_span, Code::E0701,
        fmt::format("'{}' has a diameter of {:.6g} mm by its targets, not {:.6g}{}", s.label, drawn_mm, given, cause),
        "diameter_mm is the calibrated diameter in millimetres"));
    return std::nullopt;
  }

  std::vector<double>& add_doubt() { return out_.doubt_mm.emplace_back(t_.touches.size(), 0.0); }
  static void set(std::vector<double>& column, const std::vector<int>& rows, double value) {
    for (const int i : rows) column[i] = value;
  }

  /// The form of a surface point is the same at every repeat.
  void add_random_form(const std::vector<int>& rows, double sd_mm) {
    const std::vector<int> number = surface_points(t_);
    std::map<int, std::vector<int>> points;
    for (const int i : rows) points[number[static_cast<std::size_t>(i)]].push_back(i);
    for (const auto& [point, same] : points) set(add_doubt(), same, sd_mm);
  }

  /// From the point that is touched first in each placement, as a simulated part: from elsewhere a warm one would seem to
  /// stand beside its targets.
  std::vector<double> stretched(const ThermalDraw& draw) const {
    std::map<int, Vec3> first;
    std::vector<double> r;
    for (const RecordedTouch& touch : t_.touches) {
      const TouchScene& s = touch.scene;
      const Vec3 e = strain(w_, draw, s.temperature, w_.compensated),
                 arm = s.point - first.try_emplace(s.setup, s.point).first->second;
      r.push_back(e.x * arm.x * s.normal.x + e.y * arm.y * s.normal.y + e.z * arm.z * s.normal.z);
    }
    return r;
  }

  void add_expansion() {
    ThermalDraw best;
    best.scale_cte_per_K = w_.scale_cte_per_K.value;
    best.part_cte_per_K = w_.part_cte_per_K.value + (w_.part_cte_from_scale ? best.scale_cte_per_K : 0);
    best.part_sensor_K = w_.sensor_K.value;
    best.scale_sensor_K.fill(w_.sensor_K.value);
    const std::vector<double> expected = stretched(best);
    for (std::size_t i = 0; i < expected.size(); ++i) out_.expected_mm[i] += expected[i];
    const auto doubt = [&](const Uncertain& quantity, auto change) {
      if (quantity.exact()) return;
      ThermalDraw other = best;
      change(other, quantity.u());
      const std::vector<double> moved = stretched(other);
      std::vector<double>& column = add_doubt();
      for (std::size_t i = 0; i < moved.size(); ++i) column[i] = moved[i] - expected[i];
    };
    doubt(w_.scale_cte_per_K, [&](ThermalDraw& d, double u) {
      d.scale_cte_per_K += u, d.part_cte_per_K += w_.part_cte_from_scale ? u : 0;
    });
    doubt(w_.part_cte_per_K, [](ThermalDraw& d, double u) { d.part_cte_per_K += u; });
    add_temperatures(doubt);
    doubt(w_.sensor_K, [](ThermalDraw& d, double u) { d.part_sensor_K += u; });
    for (int k = 0; k < 3; ++k) doubt(w_.sensor_K, [k](ThermalDraw& d, double u) { d.scale_sensor_K[k] += u; });
  }

  /// As draw_thermal: scales with one temperature share its error, and what follows the other shares that of the other.
  template <class Doubt>
  void add_temperatures(const Doubt& doubt) const {
    const bool linked = w_.part_minus_scale_K.has_value();
    if (linked)
      doubt(*w_.part_minus_scale_K,
            [&](ThermalDraw& d, double u) { w_.part_follows_scale ? d.part_K = u : (d.scale_K.fill(-u), 0.0); });
    if (!linked || !w_.part_follows_scale)
      doubt(w_.part_C, [&](ThermalDraw& d, double u) {
        d.part_K = u;
        if (linked) d.scale_K.fill(u);
      });
    if (linked && !w_.part_follows_scale) return;
    for (int k = 0; k < 3; ++k) {
      const bool met = std::find(w_.scale_name, w_.scale_name + k, w_.scale_name[k]) != w_.scale_name + k;
      if (!met)
        doubt(w_.scale_C[k], [&](ThermalDraw& d, double u) {
          for (int j = 0; j < 3; ++j) d.scale_K[j] = w_.scale_name[j] == w_.scale_name[k] ? u : 0;
          if (linked) d.part_K = d.scale_K[0];
        });
    }
  }

  const Workpiece& w_;
  const RecordedTouches& t_;
  bool shifts_;
  std::map<int, std::vector<int>> touches_of_;  ///< by feature
  RecordedPart out_;
  std::vector<Diagnostic> errors_;
};

}  // namespace

void fill_from_workpiece(Recording& recording, const Workpiece& w) {
  for (RecordingRow& row : recording.rows) {
    const Temperatures t = w.temperatures(row.time_s.value_or(0));
    const auto fill = [](std::optional<double>& to, bool known, double value) {
      if (!to && known) to = value;
    };
    fill(row.temp_part_C, w.knows.part, t.part);
    fill(row.temp_x_C, w.knows.scale[0], t.scale[0]);
    fill(row.temp_y_C, w.knows.scale[1], t.scale[1]);
    fill(row.temp_z_C, w.knows.scale[2], t.scale[2]);
    fill(row.temp_air_C, w.knows.air, t.air);
    fill(row.load_kg, w.knows.load, w.load_kg);
  }
}

RecordedPart recorded_part(const Workpiece& w, const Recording& recording, const RecordedTouches& t,
                           const std::string& file) {
  return PartReader(w, t, !targets_are_true(w, recording, file)).read();
}

}  // namespace abbe
