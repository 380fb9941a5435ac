// Sizes of what was named, with uncertainties: a mixture over the variants of the effect, each a
// linear-Gaussian posterior with a prior so wide that it does not pull.
#include "engine/diagnose/findings/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/explanations/parameter_grid.hpp"
#include "engine/diagnose/explanations/refine.hpp"
#include "engine/diagnose/explanations/value_called.hpp"
#include "engine/diagnose/findings/variant_estimate.hpp"
#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

/// One variant's estimate of one figure: a normal distribution, or for a value that was sought an even one over the
/// values that the variant stands for.
struct MixtureTerm {
  double weight = 0, value = 0, u = 0;
  bool even = false;
  bool length = false;  ///< of a vector: never less than nothing
};

/// The share of a term below x.
double below(const MixtureTerm& c, double x) {
  if (c.u == 0) return x >= c.value ? 1 : 0;
  const double t = (x - c.value) / c.u;
  return c.even ? std::clamp(0.5 + t / std::sqrt(12.0), 0.0, 1.0) : normal_below(t);
}

/// The quantile of a mixture, by bisection.
double quantile(const std::vector<MixtureTerm>& mixture, double p) {
  double low = 1e300, high = -1e300;
  for (const MixtureTerm& c : mixture)
    low = std::min(low, c.value - 10 * c.u - 1e-12), high = std::max(high, c.value + 10 * c.u + 1e-12);
  for (int step = 0; step < 80; ++step) {
    const double x = (low + high) / 2;
    double share = 0;
    for (const MixtureTerm& c : mixture) share += c.weight * below(c, x);
    (share < p ? low : high) = x;
  }
  return (low + high) / 2;
}

/// `value`: the one that stands for the mixture, about which it spreads by u; without, its mean.
DiagnosedParameter summary(const EffectParameter& parameter, const std::vector<MixtureTerm>& mixture,
                           std::optional<double> value = {}) {
  DiagnosedParameter out{.name = std::string(parameter.name), .unit = std::string(parameter.unit)};
  double square = 0;
  for (const MixtureTerm& c : mixture) out.value += c.weight * c.value;
  if (value) out.value = *value;
  for (const MixtureTerm& c : mixture) square += c.weight * (c.u * c.u + std::pow(c.value - out.value, 2));
  out.u = std::sqrt(square);
  out.low = quantile(mixture, 0.025);
  if (std::any_of(mixture.begin(), mixture.end(), [](const MixtureTerm& c) { return c.length; }))
    out.low = std::max(0.0, out.low);
  out.high = quantile(mixture, 0.975);
  if (out.u == 0) out.low = out.high = out.value;
  // What fits best need not be in the middle of what is believed.
  if (value) out.low = std::min(out.low, *value), out.high = std::max(out.high, *value);
  out.plausible = out.high >= parameter.low && out.low <= parameter.high;
  return out;
}

/// One variant's figure, which no other variant shares.
DiagnosedParameter told(const EffectParameter& parameter, const Estimate& e) {
  return summary(parameter, {{1, e.value, e.u}});
}

/// The standard deviation of draws: what their likelihood says of it, beside what the machine file lets them do anyway.
std::vector<MixtureTerm> spread_estimate(const Information& info, double unit) {
  constexpr double kLeast = 0.01, kMost = 100, kStep = 1.03;
  const auto [values, axes] = spectrum(info.g);
  const Vector d = values.cwiseMax(0), t = (axes.transpose() * info.u).array().square();
  std::vector<MixtureTerm> terms;
  std::vector<double> logs;
  for (double s = kLeast; s < kMost; s *= kStep) {
    const Vector v = 1 + s * s * d.array();
    logs.push_back(0.5 * (s * s * (t.array() / v.array()).sum() - v.array().log().sum()) + std::log(s));  // evenly in s
    terms.push_back({0, unit * s, unit * s * (kStep - 1) / std::sqrt(12.0)});
  }
  const double total = log_sum_exp(logs);
  for (std::size_t k = 0; k < terms.size(); ++k) terms[k].weight = std::exp(logs[k] - total);
  return terms;
}

/// The mean of the values that follow on those of a cell without a gap. Between two touches all places of a step are
/// as likely; two periods that both fit have nothing between them.
double mean_beside(std::vector<MixtureTerm> mixture, const Cell& cell) {
  constexpr double kRounding = 1e-9;
  double low = cell.low, high = cell.high, weight = 0, sum = 0;
  const auto half = [](const MixtureTerm& c) { return c.u * std::sqrt(3.0); };
  for (bool longer = true; longer;) {
    const auto beside = [&, rounding = kRounding * (std::abs(low) + std::abs(high))](const MixtureTerm& c) {
      return c.value + half(c) >= low - rounding && c.value - half(c) <= high + rounding;
    };
    const auto rest = std::partition(mixture.begin(), mixture.end(), beside);
    longer = rest != mixture.begin();
    for (auto c = mixture.begin(); c != rest; ++c) {
      low = std::min(low, c->value - half(*c)), high = std::max(high, c->value + half(*c));
      weight += c->weight, sum += c->weight * c->value;
    }
    mixture.erase(mixture.begin(), rest);
  }
  return sum / weight;
}

class Estimator {
 public:
  /// `member`: of the finding's set.
  Estimator(const Case& c, const SearchResult& result, std::size_t which, int member)
      : touches_(c.touches), rows_(c.rows), explanation_(c.explanations.list[member]) {
    const Finding& f = result.findings[which];
    std::vector<const Matrix*> others;
    for (std::size_t k = 0; k < result.findings.size(); ++k)
      if (k != which) others.push_back(&c.explanations.variants[result.findings[k].variant].signature);
    Explanations mine = only(c.explanations, {member});
    // Scale and noise as they are once everything named is taken out.
    std::vector<const Matrix*> all = others;
    all.push_back(&c.explanations.variants[f.variant_of(member)].signature);
    const Hyperparameters hyper = estimate(with_free(c.model, all));
    EvidenceSearch search(with_free(c.model, others), hyper, mine);
    if (!result.refined.contains(member)) refine(c, mine, search);
    const Evidence& evidence = search.evidence();
    const std::vector<int>& variants = mine.list.front().variants;
    const auto at = [&](int b) -> const Variant& { return mine.variants[b]; };
    const int likeliest = best_variant(mine, 0, evidence);
    // Of its values those that fit best are told: a cell that was not divided is believed more than one of three parts of
    // a likelier one.
    int best = likeliest;
    for (const int b : variants)
      if (alike(at(b), at(likeliest)) && evidence.variant_log_bayes[b] > evidence.variant_log_bayes[best]) best = b;
    std::vector<double> logs;  // told is the likeliest fault, over the values of what has a value between any two
    for (const int b : variants)
      logs.push_back(alike(at(b), at(likeliest)) ? log_belief(mine, evidence, b)
                                                 : -std::numeric_limits<double>::infinity());
    listed_ = beliefs_of(mine, evidence, likeliest);
    const double total = log_sum_exp(logs);
    for (std::size_t k = 0; k < variants.size(); ++k) {
      const double weight = std::exp(logs[k] - total);
      if (weight < 1e-4 && variants[k] != best) continue;
      if (variants[k] == best) likeliest_ = variants_.size();
      variants_.push_back({weight, at(variants[k]), {}, search.information(variants[k])});
    }
    for (Candidate& v : variants_) v.estimate.emplace(*explanation_.effect, v.variant, v.info);
    for (const EffectParameter& p : explanation_.effect->parameters) grids_.push_back(grid_of(p, c.touches));
  }

  const Variant& likeliest() const { return variants_[likeliest_].variant; }
  /// What the likeliest variant does at the touch where it does most. Draws have no parameters: they are
  /// taken at the spread that is told.
  double largest_um() const {
    const Candidate& likeliest = variants_[likeliest_];
    if (explanation_.effect->draws == 0) return largest(likeliest.estimate->shift_um());
    double spread = 0;
    for (const MixtureTerm& c : spread_estimate(likeliest.info, 1)) spread += c.weight * c.value;
    const Cholesky posterior(likeliest.info.g, 1 / (spread * spread));
    return largest(likeliest.variant.signature * posterior.solve(likeliest.info.u));
  }

  std::vector<DiagnosedParameter> all() const {
    std::vector<DiagnosedParameter> out;
    for (std::size_t p = 0; p < grids_.size(); ++p) add(p, out);
    doubt_contradictions(out);
    return out;
  }

 private:
  struct Candidate {
    double weight;
    Variant variant;
    std::optional<VariantEstimate> estimate;
    Information info;
  };

  /// Sizes that do not go together even where each is as small as it may be.
  void doubt_contradictions(std::vector<DiagnosedParameter>& told) const {
    const Effect& effect = *explanation_.effect;
    if (!effect.contradiction) return;
    std::vector<double> theta = variants_[likeliest_].variant.theta;
    const auto parameter_of = [&](const DiagnosedParameter& t) {
      return static_cast<std::size_t>(std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                                   [&](const EffectParameter& p) { return p.name == t.name; }) -
                                      effect.parameters.begin());
    };
    for (const DiagnosedParameter& t : told)
      if (const std::size_t p = parameter_of(t); effect.parameters[p].linear)
        theta[p] = t.low <= 0 && t.high >= 0 ? 0 : std::min(std::abs(t.low), std::abs(t.high));
    if (effect.contradiction(theta.data()).empty()) return;
    for (DiagnosedParameter& t : told)
      if (effect.parameters[parameter_of(t)].linear) t.plausible = false;
  }

  static double largest(const Vector& shift_um) { return shift_um.cwiseAbs().maxCoeff(); }

  void add(std::size_t p, std::vector<DiagnosedParameter>& out) const {
    const EffectParameter& parameter = explanation_.effect->parameters[p];
    const Candidate& likeliest = variants_[likeliest_];
    if (parameter.linear) {
      const auto mixture = explanation_.effect->draws > 0 ? spread(parameter) : linear(static_cast<int>(p));
      if (!mixture.empty()) out.push_back(summary(parameter, mixture));
      return;
    }
    switch (grids_[p].kind) {
      case ParameterGrid::Kind::direction: return add_direction(p, out);
      case ParameterGrid::Kind::phase:
        if (const auto phase = likeliest.estimate->phase_deg(of_phase(parameter.name)))
          out.push_back(summary(parameter, phases(of_phase(parameter.name), phase->value), phase->value));
        return;
      case ParameterGrid::Kind::fixed: return;
      case ParameterGrid::Kind::tried: break;
    }
    if (!matters(likeliest.variant, *explanation_.effect, p, grids_[p].tried, touches_, rows_)) return;
    const double value = likeliest.variant.theta[p];
    const bool standard = value == parameter.standard;
    if (grids_[p].between && !(standard && grids_[p].tried.size() < 2)) {
      const std::vector<MixtureTerm> mixture = searched(p);
      // A size goes with a period or a time constant: told are those that fit together.
      const bool place = parameter.sought == Sought::moment || parameter.sought == Sought::reading;
      out.push_back(summary(parameter, mixture, place ? mean_beside(mixture, likeliest.variant.cells[p]) : value));
      if (parameter.sought == Sought::moment) out.back().called = run_at(value);
    } else if (!parameter.choices.empty()) {
      out.push_back({.name = std::string(parameter.name), .word = in_words(parameter, value)});
      add_others(p, value, out.back());
    } else if (!standard ||
               (grids_[p].tried.size() > 1 && value != 0)) {  // 0 names no stylus, no tip, no place in particular
      out.push_back(told(parameter, {value, 0}));
      out.back().called = called(parameter, static_cast<int>(value), touches_);
      add_others(p, value, out.back());
    }
  }

  /// Which other values of its list fit nearly as well, or do the same to these touches.
  void add_others(std::size_t p, double told_value, DiagnosedParameter& out) const {
    constexpr double kOutOfQuestion = 0.05;
    std::map<double, double> beliefs = listed_[p];
    const std::vector<double> same = doing_the_same(p);
    const double each = beliefs[told_value] / double(1 + same.size());
    beliefs[told_value] = each;
    for (const double value : same) beliefs[value] += each;
    for (const auto& [value, belief] : beliefs)
      if (value == told_value)
        out.probability = belief;
      else if (belief >= kOutOfQuestion)
        out.others.push_back({in_words(explanation_.effect->parameters[p], value), belief});
    std::stable_sort(out.others.begin(), out.others.end(),
                     [](const OtherValue& a, const OtherValue& b) { return a.probability > b.probability; });
  }

  /// The other values of a list, but for all of them together, with which the likeliest variant would be the same: of such
  /// variants the search keeps the first.
  std::vector<double> doing_the_same(std::size_t p) const {
    const Variant& likeliest = variants_[likeliest_].variant;
    std::vector<double> out;
    Variant at = likeliest;
    for (const auto& [value, cell, share] : grids_[p].tried) {
      at.theta[p] = value;
      if (value != likeliest.theta[p] && word_of(explanation_.effect->parameters[p], value, touches_) != "all" &&
          same_columns(variant_like(at, *explanation_.effect, touches_, rows_).signature, likeliest.signature))
        out.push_back(value);
    }
    return out;
  }

  /// The belief in each value of each parameter among the variants that change between runs as the told one does.
  static std::vector<std::map<double, double>> beliefs_of(const Explanations& mine, const Evidence& evidence,
                                                          int told) {
    const Variant& like = mine.variants[told];
    std::vector<int> compared;
    std::vector<double> logs;
    for (const int b : mine.list.front().variants)
      if (mine.variants[b].change == like.change) compared.push_back(b), logs.push_back(log_belief(mine, evidence, b));
    const double total = log_sum_exp(logs);
    std::vector<std::map<double, double>> out(like.theta.size());
    for (std::size_t k = 0; k < compared.size(); ++k)
      for (std::size_t p = 0; p < out.size(); ++p)
        out[p][mine.variants[compared[k]].theta[p]] += std::exp(logs[k] - total);
    return out;
  }

  /// A value of a list: "y", "50 mm", the name of a stylus, "all" of them.
  std::string in_words(const EffectParameter& parameter, double value) const {
    if (std::string word = word_of(parameter, value, touches_); !word.empty()) return word;
    return parameter.is_code() ? fmt::format("{:g}", value) : fmt::format("{:g} {}", value, parameter.unit);
  }

  /// In which of several runs a moment of their common clock lies; "" of one run.
  std::string run_at(double time_s) const {
    int before = 0, after = 0;
    bool several = false;
    for (const RecordedTouch& touch : touches_.touches) {
      const TouchScene& s = touch.scene;
      several |= s.run != touches_.touches.front().scene.run;
      if (s.time_s < time_s) before = s.run;
      if (s.time_s >= time_s && after == 0) after = s.run;
    }
    if (!several || before == 0 || after == 0) return "";
    return before == after ? fmt::format("in run {}", before) : fmt::format("between runs {} and {}", before, after);
  }

  /// The linear parameter whose phase this is: that of the same harmonic.
  int of_phase(std::string_view phase) const {
    const std::string_view harmonic = phase.substr(0, phase.find("phase_deg"));
    const auto parameters = explanation_.effect->parameters;
    for (std::size_t p = 0; p < parameters.size(); ++p)
      if (parameters[p].linear && parameters[p].name.starts_with(harmonic)) return static_cast<int>(p);
    return -1;
  }

  /// The axis where it may be one, else azimuth and elevation, the two parameters after it.
  void add_direction(std::size_t p, std::vector<DiagnosedParameter>& out) const {
    constexpr double kNone = 1e-6;  // rad: the touches see one direction only
    const auto parameters = explanation_.effect->parameters;
    const Candidate& likeliest = variants_[likeliest_];
    if (const int axis = likeliest.variant.axis; axis >= 0) {
      out.push_back({.name = "direction", .word = std::string(parameters[p].choices[axis])});
      return;
    }
    auto d = likeliest.estimate->direction();
    if (!d) return;
    if (d->u < kNone) d->u = 0;
    constexpr double kClearly = 2;  // standard uncertainties
    const double components[] = {d->x, d->y, d->z};
    std::size_t axis = 3;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::acos(std::min(1.0, components[k])) <= kClearly * d->u) axis = k;
    out.push_back({.name = "direction", .word = std::string(parameters[p].choices[axis])});
    if (!d->whole) out.back().called = "as far as these touches see";
    if (axis < 3) return;
    const double flat = std::hypot(d->x, d->y);
    out.push_back(
        told(parameters[p + 1], {in_degrees(std::atan2(d->y, d->x)), in_degrees(d->u / std::max(flat, d->u))}));
    out.push_back(told(parameters[p + 2], {in_degrees(std::atan2(d->z, flat)), in_degrees(d->u)}));
    out.back().low = std::max(out.back().low, -90.0), out.back().high = std::min(out.back().high, 90.0);
  }

  std::vector<MixtureTerm> linear(int p) const {
    std::vector<MixtureTerm> mixture;
    for (const Candidate& v : variants_)
      if (const auto size = v.estimate->size(p))
        mixture.push_back({v.weight, size->value, size->u, false, size->length});
    return normalised(mixture);
  }

  /// The phases of a size, counted from `at`: none begins anew at a full turn.
  std::vector<MixtureTerm> phases(int size, double at) const {
    std::vector<MixtureTerm> mixture;
    std::vector<double> period, half_width;
    const std::size_t sought = of_period();
    for (const Candidate& v : variants_) {
      const auto phase = v.estimate->phase_deg(size);
      if (!phase) continue;
      mixture.push_back({v.weight, at + std::remainder(phase->value - at, 360), phase->u});
      period.push_back(sought < grids_.size() ? v.variant.theta[sought] : 0);
      half_width.push_back(sought < grids_.size() ? (v.variant.cells[sought].high - v.variant.cells[sought].low) / 2
                                                  : 0);
    }
    mixture = normalised(mixture);
    // A longer period begins later to be the same in the middle of the recording: so within a cell, too.
    double mean_period = 0, mean_phase = 0, square = 0, product = 0;
    for (std::size_t k = 0; k < mixture.size(); ++k)
      mean_period += mixture[k].weight * period[k], mean_phase += mixture[k].weight * mixture[k].value;
    for (std::size_t k = 0; k < mixture.size(); ++k) {
      const double beyond = period[k] - mean_period;
      square += mixture[k].weight * beyond * beyond;
      product += mixture[k].weight * beyond * (mixture[k].value - mean_phase);
    }
    if (square > 0)
      for (std::size_t k = 0; k < mixture.size(); ++k)
        mixture[k].u = std::hypot(mixture[k].u, product / square * half_width[k] / std::sqrt(3.0));
    return mixture;
  }

  /// The parameter that a phase goes with; beyond all of them: none.
  std::size_t of_period() const {
    std::size_t p = 0;
    const auto parameters = explanation_.effect->parameters;
    while (p < parameters.size() && parameters[p].sought != Sought::period &&
           parameters[p].sought != Sought::signal_period)
      ++p;
    return p;
  }

  std::vector<MixtureTerm> spread(const EffectParameter& parameter) const {
    std::vector<MixtureTerm> mixture;
    for (const Candidate& v : variants_) {
      for (MixtureTerm c : spread_estimate(v.info, parameter.typical)) {
        c.weight *= v.weight;
        mixture.push_back(c);
      }
    }
    return normalised(mixture);
  }

  std::vector<MixtureTerm> searched(std::size_t p) const {
    std::vector<MixtureTerm> mixture;
    for (const Candidate& v : variants_) {
      const Cell& cell = v.variant.cells[p];
      mixture.push_back({v.weight, (cell.low + cell.high) / 2, (cell.high - cell.low) / std::sqrt(12.0), true});
    }
    return normalised(mixture);
  }

  static std::vector<MixtureTerm> normalised(std::vector<MixtureTerm> mixture) {
    double total = 0;
    for (const MixtureTerm& c : mixture) total += c.weight;
    for (MixtureTerm& c : mixture) c.weight /= total;
    return mixture;
  }

  const RecordedTouches& touches_;
  const std::vector<int>& rows_;
  const Explanation& explanation_;
  std::vector<Candidate> variants_;
  std::size_t likeliest_ = 0;                     ///< of them
  std::vector<ParameterGrid> grids_;              ///< by parameter
  std::vector<std::map<double, double>> listed_;  ///< by parameter: how far each of its values is believed
};

}  // namespace

FoundSize estimate_size(const Case& c, const SearchResult& result, std::size_t finding, std::optional<int> member) {
  const Estimator estimator(c, result, finding, member.value_or(result.findings[finding].explanation));
  const Variant& found = c.explanations.variants[result.findings[finding].variant];
  return {estimator.all(), estimator.largest_um(), change_of(estimator.likeliest(), found)};
}

RunChange change_of(const Variant& variant, const Variant& found) {
  const bool holds = variant.change.is_like(found.change) && variant.runs.low <= found.runs.low &&
      found.runs.high <= variant.runs.high;
  return holds ? found.change : variant.change;
}

}  // namespace abbe::diagnose
