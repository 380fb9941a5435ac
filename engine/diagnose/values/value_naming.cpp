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
#include "engine/diagnose/values/value_checks.hpp"
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

constexpr double kStruck = -1e6;  // of a logarithm

struct NameAndPattern {
  Finding name, pattern;
};

/// The likeliest name with a size that it can have, if one is likelier than a pattern; else the likeliest. Beside it the
/// likeliest pattern, once those names are struck that are impossible.
NameAndPattern possible_name(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  constexpr int kTries = 5;
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

/// The pattern of this shape, if there is one.
std::optional<Finding> pattern_of(const Explanations& all, const Evidence& evidence, const std::string& shape) {
  const auto found =
      std::find_if(all.list.begin(), all.list.end(), [&](const Explanation& e) { return e.shape == shape; });
  if (found == all.list.end()) return std::nullopt;
  return finding_of_one(all, evidence, static_cast<int>(found - all.list.begin()));
}

/// Whether one or two values that lie far from their repeats are all that is wrong: no run scatters then.
bool are_slips(const ValueCase& c) {
  const std::vector<FarRepeat> far = far_from_repeats(c);
  if (far.empty() || far.size() > 2) return false;
  Matrix slips = Matrix::Zero(c.deviation.size(), static_cast<Eigen::Index>(far.size()));
  for (std::size_t k = 0; k < far.size(); ++k)
    slips(static_cast<Eigen::Index>(far[k].value), static_cast<Eigen::Index>(k)) = 1;
  const ValueSearch without(c.judges.mean, c.judges.covariance, c.search->explanations(), slips);
  return chance_of(c, without, c.judges.judged) >= kInadequate;
}

void strike(const Explanations& all, const std::string& shape, Evidence& evidence) {
  for (std::size_t k = 0; k < all.list.size(); ++k)
    if (all.list[k].shape == shape) evidence.log_bayes[k] = kStruck;
}

/// The characteristic that strays by itself, where chance leaves as much as the others do.
std::optional<Finding> one_characteristic(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  const std::optional<Finding> f = pattern_of(closer.search.explanations(), evidence, kOneCharacteristic);
  return f && left_by_chance(c, closer, *f) >= kInadequate ? f : std::nullopt;
}

/// The reference that strays alike in all places, where chance leaves as much once its offset is free; of two, where chance
/// does not leave as much once that of the other is free, or nobody knows which it is.
std::optional<Finding> one_reference(const ValueCase& c, const Closer& closer, const Evidence& evidence) {
  const Explanations& all = closer.search.explanations();
  const std::optional<Finding> f = pattern_of(all, evidence, kOneReference);
  if (!f || left_by_chance(c, closer, *f) < kInadequate) return std::nullopt;
  const auto moved = [&](int variant) { return all.variants[variant].signature.col(0).array() != 0; };
  for (const int b : closer.explanation(*f).variants) {
    Finding other = *f;
    other.variant = b;
    if ((moved(b) != moved(f->variant)).all() && left_by_chance(c, closer, other) >= kInadequate) return std::nullopt;
  }
  return f;
}

}  // namespace

void tell_explanation(const ValueCase& c, const Closer& closer, Diagnosis& out) {
  Evidence evidence = closer.search.evidence(c.deviation);
  const std::optional<Finding> reference = one_reference(c, closer, evidence);
  if (!reference) strike(closer.search.explanations(), kOneReference, evidence);
  if (are_slips(c)) strike(closer.search.explanations(), kScatterOfRun, evidence);
  auto [name, pattern] = possible_name(c, closer, evidence);
  const double adequacy = adequacy_of(c, closer, name);
  const bool doubted = adequacy < kInadequate && leaves_less(left_by_chance(c, closer, pattern), adequacy);
  bool named = likelier(name, pattern, doubted ? kNamedInDoubt : kNamed);
  if (const std::optional<Finding> one = named ? std::nullopt : one_characteristic(c, closer, evidence))
    pattern = *one;
  else if (reference && (!named || adequacy < kInadequate))
    pattern = *reference, named = false;
  show_improvement(c, closer, named ? name : pattern, out);
  if (named)
    tell_name(c, closer, name, adequacy, out);
  else
    tell_pattern(c, closer, pattern, out);
  const bool located = pattern.explanation >= 0 && is_located(closer.explanation(pattern));
  if (!named && name.explanation >= 0 && !located)
    out.unexplained->sentence +=
        fmt::format(" Of the catalogue, {} comes nearest.", closer.explanation(name).effect->title);
}

}  // namespace abbe::diagnose
