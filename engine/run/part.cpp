#include "engine/run/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/letter_case.hpp"
#include "engine/features/shape_traits.hpp"
#include "engine/lanes/elementary.hpp"
#include "engine/lanes/random.hpp"
#include "engine/recording/units.hpp"

namespace abbe {

namespace {

bool is_round(Shape shape) { return shape == Shape::circle || shape == Shape::cylinder || shape == Shape::cone; }

/// Labels of the features that the plan touches, as the program writes them.
std::vector<std::string_view> touched_labels(const plan::Plan& plan) {
  std::vector<std::string_view> labels;
  for (const plan::Operation& op : plan.operations)
    if (const auto* touch = std::get_if<plan::Touch>(&op.action)) labels.push_back(plan[touch->feature].label);
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

Diagnostic no_such_surface(const Workpiece& w, const Surface& surface, const plan::Plan& plan) {
  const std::vector<std::string_view> labels = touched_labels(plan);
  const std::string near = nearest_word(surface.label, labels);
  return diagnostic_at(
      w.source, surface.label_span, Code::E0423, fmt::format("the program measures no feature '{}'", surface.label),
      near.empty() ? fmt::format("it measures: {}", fmt::join(labels, ", ")) : fmt::format("did you mean '{}'?", near));
}

/// What the file gives of a surface: the offset along its outward normal, or the diameter in one of two ways.
const Uncertain& given_of(const Surface& surface) {
  if (surface.diameter_deviation_mm) return *surface.diameter_deviation_mm;
  return surface.diameter_mm ? *surface.diameter_mm : surface.offset_mm;
}

struct CosSin {
  double cos = 1, sin = 0;
};
/// Cosine and sine of n phi from those of phi: powers of a complex number, without libm.
CosSin times(int n, CosSin phi) {
  CosSin out;
  for (; n > 0; --n) out = {out.cos * phi.cos - out.sin * phi.sin, out.sin * phi.cos + out.cos * phi.sin};
  return out;
}

/// The angle of a touch about the axis of its feature; on the axis itself it is 0.
CosSin angle_about_axis(const PlaceOnPart& at) {
  const Vec3 axis = at.nominal.direction;
  Vec3 from = perpendicular_part(at.x_axis, axis);
  if (norm(from) < 1e-6) from = perpendicular_part(at.y_axis, axis);
  const Vec3 radial = perpendicular_part(at.point - at.nominal.point, axis);
  if (norm(radial) == 0) return {};
  const Vec3 e = unit(from), r = unit(radial);
  return {dot(r, e), dot(r, cross(axis, e))};
}

}  // namespace

TouchedSpots::Numbers TouchedSpots::at(const Vec3& point, const Vec3& normal, std::uint32_t site) {
  constexpr double kAcross_mm = 1e-3;  // a program says places to a micrometre
  constexpr double kAlong_mm = 0.1;    // recorded points scatter along the normal
  constexpr double kParallel = 0.99;
  const auto is_here = [&](const Spot& spot) {
    const Vec3 from = point - spot.point;
    return std::abs(dot(from, normal)) < kAlong_mm && norm(perpendicular_part(from, normal)) < kAcross_mm &&
        dot(normal, spot.normal) > kParallel;
  };
  constexpr double kReach_mm = kAlong_mm + kAcross_mm;
  const Cell low = cell_of(point - Vec3{kReach_mm, kReach_mm, kReach_mm}),
             high = cell_of(point + Vec3{kReach_mm, kReach_mm, kReach_mm});
  std::size_t first = spots_.size();
  for (long x = low[0]; x <= high[0]; ++x)
    for (long y = low[1]; y <= high[1]; ++y)
      for (long z = low[2]; z <= high[2]; ++z)
        if (const auto in = cells_.find({x, y, z}); in != cells_.end())
          for (const std::size_t k : in->second)
            if (k < first && is_here(spots_[k])) first = k;
  if (first < spots_.size()) return spots_[first].numbers;
  cells_[cell_of(point)].push_back(spots_.size());
  spots_.push_back({point, normal, {site, visits_[site]++}});
  return spots_.back().numbers;
}

TouchedSpots::Cell TouchedSpots::cell_of(const Vec3& point) {
  return {std::lround(std::floor(point.x)), std::lround(std::floor(point.y)), std::lround(std::floor(point.z))};
}

Part::Part(const Workpiece& workpiece, const plan::Plan& plan)
    : workpiece_(&workpiece), on_surface_(plan.features.size()) {
  std::vector<Diagnostic> errors;
  const std::vector<std::string_view> touched = touched_labels(plan);
  for (int index = 0; index < static_cast<int>(workpiece.surfaces.size()); ++index) {
    const Surface& surface = workpiece.surfaces[index];
    const std::size_t before = errors.size();
    bool found = false;
    for (std::size_t f = 0; f < plan.features.size() && errors.size() == before; ++f) {
      if (!same_label(plan.features[f].label, surface.label)) continue;
      if (std::find(touched.begin(), touched.end(), plan.features[f].label) == touched.end()) continue;
      on_surface_[f] = resolve(index, plan.features[f], errors);
      found = true;
    }
    if (!found) errors.push_back(no_such_surface(workpiece, surface, plan));
  }
  if (!errors.empty()) throw UserError(std::move(errors));
}

Part::OnSurface Part::resolve(int index, const plan::FeatureDef& def, std::vector<Diagnostic>& errors) const {
  const Surface& surface = workpiece_->surfaces[index];
  const auto refuse = [&](std::string_view what, std::string help) {
    errors.push_back(diagnostic_at(workpiece_->source, surface.label_span, Code::E0424,
                                   fmt::format("feature '{}' is a {} and has no {}", def.label, def.kind->word, what),
                                   std::move(help)));
  };
  const bool as_diameter = surface.diameter_mm || surface.diameter_deviation_mm;
  if (as_diameter && !has_diameter(def.kind->shape))
    refuse("diameter", "give \"offset_um\", how far its surface lies out of the material");
  if (!surface.form.empty() && !is_round(def.kind->shape))
    refuse("undulations", "\"form\" is for circles, cylinders and cones; \"random_form_um\" is for every surface");
  const double size = def.nominal.size, per_deviation = !as_diameter ? 1 : def.inner ? -0.5 : 0.5;
  const OnSurface out{index, per_deviation};
  constexpr double kNoDeviation = 0.1;  // of the size: that is another part, or another unit
  const double known_mm = offset_mm(out, size);
  if (!has_diameter(def.kind->shape) || !(size > 0) || std::abs(known_mm) <= kNoDeviation * size) return out;
  const std::optional<ForeignUnit> unit =
      surface.diameter_mm ? foreign_unit(surface.diameter_mm->value, 2 * size) : std::nullopt;
  errors.push_back(diagnostic_at(
      workpiece_->source, surface.label_span, Code::E0424,
      fmt::format("the surface of '{}' lies {:g} mm from where the program has it, and its diameter there is {:g} mm{}",
                  def.label, known_mm, 2 * size, unit ? fmt::format(": it is given in {}", unit->name) : ""),
      "diameters are in millimetres, offsets and deviations in micrometres"));
  return out;
}

double Part::offset_mm(const OnSurface& on, double nominal_radius_mm) const {
  const Surface& surface = workpiece_->surfaces[on.index];
  const double deviation_mm = given_of(surface).value - (surface.diameter_mm ? 2 * nominal_radius_mm : 0);
  return on.per_deviation * deviation_mm;
}

double Part::known_offset_mm(const PlaceOnPart& at) const {
  const OnSurface on = given() ? on_surface_[at.feature.value] : OnSurface{};
  if (on.index < 0) return 0;
  double offset = offset_mm(on, at.nominal.size);
  for (const FormHarmonic& h : workpiece_->surfaces[on.index].form) {
    if (!h.phase_half_turns) continue;
    const CosSin angle = times(h.undulations, angle_about_axis(at));
    const SinCos phase = sin_cos_pi(*h.phase_half_turns);
    offset += h.amplitude_mm.value * (angle.cos * phase.cos - angle.sin * phase.sin);
  }
  return offset;
}

Part::Draw Part::draw(DrawFor who) const {
  Draw d{who, {}, {}};
  if (!given()) return d;
  d.thermal = draw_thermal(*workpiece_, who);
  for (const Surface& surface : workpiece_->surfaces) {
    const std::string name = "surfaces." + upper(surface.label);
    Draw::Surface s;
    s.deviation_mm = deviation(given_of(surface), name + ".offset", who);
    const Uncertain& random = surface.random_form_mm;
    s.random_sd_mm = random.value + deviation(random, name + ".random_form", who);
    for (std::size_t k = 0; k < surface.form.size(); ++k) {
      const FormHarmonic& h = surface.form[k];
      const std::string harmonic = fmt::format("{}.form.{}", name, k);
      double amplitude = deviation(h.amplitude_mm, harmonic + ".amplitude", who);
      if (!h.phase_half_turns) amplitude += h.amplitude_mm.value;
      const SinCos phase =
          sin_cos_pi(h.phase_half_turns ? *h.phase_half_turns : 2 * uniform_pair_for(harmonic + ".phase", who).a);
      s.form.push_back({h.undulations, amplitude * phase.cos, -amplitude * phase.sin});
    }
    d.surfaces.push_back(std::move(s));
  }
  return d;
}

bool Part::has_random_form(plan::FeatureId feature) const {
  const int index = given() ? on_surface_[feature.value].index : -1;
  return index >= 0 && !workpiece_->surfaces[index].random_form_mm.is_zero();
}

Vec3 Part::error(const Draw& draw, const PlaceOnPart& at, const Vec3& from_fixed, const Temperatures& estimate,
                 bool compensated, TouchedSpots::Numbers random_form) const {
  constexpr std::uint32_t kRandomForm = stream_of("workpiece.random_form");
  const Vec3 strained = strain(*workpiece_, draw.thermal, estimate, compensated);
  Vec3 d{strained.x * from_fixed.x, strained.y * from_fixed.y, strained.z * from_fixed.z};
  const OnSurface& on = on_surface_[at.feature.value];
  if (on.index < 0) return d;
  const Draw::Surface& s = draw.surfaces[on.index];
  double proud = on.per_deviation * s.deviation_mm;
  for (const auto& h : s.form) {
    if (h.cos_mm == 0 && h.sin_mm == 0) continue;
    const CosSin angle = times(h.undulations, angle_about_axis(at));
    proud += h.cos_mm * angle.cos + h.sin_mm * angle.sin;
  }
  if (s.random_sd_mm != 0)
    proud +=
        s.random_sd_mm *
        normal_quantile(
            uniform_pair({draw.who.seed, draw.who.machine, kRandomForm, random_form.site, random_form.visit, 0}).a);
  return d + proud * at.normal;
}

}  // namespace abbe
