// noise.unequal: touches of one kind scatter more than the others.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>
#include <map>

#include "engine/diagnose/findings/noise/noise_property.hpp"
#include "engine/diagnose/findings/noise/touch_groups.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/effects/noise/noise.hpp"

namespace abbe::diagnose {

namespace {

/// Touches of one kind that scatter more than the others, which they leave `quiet`.
std::optional<NoiseFinding> judge_unequal(Scatter& scatter) {
  Residuals& r = scatter.residuals;
  const std::optional<NoisyGroup> noisy = noisiest(scatter.c, r);
  if (!noisy) return std::nullopt;
  const TouchGroup& group = noisy->group;
  const Vector in = among_rows(scatter.c, group.in);
  const double excess = noisy->excess.size;
  NoiseFinding f{&kUnequalNoise, noisy->p, {figure("ratio", "1", noisy->ratio, noisy->u)}, {}};
  const double others = std::sqrt((r.standardised.array().square() / (1 + excess * in.array())).mean()) * r.noise_um;
  f.parameters.push_back(figure("sd_um", "um", others, others / std::sqrt(2 * (double(in.size()) - in.sum()))));
  f.parameters.push_back({.name = "group", .word = group.kind});
  f.parameters.insert(f.parameters.end(), group.which.begin(), group.which.end());
  ask_repeats(scatter, in, excess / (1 + excess), f);
  f.factor = group.factor, f.where = {group.where};
  f.sentence = fmt::format("{} scatter {:.1f} times as much as the others.", capitalised(group.touches), noisy->ratio);
  if (group.factor == Factor::feature)
    f.sentence += " A machine file with it holds for programs that touch their features in this order.";
  scatter.quiet -= in;
  r.standardised.array() /= (1 + excess * in.array()).sqrt();  // what else scatters is judged beside it
  return f;
}

/// Why no touches are parted from the others: what becomes of each column that could.
CannotJudge not_parted(const RecordedTouches& t) {
  const struct {
    Covariate covariate;
    const char *column, *kind;
  } kinds[] = {{Covariate::head, "head_A_deg", "in another orientation"},
               {Covariate::sensor, "sensor", "with longer styli"},
               {Covariate::speed, "speed_mm_s", "at another speed"},
               {Covariate::time, "time_s", "at another time"}};
  CannotJudge out{std::string(kUnequalNoise.name)};
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
  constexpr std::size_t kSome = 5;  // of one kind: they differ little
  const Case& c = design.planned();
  std::map<std::string_view, std::vector<TouchGroup>> of_kind;
  for (TouchGroup& g : touch_groups(c)) of_kind[g.kind].push_back(std::move(g));
  if (of_kind.empty()) {
    out.cannot_judge.push_back(not_parted(c.touches));
    return;
  }
  const auto form_of = [&](const TouchGroup& g) {
    const Vector in = among_rows(c, g.in);
    const auto told = [&](double excess) {
      return std::sqrt(1 + excess) * (1 - (2 + kPowerDeviations) * relative_u(in)) >= kLeastRatio;
    };
    return design.along(in, told, g.of_its_kind);
  };
  std::vector<ScatterForm> forms;
  for (const auto& [kind, groups] : of_kind) {
    const std::size_t step = (groups.size() + kSome - 1) / kSome;
    std::vector<ScatterForm> form;
    for (std::size_t k = 0; k < groups.size(); k += step) form.push_back(form_of(groups[k]));
    forms.push_back({median_excess(form, &ScatterForm::detected), median_excess(form, &ScatterForm::named)});
  }
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
