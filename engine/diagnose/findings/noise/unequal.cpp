// noise.unequal: touches of one kind scatter more than the others.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

/// A group of noise.unequal.
struct Split {
  const char* group;
  std::string touches;                        ///< in words: "touches with long styli"
  std::pair<std::string, std::string> where;  ///< of a location
  Factor factor;
  Vector in;                              ///< 1: in the group
  std::vector<DiagnosedParameter> which;  ///< parameters of the effect that part it from the others
  int of_its_kind = 1;  ///< the groups of one kind are one look: the chance of each counts so many times
};

/// From where on a ratio of standard deviations is worth telling.
constexpr double kLeastRatio = 1.1;
/// Touches that a group, and the others, must have at least.
constexpr int kEnoughOfGroup = 20;

bool parts(const Split& s) {
  return s.in.sum() >= kEnoughOfGroup && double(s.in.size()) - s.in.sum() >= kEnoughOfGroup;
}

DiagnosedParameter limit(const char* name, const char* unit, double value) {
  return {.name = name, .unit = unit, .value = value, .low = value, .high = value};
}

/// One orientation of the head against all others; none where that is a group already.
std::vector<Split> orientations(const Case& c, const std::vector<Split>& others) {
  std::vector<Split> out;
  for (Eigen::Index first = 0; first < static_cast<Eigen::Index>(c.rows.size()); ++first) {
    if (std::any_of(out.begin(), out.end(), [&](const Split& s) { return s.in(first) == 1; })) continue;
    const StylusScene& head = scene_of_row(c, first).stylus;
    Vector in(static_cast<Eigen::Index>(c.rows.size()));
    for (Eigen::Index k = 0; k < in.size(); ++k)
      in(k) = same_orientation(scene_of_row(c, k).stylus, head.head_a_rad, head.head_b_rad);
    const double a = in_degrees(head.head_a_rad), b = in_degrees(head.head_b_rad);
    const std::string orientation = fmt::format("A {:.1f} B {:.1f}", a, b);
    out.push_back({"one orientation",
                   "touches with the head at " + orientation,
                   {"head", orientation},
                   Factor::head,
                   std::move(in),
                   {limit("head_a_deg", "deg", a), limit("head_b_deg", "deg", b)}});
  }
  const auto known = [&](const Split& s) {
    return !parts(s) || std::any_of(others.begin(), others.end(), [&](const Split& other) { return other.in == s.in; });
  };
  out.erase(std::remove_if(out.begin(), out.end(), known), out.end());
  for (Split& s : out) s.of_its_kind = static_cast<int>(out.size());
  return out;
}

/// All of them; a group that these touches do not part is empty or holds all.
std::vector<Split> splits_of(const Case& c) {
  const auto rows = static_cast<Eigen::Index>(c.rows.size());
  Vector length(rows), speed(rows), tilt(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const TouchScene& s = scene_of_row(c, k);
    length(k) = s.stylus.length_mm, speed(k) = s.speed_mm_s, tilt(k) = std::abs(s.stylus.head_a_rad);
  }
  const double long_mm = (length.minCoeff() + length.maxCoeff()) / 2 + 1,
               fast_mm_s = (speed.minCoeff() + speed.maxCoeff()) / 2 + 1e-6;
  const auto above = [](const Vector& v, double least) { return Vector((v.array() > least).cast<double>()); };
  const auto group = [](const char* name, Factor factor, Vector in, std::vector<DiagnosedParameter> which) {
    return Split{name, fmt::format("touches with {}", name), {"group", name}, factor, std::move(in), std::move(which)};
  };
  std::vector<Split> out{
      group("long styli", Factor::sensor, above(length, long_mm), {limit("longer_than_mm", "mm", long_mm)}),
      group("tilted head", Factor::head, above(tilt, kUpright_rad), {}),
      group("fast probing", Factor::speed, above(speed, fast_mm_s), {limit("faster_than_mm_s", "mm/s", fast_mm_s)})};
  for (Split& s : orientations(c, out)) out.push_back(std::move(s));
  return out;
}

/// Standard uncertainty of a ratio of standard deviations over that ratio.
double relative_u(const Split& s) {
  const double in = s.in.sum(), out = double(s.in.size()) - in;
  return std::sqrt(1 / (2 * in) + 1 / (2 * out));
}

/// Touches of one kind that scatter more than the others, which they leave `quiet`.
std::optional<NoiseFinding> judge_unequal(Scatter& scatter) {
  const Case& c = scatter.c;
  const Residuals& r = scatter.residuals;
  std::optional<NoiseFinding> best;
  Vector in;
  for (const Split& s : splits_of(c)) {
    if (!parts(s)) continue;
    const Excess e = excess_along(r, s.in);
    const double p = s.of_its_kind * chance_of_excess(e.chi2), ratio = std::sqrt(1 + e.size), u = ratio * relative_u(s);
    if (p > kNoiseAlarm || ratio - 2 * u < kLeastRatio || (best && best->p < p)) continue;
    NoiseFinding f{&kUnequalNoise, p, {figure("ratio", "1", ratio, u)}, {}};
    const double others =
        std::sqrt((r.standardised.array().square() / (1 + e.size * s.in.array())).mean()) * r.noise_um;
    f.parameters.push_back(figure("sd_um", "um", others, others / std::sqrt(2 * (double(s.in.size()) - s.in.sum()))));
    f.parameters.push_back({.name = "group", .unit = "", .word = s.group});
    f.parameters.insert(f.parameters.end(), s.which.begin(), s.which.end());
    ask_repeats(scatter, s.in, e.size / (1 + e.size), f);
    f.factor = s.factor, f.where = {s.where};
    f.sentence = fmt::format("T{} scatter {:.1f} times as much as the others.", s.touches.substr(1), ratio);
    best = std::move(f), in = s.in;
  }
  if (best) scatter.quiet -= in;
  return best;
}

/// Why no touches are parted from the others: what becomes of each column that could.
CannotJudge not_parted(const RecordedTouches& t) {
  const struct {
    Covariate covariate;
    const char *column, *kind;
  } kinds[] = {{Covariate::head, "head_A_deg", "in another orientation"},
               {Covariate::sensor, "sensor", "with longer styli"},
               {Covariate::speed, "speed_mm_s", "at another speed"}};
  CannotJudge out{std::string(kUnequalNoise.name), {}, {}};
  std::vector<std::string> of;
  for (const auto& [covariate, column, kind] : kinds) {
    const auto what = static_cast<unsigned>(covariate);
    out.missing.emplace_back(column);
    if ((t.known & what) == 0) continue;
    if ((t.varying & what) == 0) {
      out.constant.emplace_back(column);
      continue;
    }
    out.too_few.emplace_back(column);
    of.emplace_back(kind);
  }
  if (!of.empty()) out.too_few_of = fmt::format("fewer than {} touches {}", kEnoughOfGroup, fmt::join(of, " or "));
  return out;
}

void plan_unequal(const ScatterDesign& design, Diagnosis& out) {
  std::map<std::string_view, std::vector<ScatterForm>> of_kind;
  for (const Split& s : splits_of(design.planned())) {
    if (!parts(s)) continue;
    const auto told = [&](double excess) {
      return std::sqrt(1 + excess) * (1 - (2 + kPowerDeviations) * relative_u(s)) >= kLeastRatio;
    };
    of_kind[s.group].push_back(design.along(s.in, told, s.of_its_kind));
  }
  if (of_kind.empty()) {
    out.cannot_judge.push_back(not_parted(design.planned().touches));
    return;
  }
  std::vector<ScatterForm> forms;
  for (const auto& [kind, form] : of_kind)
    forms.push_back({median_excess(form, &ScatterForm::detected), median_excess(form, &ScatterForm::named)});
  const double seen = median_excess(forms, &ScatterForm::detected), named = median_excess(forms, &ScatterForm::named);
  if (seen == kAtNoSize) return;
  Detectable d = smallest_of(kUnequalNoise, "ratio", "1");
  d.detect = std::sqrt(1 + seen), d.detect_um = design.noise_um() * std::sqrt(seen);
  if (named < kAtNoSize) d.name = std::sqrt(1 + named), d.name_um = design.noise_um() * std::sqrt(named);
  out.smallest_detectable.push_back(std::move(d));
}

}  // namespace

const NoiseProperty kJudgedUnequal{&kUnequalNoise, true, judge_unequal, plan_unequal};

}  // namespace abbe::diagnose
