#include "engine/diagnose/values/value_naming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "engine/diagnose/findings/belief.hpp"
#include "engine/diagnose/findings/members.hpp"
#include "engine/diagnose/findings/search.hpp"
#include "engine/diagnose/values/value_improvement.hpp"
#include "engine/diagnose/values/value_patterns.hpp"
#include "engine/diagnose/values/value_telling.hpp"

namespace abbe::diagnose {

namespace {

/// How often such machines look as unusual to a search as the recording does.
double chance_of(const ValueCase& c, const ValueSearch& search, const Matrix& machines) {
  return tail_probability(search.evidence(c.deviation).statistic, statistics_of(search, machines));
}

/// How often chance leaves as much as a pattern does, or a name that no machine was simulated with.
double left_by_chance(const ValueCase& c, const Closer& closer, const Finding& f) {
  const ValueSearch without(c.judges.mean, c.judges.covariance, c.search->explanations(), closer.variant(f).signature);
  return chance_of(c, without, c.judges.judged);
}

/// How often a machine with the effect that is named leaves as much as the recording does.
double adequacy_of(const ValueCase& c, const Closer& closer, const Finding& name) {
  if (name.explanation < 0) return 1;
  const auto found = closer.sizes.find(name.variant);
  if (found == closer.sizes.end()) return left_by_chance(c, closer, name);
  const Variant& variant = closer.variant(name);
  const auto chance_beside = [&](const Judges& with) {
    return chance_of(c, ValueSearch(with.mean, with.covariance, c.search->explanations(), variant.signature),
                     with.judged);
  };
  if (found->second.adds) {
    Judges with = c.judges;
    const Vector added = closer.search.predicted(name.variant, found->second.mean);
    with.mean += added, with.judged.rowwise() += added.transpose();
    return chance_beside(with);
  }
  const Machine planted = with_effect(*c.machine, *closer.explanation(name).effect, variant, found->second.mean);
  const Matrix simulated =
      complete(simulated_values(c.ensemble.values, *c.programs, planted, c.ensemble.machines, *c.options));
  if (!enough(simulated)) return left_by_chance(c, closer, name);
  return chance_beside(judges_of(simulated, c.recorded, c.options->seed));
}

/// Of a set those first that need nothing untold.
void put_told_first(const Explanations& all, Finding& name) {
  if (name.set.empty()) return;
  std::stable_partition(name.set.begin(), name.set.end(), [&](int k) { return !all.list[k].missing; });
  name.put_first(name.set.front());
}

struct NameAndPattern {
  Finding name, pattern;
};

/// The likeliest name with a size that it can have, if one is likelier than a pattern; else the likeliest. Beside it the
/// likeliest pattern, once those names are struck that are impossible.
NameAndPattern possible_name(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  constexpr int kTries = 5;
  constexpr double kStruck = -1e6;
  const Explanations& all = closer.search.explanations();
  Evidence left = evidence;
  std::optional<NameAndPattern> likeliest;
  for (int k = 0; k < kTries; ++k) {
    NameAndPattern now{finding_of(all, left, true), finding_of(all, left, false)};
    put_told_first(all, now.name);
    if (!likeliest) likeliest = now;
    if (!likelier(now.name, now.pattern, kNamed)) break;
    if (all_plausible(parameters_of(c, closer, now.name))) return now;
    left.log_bayes[now.name.explanation] = kStruck;
  }
  return *likeliest;
}

/// The characteristic that strays by itself, where chance leaves as much as the others do.
std::optional<Finding> one_characteristic(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  const Explanations& all = closer.search.explanations();
  const auto found = std::find_if(all.list.begin(), all.list.end(),
                                  [](const Explanation& e) { return e.shape == kOneCharacteristic; });
  if (found == all.list.end()) return std::nullopt;
  const Finding f = finding_of_one(all, evidence, static_cast<int>(found - all.list.begin()));
  return left_by_chance(c, closer, f) >= kInadequate ? std::optional(f) : std::nullopt;
}

/// The characteristic, of one tolerance and reference, and one artefact where rows say which, that strays alike in all
/// places where it was measured: where chance leaves as much once its offset is free. Only among others.
std::optional<StraysAlike> one_in_all_places(const ValueCase& c) {
  constexpr std::size_t kOtherReferences = 2;  // of fewer nobody knows which it is
  constexpr double kSameReference = 1e-3;      // mm or degrees: what rounding leaves of a program's nominals
  using Which = std::tuple<std::string, long long, std::string>;
  std::map<Which, std::set<std::tuple<int, int, int>>> places;
  std::map<Which, Vector> columns;
  const auto n = static_cast<Eigen::Index>(c.ensemble.values.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    const RecordedValue& v = c.ensemble.values[static_cast<std::size_t>(k)];
    const ValueRow& row = c.recording->rows[static_cast<std::size_t>(k)];
    const Which which{abbe::labels_of(row.characteristic).back(), std::llround(v.reference / kSameReference),
                      row.artefact};
    places[which].insert({v.program, v.characteristic.value, v.occurrence});
    columns.try_emplace(which, Vector::Zero(n)).first->second(k) = 1;
  }
  if (columns.size() <= kOtherReferences) return std::nullopt;
  const Cholesky root(c.judges.covariance);
  const Vector white = root.whitened(Vector(c.deviation - c.judges.mean));
  std::optional<StraysAlike> most;
  for (const auto& [which, column] : columns) {
    if (places[which].size() < 2) continue;
    const Vector of = root.whitened(column);
    const double size = of.dot(white) / of.squaredNorm(), energy = size * of.dot(white);
    if (most && energy <= most->energy) continue;
    Eigen::Index first = 0;
    column.maxCoeff(&first);
    const RecordedValue& v = c.ensemble.values[static_cast<std::size_t>(first)];
    most = {std::get<0>(which), v.reference, v.angle, places[which].size(), column, size, energy};
  }
  if (!most) return std::nullopt;
  const ValueSearch without(c.judges.mean, c.judges.covariance, c.search->explanations(), most->column);
  return chance_of(c, without, c.judges.judged) >= kInadequate ? most : std::nullopt;
}

}  // namespace

void tell_explanation(const ValueCase& c, const Closer& closer, Diagnosis& out) {
  const Evidence evidence = closer.search.evidence(c.deviation);
  auto [name, pattern] = possible_name(c, closer, evidence);
  const double adequacy = adequacy_of(c, closer, name);
  const bool doubted = adequacy < kInadequate && leaves_less(left_by_chance(c, closer, pattern), adequacy);
  const bool named = likelier(name, pattern, doubted ? kNamedInDoubt : kNamed);
  std::optional<StraysAlike> alike;
  if (!named) {
    const std::optional<Finding> one = one_characteristic(c, closer, evidence);
    if (one)
      pattern = *one;
    else
      alike = one_in_all_places(c);
  }
  show_improvement(c, closer, named ? name : pattern, out);
  if (named)
    tell_name(c, closer, name, adequacy, out);
  else if (alike)
    tell_strays_alike(c, *alike, out);
  else
    tell_pattern(c, closer, pattern, out);
  if (!named && name.explanation >= 0 && out.unexplained->shape != kOneCharacteristic &&
      !is_over_runs(closer.explanation(pattern)))
    out.unexplained->sentence +=
        fmt::format(" Of the catalogue, {} comes nearest.", closer.explanation(name).effect->title);
}

}  // namespace abbe::diagnose
