#include "engine/diagnose/model/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/ids.hpp"
#include "engine/base/on_threads.hpp"
#include "engine/diagnose/model/log_sums.hpp"
#include "engine/diagnose/model/restricted_likelihood.hpp"

namespace abbe::diagnose {

namespace {

/// Belief before the data that the machine's errors are rougher than the harmonics of the specification.
constexpr double kPriorRough = 0.2;
/// Belief before the data that an error function, or those of an axis, are more uneven than the others.
constexpr double kPriorUneven = 0.2;
/// Belief before the data that neighbours scatter alike, where they do: what goes on slowly in the sequence
/// looks the same.
constexpr double kPriorCorrelated = 0.5;
/// Nats below the better ensemble from which on the other makes no difference.
constexpr double kEnsembleOutOfQuestion = 8;

/// Recordings as they are, without another added.
std::vector<Ensemble::Sum> sums_of(const std::vector<Ensemble::Seen>& seen) {
  std::vector<Ensemble::Sum> out;
  for (const Ensemble::Seen& s : seen) out.push_back({s});
  return out;
}

/// Whether more simulated recordings could carry a p-value over the level. Downwards that is further: the few
/// largest of some hundred tell little of how the tail goes on.
bool is_near(double p, double level) {
  constexpr double kAbove = 3, kBelow = 30;
  return p < kAbove * level && p > level / kBelow;
}

}  // namespace

double log_belief(const Explanations& all, const Evidence& evidence, int variant) {
  return evidence.variant_log_bayes[variant] + std::log(all.variants[variant].weight);
}

std::vector<double> log_weights(const std::vector<Variant>& variants) {
  std::vector<double> out;
  for (const Variant& b : variants) out.push_back(std::log(b.weight));
  return out;
}

void average_variants(const std::vector<Explanation>& explanations, const std::vector<double>& log_weight,
                      Evidence& out) {
  std::vector<double> all;
  for (const Explanation& x : explanations) {
    std::vector<double> variants;
    for (const int b : x.variants) variants.push_back(out.variant_log_bayes[b] + log_weight[b]);
    out.log_bayes.push_back(log_sum_exp(variants));
    all.push_back(std::log(x.prior) + out.log_bayes.back());
  }
  out.statistic = all.empty() ? 0 : log_sum_exp(all);
  ABBE_CHECK(std::isfinite(out.statistic));  // or a mistake would pass for a machine in order
}

EvidenceSearch::EvidenceSearch(const LinearModel& model, const Hyperparameters& h, const Explanations& explanations)
    : EvidenceSearch(model, h, h.correlation > 0 ? std::optional(estimate_uncorrelated(model)) : std::nullopt,
                     explanations) {}

EvidenceSearch::EvidenceSearch(const LinearModel& model, const Hyperparameters& h,
                               std::optional<Hyperparameters> uncorrelated, const Explanations& explanations)
    : model_(model), hyper_(h), uncorrelated_(std::move(uncorrelated)), functions_(model.uneven.size()) {
  const double correlated = uncorrelated_ ? kPriorCorrelated : 1;
  rough_ = add_machines(model, h, std::log(correlated));
  if (uncorrelated_) add_machines(model, *uncorrelated_, std::log(1 - correlated));
  for (Ensemble& e : ensembles_) e.prepare(model.uneven);
  extend(explanations, 0);
}

EvidenceSearch EvidenceSearch::without(const std::vector<char>& dropped, const Explanations& of_the_rest) const {
  return {without_rows(model_, dropped), hyper_, uncorrelated_, of_the_rest};
}

double EvidenceSearch::add_machines(const LinearModel& model, const Hyperparameters& h, double log_prior) {
  ensembles_.emplace_back(model, h, log_prior + std::log(1 - kPriorRough));
  if (model.rough.cols() == 0 || model_.y.squaredNorm() == 0) return 0;
  Ensemble rough(rougher(model), h, log_prior + std::log(kPriorRough), ensembles_.back());
  const auto alone = [&](const Ensemble& e) { return e.judge({e.seen(model_.y)}, {}).alone(0); };
  const double harmonic = alone(ensembles_.back()), other = alone(rough);
  if (other > harmonic - kEnsembleOutOfQuestion) ensembles_.push_back(std::move(rough));
  return 1 / (1 + std::exp(harmonic - other));
}

void EvidenceSearch::extend(const Explanations& explanations, std::size_t same) {
  for (Ensemble& e : ensembles_) e.keep(same);
  for (Ensemble& e : ensembles_) e.add(std::span(explanations.variants).subspan(same));
  explanations_ = explanations.list;
  log_weight_ = log_weights(explanations.variants);
  // A plan has no values yet: what it can tell is judged at the level that was stated.
  if (model_.y.squaredNorm() > 0) judge_recording();
}

std::vector<Ensemble::Seen> EvidenceSearch::seen(const Matrix& recordings) const {
  std::vector<Ensemble::Seen> out;
  for (const Ensemble& e : ensembles_) out.push_back(e.seen(recordings));
  return out;
}

EvidenceSearch::Weighed EvidenceSearch::weigh(const std::vector<Ensemble::Sum>& y,
                                              const std::vector<int>& variants) const {
  const auto families = static_cast<Eigen::Index>(ensembles_.size()), functions = static_cast<Eigen::Index>(functions_),
             recordings = static_cast<Eigen::Index>(y.front().of.recordings()),
             asked = functions + static_cast<Eigen::Index>(variants.size());
  // By family: without any variant, then with each.
  Matrix logs(recordings * (1 + asked), families), sums(recordings, 1 + asked);
  for (Eigen::Index e = 0; e < families; ++e) {
    const auto at = static_cast<std::size_t>(e);
    const Ensemble::LogLikelihoods v = ensembles_[at].judge(y[at], variants);
    logs.col(e) << v.alone, v.with.reshaped();
  }
  log_sums_exp(static_cast<int>(families), static_cast<int>(logs.rows()), logs.data(), sums.data());
  Matrix no_mismatch = sums.leftCols(1 + functions);
  no_mismatch.col(0).array() += std::log(functions > 0 ? 1 - kPriorUneven : 1);
  no_mismatch.rightCols(functions).array() += std::log(kPriorUneven / double(std::max<Eigen::Index>(functions, 1)));
  Weighed out{Vector(recordings), {}};
  log_sums_exp(static_cast<int>(1 + functions), static_cast<int>(recordings), no_mismatch.data(), out.log_null.data());
  out.log_bayes = sums.rightCols(asked - functions).colwise() - out.log_null;
  return out;
}

std::optional<Matrix> EvidenceSearch::uneven() const {
  constexpr double kLikely = 0.5;
  const std::vector<Ensemble::Seen> recording = seen(model_.y);
  const double log_null = weigh(sums_of(recording), {}).log_null(0);
  double belief = 0;
  const double prior = std::log(kPriorUneven / double(std::max<std::size_t>(functions_, 1)));
  std::size_t function = 0;
  double most = -std::numeric_limits<double>::infinity(), size = 1;
  for (std::size_t e = 0; e < ensembles_.size(); ++e)
    for (std::size_t k = 0; k < functions_; ++k) {
      const ByScale with = ensembles_[e].with_function(recording[e], k);
      const double log = log_sum_exp(with.log_likelihood);
      belief += std::exp(prior + log - log_null);
      if (log <= most) continue;
      Eigen::Index scale = 0;
      with.log_likelihood.maxCoeff(&scale);
      most = log, function = k, size = with.size(scale);
    }
  return belief > kLikely ? std::optional<Matrix>(size * model_.uneven[function]) : std::nullopt;
}

Vector EvidenceSearch::log_beliefs(const std::vector<Ensemble::Seen>& of, const std::vector<Ensemble::Seen>& added,
                                   const Vector& times, int explanation) const {
  const Explanation& x = explanations_[explanation];
  std::vector<Ensemble::Sum> y;
  for (std::size_t e = 0; e < of.size(); ++e) y.push_back({of[e], &added[e], times});
  const Matrix log_bayes = weigh(y, x.variants).log_bayes;
  Vector out(log_bayes.rows());
  for (Eigen::Index r = 0; r < out.size(); ++r) {
    std::vector<double> variants;
    for (std::size_t k = 0; k < x.variants.size(); ++k)
      variants.push_back(log_bayes(r, static_cast<Eigen::Index>(k)) + log_weight_[x.variants[k]]);
    out(r) = std::log(x.prior) + log_sum_exp(variants);
  }
  return out;
}

Vector EvidenceSearch::log_scales(const std::vector<Ensemble::Seen>& of, const std::vector<Ensemble::Seen>& added,
                                  const Vector& times) const {
  const std::size_t e = alone_.ensemble;
  return ensembles_[e].log_scales({of[e], &added[e], times});
}

std::vector<Evidence> EvidenceSearch::judge(const std::vector<Ensemble::Seen>& y) const {
  std::vector<int> variants(log_weight_.size());
  std::iota(variants.begin(), variants.end(), 0);
  const Weighed weighed = weigh(sums_of(y), variants);
  std::vector<Evidence> list(static_cast<std::size_t>(weighed.log_null.size()));
  for (std::size_t r = 0; r < list.size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    Evidence& out = list[r];
    out.log_null = weighed.log_null(row);
    const Vector by_variant = weighed.log_bayes.row(row);
    out.variant_log_bayes.assign(by_variant.begin(), by_variant.end());
    average_variants(explanations_, log_weight_, out);
  }
  return list;
}

EvidenceSearch::Baseline EvidenceSearch::likeliest(const std::vector<ByScale>& by_ensemble) const {
  std::vector<double> logs;
  for (const ByScale& s : by_ensemble) logs.push_back(log_sum_exp(s.log_likelihood));
  const auto e = static_cast<std::size_t>(std::max_element(logs.begin(), logs.end()) - logs.begin());
  return {e, ensembles_[e].level(by_ensemble[e])};
}

void EvidenceSearch::judge_recording() {
  const std::vector<Ensemble::Seen> y = seen(model_.y);
  evidence_ = judge(y).front();
  std::vector<ByScale> alone, with;
  for (std::size_t e = 0; e < y.size(); ++e) alone.push_back(ensembles_[e].alone(y[e]));
  alone_ = with_ = likeliest(alone);
  const std::vector<double>& by_variant = evidence_.variant_log_bayes;
  const auto best = std::max_element(by_variant.begin(), by_variant.end());
  if (best == by_variant.end() || *best <= 0) return;
  const auto variant = static_cast<int>(best - by_variant.begin());
  for (std::size_t e = 0; e < y.size(); ++e) with.push_back(ensembles_[e].with_variant(y[e], variant));
  with_ = likeliest(with);
}

std::vector<Evidence> EvidenceSearch::bootstrap(double observed, const NoiseLaw& law, const Replicates& replicates,
                                                std::uint64_t seed, int threads) const {
  constexpr int kEnough = 10, kEnoughNear = 20, kMoreNear = 6;
  constexpr int kAsked = 20;  // after so many, whether they are enough
  std::vector<Evidence> out;
  std::vector<double> statistics;
  int extreme = 0;
  const auto judged_from = [&](int first, int count) {
    Matrix recordings(rows(), count);
    for (int k = 0; k < static_cast<int>(recordings.cols()); ++k)
      recordings.col(k) = ensembles_[alone_.ensemble].simulated(alone_.level, law, seed, first + k);
    return judge(seen(recordings));
  };
  const auto simulate = [&](int most, int enough) {
    const std::size_t before = out.size();
    while (static_cast<int>(out.size()) < most && extreme < enough) {
      // As many at once as are likely to be needed, by how many are extreme so far.
      const int first = static_cast<int>(out.size()),
                needed = std::min(most - first, (enough - extreme) * (first + 1) / (extreme + 1)),
                each = needed < kAtOnce ? kAsked : kAtOnce, groups = std::clamp(needed / each, 1, std::max(threads, 1));
      std::vector<std::vector<Evidence>> judged(static_cast<std::size_t>(groups));
      on_threads(groups, threads, [&](int g) {
        const int from = first + g * each;
        judged[g] = judged_from(from, std::min(each, most - from));
      });
      for (std::vector<Evidence>& group : judged)
        for (Evidence& e : group) {
          if (extreme >= enough && (out.size() - before) % kAsked == 0) break;
          statistics.push_back(e.statistic);
          extreme += e.statistic >= observed ? 1 : 0;
          out.push_back(std::move(e));
        }
    }
  };
  simulate(replicates.usual, kEnough);
  if (is_near(tail_probability(observed, statistics), replicates.level))
    simulate(kMoreNear * replicates.usual, kEnoughNear);
  return out;
}

double tail_probability(double observed, std::vector<double> simulated) {
  const double n = static_cast<double>(simulated.size());
  std::sort(simulated.begin(), simulated.end());
  const auto above =
      static_cast<double>(simulated.end() - std::lower_bound(simulated.begin(), simulated.end(), observed));
  const std::size_t tail = std::min<std::size_t>(simulated.size() / 10, 30);
  if (above >= 8 || tail < 10) return (above + 1) / (n + 1);
  const double from = simulated[simulated.size() - tail - 1];
  double mean = 0;
  for (std::size_t k = simulated.size() - tail; k < simulated.size(); ++k) mean += (simulated[k] - from) / double(tail);
  // The mean of so few values is uncertain itself: averaged over that (flat in its logarithm), the
  // exponential law becomes that of Lomax.
  const auto values = double(tail);
  return std::max(1e-12, values / n * std::pow(1 + (observed - from) / (values * std::max(mean, 1e-9)), -values));
}

double most_believed(double p, double prior) {
  const double least = std::max(p, 1e-300);
  const double chance = least < std::exp(-1.0) ? -std::exp(1.0) * least * std::log(least) : 1;
  return prior / (prior + (1 - prior) * chance);
}

LikeliestSize likeliest_size(const Information& info, const std::vector<Size>& sizes) {
  LikeliestSize out;
  out.coefficients = Vector::Zero(info.u.size());
  for (const Size& size : sizes) {
    const double s2 = size.factor * size.factor;
    const Cholesky posterior(info.g, 1 / s2);
    Vector coefficients = posterior.solve(info.u);
    const double log_belief = size.log_prior + 0.5 * info.u.dot(coefficients) -
        0.5 * double(info.g.rows()) * std::log(s2) - posterior.half_log_determinant();
    if (log_belief > out.log_belief) out = {size.factor, std::move(coefficients), log_belief};
  }
  return out;
}

}  // namespace abbe::diagnose
