// In which factor a mismatch lies. Every explanation shows in one factor: an effect in that of which it is a
// function, or in the run where it is new in one; OTHER in its own. A factor is believed as much as all its
// explanations together, so a mismatch that has a name lies where that physics acts, and one that has none
// where the best pattern of no physics lies.
#include "engine/diagnose/findings/locate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "engine/diagnose/findings/coordinate.hpp"
#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/math/normal.hpp"

namespace abbe::diagnose {

namespace {

/// The pattern that a variant takes in this recording, um by row: the posterior mean at its best size.
struct Pattern {
  Vector values;
  double energy = 0;  ///< twice the log-likelihood that it gains
};

Pattern pattern_of(const EvidenceSearch& search, const Variant& variant, int index) {
  const Information info = search.information(index);
  const LikeliestSize size = likeliest_size(info, search.sizes(index));
  return {variant.signature * size.coefficients, info.u.dot(size.coefficients)};
}

template <class Value>
bool differs(const Case& c, Value value) {
  const auto at = [&](int row) { return value(c.touches.touches[row].scene); };
  return std::any_of(c.rows.begin(), c.rows.end(), [&](int row) { return at(row) != at(c.rows.front()); });
}

/// Whether the recording can show anything in a factor: its touches differ there.
bool varies(const Case& c, Factor factor) {
  switch (factor) {
    case Factor::temperature:
      return std::any_of(std::begin(kThermometers), std::end(kThermometers),
                         [&](const Coordinate& t) { return differs(c, t.of); });
    case Factor::speed: return differs(c, [](const TouchScene& s) { return s.speed_mm_s; });
    case Factor::head:
      return differs(c, [](const TouchScene& s) { return std::pair(s.stylus.head_a_rad, s.stylus.head_b_rad); });
    case Factor::sensor: return differs(c, [](const TouchScene& s) { return s.stylus.ordinal; });
    case Factor::setup: return differs(c, [](const TouchScene& s) { return s.setup; });
    case Factor::run: return differs(c, [](const TouchScene& s) { return s.run; });
    case Factor::feature: return differs(c, [](const TouchScene& s) { return s.feature; });
    case Factor::time:
    case Factor::position:
    case Factor::direction: break;
  }
  return true;
}

/// Where a pattern is strongest, in words of its factor: names of columns and what they are there.
class Strongest {
 public:
  using Places = std::vector<std::pair<std::string, std::string>>;

  Strongest(const Case& c, const Vector& pattern) : case_(c), pattern_(pattern) {}

  Places in(Factor factor) const {
    switch (factor) {
      case Factor::time: return range(case_.recording->rows.front().time_s ? kClock : kTouchNumber);
      case Factor::position: return ranges(kPosition);
      case Factor::direction: return normal();
      case Factor::head:
        return label("head", [](const TouchScene& s) {
          return fmt::format("A {:.1f} B {:.1f}", in_degrees(s.stylus.head_a_rad), in_degrees(s.stylus.head_b_rad));
        });
      case Factor::sensor: return label("sensor", [](const TouchScene& s) { return std::string(s.stylus.name); });
      case Factor::setup: return label("setup", [](const TouchScene& s) { return std::to_string(s.setup); });
      case Factor::run: return label("run", [](const TouchScene& s) { return std::to_string(s.run); });
      case Factor::feature:
        return label("feature", [&](const TouchScene& s) { return case_.touches.features[s.feature]; });
      case Factor::temperature: return ranges(kThermometers);
      case Factor::speed:
        return label("speed", [](const TouchScene& s) { return fmt::format("{:g} mm/s", s.speed_mm_s); });
    }
    return {};
  }

 private:
  // What has at least half of the most that any has is strong; where that is nearly everywhere, there is no place.
  static constexpr double kStrong = 0.5, kNearlyEverywhere = 2.0 / 3;

  /// Between which values lie the strong touches.
  Places range(const Coordinate& along) const {
    const double strong = kStrong * pattern_.cwiseAbs().maxCoeff();
    double low = 1e300, high = -1e300, first = 1e300, last = -1e300;
    for (Eigen::Index i = 0; i < pattern_.size(); ++i) {
      const double at = along.of(case_.scene(i));
      first = std::min(first, at), last = std::max(last, at);
      if (std::abs(pattern_(i)) >= strong) low = std::min(low, at), high = std::max(high, at);
    }
    if (high - low >= kNearlyEverywhere * (last - first)) return {};
    return {{along.name, in_words(along, low, high)}};
  }

  Places ranges(std::span<const Coordinate> each) const {
    Places out;
    for (const Coordinate& along : each)
      for (auto& place : range(along)) out.push_back(std::move(place));
    return out;
  }

  /// That of the strongest touch.
  Places normal() const {
    const Vector size = pattern_.cwiseAbs();
    Eigen::Index strongest = 0;
    const double most = size.maxCoeff(&strongest);
    if (double((size.array() >= kStrong * most).count()) >= kNearlyEverywhere * double(size.size())) return {};
    const Vec3 n = case_.scene(strongest).normal;
    return {{"normal", fmt::format("{:.2f}, {:.2f}, {:.2f}", n.x, n.y, n.z)}};
  }

  /// The labels whose touches are strong together, by their root mean square.
  template <class Value>
  Places label(const char* name, Value value) const {
    std::map<std::string, std::pair<double, double>> squares;  // sum, number
    for (Eigen::Index i = 0; i < pattern_.size(); ++i) {
      auto& [sum, number] = squares[value(case_.scene(i))];
      sum += pattern_(i) * pattern_(i), number += 1;
    }
    const auto rms = [](const auto& of) { return std::sqrt(of.second.first / of.second.second); };
    double most = 0;
    for (const auto& of : squares) most = std::max(most, rms(of));
    std::vector<std::string> strong;
    for (const auto& of : squares)
      if (rms(of) >= kStrong * most) strong.push_back(of.first);
    if (double(strong.size()) >= kNearlyEverywhere * double(squares.size())) return {};
    return {{name, enumerated(std::move(strong))}};
  }

  static std::string enumerated(std::vector<std::string> labels) {
    constexpr std::size_t kShown = 4;
    const std::size_t all = labels.size();
    labels.resize(std::min(all, kShown));
    return fmt::format("{}{}", fmt::join(labels, ", "), all > kShown ? fmt::format(" and {} more", all - kShown) : "");
  }

  const Case& case_;
  const Vector& pattern_;
};

/// The explanations of one factor.
struct Located {
  int best = -1;  ///< the likeliest
  double belief_in_best = 0;
  std::vector<double> log_belief;  ///< of each

  void add(int explanation, double belief) {
    if (best < 0 || belief > belief_in_best) best = explanation, belief_in_best = belief;
    log_belief.push_back(belief);
  }
};

std::map<Factor, Located> by_factor(const Case& c, const Evidence& evidence) {
  const Explanations& all = c.explanations;
  std::map<Factor, Located> out;
  for (std::size_t k = 0; k < all.list.size(); ++k) {
    const Explanation& e = all.list[k];
    const Variant& best = all.variants[best_variant(all, static_cast<int>(k), evidence)];
    out[shown_in(c, e, best)].add(static_cast<int>(k), std::log(e.prior) + evidence.log_bayes[k]);
  }
  return out;
}

}  // namespace

Factor shown_in(const Case& c, const Explanation& e, const Variant& variant) {
  if (variant.change.any()) return Factor::run;
  if (e.effect && in_one_placement(*e.effect, variant)) return Factor::setup;
  if (varies(c, e.factor)) return e.factor;
  constexpr unsigned kOfPlace = Covariate::position | Covariate::part_frame | Covariate::raw_reading;
  return e.effect && (e.effect->needs & kOfPlace) ? Factor::position : Factor::direction;
}

std::vector<Location> locate(const Case& c, const EvidenceSearch& search, const SearchResult& result) {
  if (result.findings.empty() && !result.other) return {};
  const Explanations& all = c.explanations;
  std::vector<double> simulated;
  for (const Evidence& null : result.null)
    simulated.push_back(*std::max_element(null.log_bayes.begin(), null.log_bayes.end()));
  struct Entry {
    Location location;
    double belief, energy;
  };
  std::vector<Entry> entries;
  for (const auto& [factor, located] : by_factor(c, result.first)) {
    const int variant = best_variant(all, located.best, result.first);
    const Pattern pattern = pattern_of(search, all.variants[variant], variant);
    const auto best = static_cast<std::size_t>(located.best);
    const Evidence& judged = best < result.on_grid.log_bayes.size() ? result.on_grid : result.first;
    entries.push_back({{std::string(name(factor)), Strongest(c, pattern.values).in(factor), 0,
                        tail_probability(judged.log_bayes[best], simulated)},
                       log_sum_exp(located.log_belief),
                       pattern.energy});
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.belief > b.belief; });
  const double most = std::max_element(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
                        return a.energy < b.energy;
                      })->energy;
  std::vector<Location> out;
  for (Entry& e : entries) {
    e.location.share = most > 0 ? e.energy / most : 0;
    if (out.empty() || e.location.p <= 0.05) out.push_back(std::move(e.location));
  }
  return out;
}

namespace {

/// The first of them, by name.
std::string listed(const Explanations& all, const std::vector<int>& set) {
  constexpr std::size_t kShown = 3;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(kShown, set.size()); ++k) names.push_back(all.list[set[k]].name);
  return fmt::format("{}{}", fmt::join(names, " or "), set.size() > kShown ? ", or another," : "");
}

}  // namespace

Unexplained pattern_of_size(Factor factor, std::string shape, double rms_um, double energy) {
  Unexplained out;
  out.factor = std::string(name(factor));
  out.shape = std::move(shape);
  out.amplitude_um = rms_um;
  out.amplitude_u_um = rms_um / std::sqrt(std::max(1.0, energy));
  out.low_um = std::max(0.0, rms_um - kNormal95 * out.amplitude_u_um);
  out.high_um = rms_um + kNormal95 * out.amplitude_u_um;
  return out;
}

Unexplained describe_unexplained(const Case& c, const SearchResult& result, const std::string& predicts_as_well) {
  const Finding& f = *result.other;
  const LinearModel rest = with_free(c.model, signatures_of(c, result.findings));
  const EvidenceSearch search(rest, result.hyper, c.explanations);
  const Explanation& e = c.explanations.list[f.explanation];
  const Variant& variant = c.explanations.variants[f.variant];
  const Pattern pattern = pattern_of(search, variant, f.variant);
  const double rms = std::sqrt(beside_free(rest, pattern.values).squaredNorm() / double(pattern.values.size()));
  Unexplained u = pattern_of_size(e.factor, e.shape, rms, pattern.energy);
  u.largest_um = pattern.values.cwiseAbs().maxCoeff();
  u.sentence = fmt::format("A pattern over {} ({}{}) of {} um rms, at most {} um at a touch, is in the recording",
                           u.factor, u.shape, variant.told.empty() ? "" : ", with " + variant.told,
                           two_digits(u.amplitude_um), two_digits(*u.largest_um));
  const CredibleSet name = credible_set(c.explanations, f.evidence, true);
  const bool several_sizes = result.nearest && result.nearest->sizes;
  const bool as_good = !several_sizes && kAsWell * name.probability >= f.probability;
  const std::string leaves = several_sizes ? fmt::format("its size {}", in_words(*result.nearest->sizes))
      : result.nearest_impossible          ? "only with a size that no such effect has"
                                  : fmt::format("leaves more than chance does (p = {:.1f} %)", 100 * result.adequacy);
  const bool alone = result.nearest && name.set.size() == 1 && name.explanation == result.nearest->explanation;
  u.sentence += as_good ? fmt::format(". {} would explain it as well{}.", listed(c.explanations, name.set),
                                      alone ? ", but " + leaves : "")
      : !predicts_as_well.empty() && !several_sizes
      ? fmt::format(". {} predicts what the model had not seen as well, but explains the whole less well.",
                    predicts_as_well)
      : " that no single effect of the catalogue makes.";
  if (result.nearest && !(as_good && alone))
    u.sentence +=
        fmt::format(" {} comes nearest, but {}.", c.explanations.list[result.nearest->explanation].name, leaves);
  return u;
}

}  // namespace abbe::diagnose
