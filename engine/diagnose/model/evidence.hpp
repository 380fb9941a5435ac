// The evidence of every explanation, and the p-value of the whole search.
//
// The baseline is the ensemble of the specification or, less probably, one of the same size and rougher
// functions; at any scale (ensemble.hpp); and one of the error functions, or those of one axis, may be more uneven than the others,
// which is no physics left out either. The Bayes factor of an explanation is its likelihood averaged over
// ensembles, scales, sizes and its variants, over that of the baseline, averaged likewise. The statistic of the
// search is the logarithm of the average Bayes factor of all explanations; its distribution without any
// mismatch is simulated at the fitted baseline and evaluated with the same averages (parametric bootstrap),
// so that one p-value holds for all that was looked for. [MacKay 2003, ch. 28; Davison & Hinkley 1997, ch. 4]
#pragma once

#include <limits>
#include <optional>

#include "engine/diagnose/model/ensemble.hpp"
#include "engine/diagnose/model/prediction.hpp"

namespace abbe::diagnose {

struct Evidence {
  std::vector<double> log_bayes;          ///< by explanation
  std::vector<double> variant_log_bayes;  ///< by variant, sizes averaged
  double statistic = 0;                   ///< log of the average Bayes factor of all explanations
  double log_null = 0;  ///< log likelihood of the baseline, but for what recordings of as many rows share
};

/// What is believed of a variant among those of its explanation, as a logarithm, but for what all of them share.
double log_belief(const Explanations&, const Evidence&, int variant);
/// By variant: the logarithm of the belief in it before the data, among those of its explanation.
std::vector<double> log_weights(const std::vector<Variant>&);
/// Fills `log_bayes` and `statistic` from those of the variants.
void average_variants(const std::vector<Explanation>&, const std::vector<double>& log_weight, Evidence&);

/// What the data say of the sizes of a variant with signature H, where P is the precision of the baseline: G = H' P H and
/// u = H' P y.
struct Information {
  Matrix g;
  Vector u;
};

/// The size at which a variant explains the data best, given what is believed of sizes, and its coefficients there.
struct LikeliestSize {
  double factor = 1;
  Vector coefficients;
  double log_belief = -std::numeric_limits<double>::infinity();  ///< in the size, times the evidence at it
};
/// Among these; the first of those that are as likely.
LikeliestSize likeliest_size(const Information&, const std::vector<Size>&);

/// How many recordings without a mismatch are simulated.
struct Replicates {
  int usual = 0;
  double level = 0;  ///< the p-value up to which there is a mismatch; 0: nothing is decided by it
};

class EvidenceSearch {
 public:
  /// How many simulated recordings are best seen at once, as they fill the longest vectors: what is seen of one does not
  /// depend on the others.
  static constexpr int kAtOnce = 40;

  /// Without explanations it tells what the baseline alone makes of a recording.
  EvidenceSearch(const LinearModel&, const Hyperparameters&, const Explanations&);
  /// The search of the touches that are left without some, by the noise and errors of all: fewer touches may tell of others,
  /// and what is then said of those left out would be no prediction.
  EvidenceSearch without(const std::vector<char>& dropped, const Explanations& of_the_rest) const;

  /// Judges a list whose variants are new after the first `same`; a plan has nothing to judge.
  void extend(const Explanations&, std::size_t same);

  /// Touches of a recording.
  Eigen::Index rows() const { return model_.y.size(); }
  /// Of the recording.
  const Evidence& evidence() const { return evidence_; }
  /// The belief that the machine's errors are rougher than the specification's ensemble, without any explanation.
  double rough() const { return rough_; }
  bool more_likely_rough() const { return rough_ > 0.5; }
  /// The columns, um at the scale 1, of the error functions that are more uneven than the others, as the recording without
  /// any explanation has them; nothing where it is not more likely than not that there are any.
  std::optional<Matrix> uneven() const;

  /// Evidence of simulated recordings without mismatch: as many as usual; fewer once enough of them are as extreme
  /// as `observed` to know that it is nothing rare (Besag & Clifford, Biometrika 78, 1991); and up to six times as
  /// many where their p-value is so near the level that its own chance would decide. The same for any number of threads.
  std::vector<Evidence> bootstrap(double observed, const NoiseLaw&, const Replicates&, std::uint64_t seed,
                                  int threads) const;

  /// What the ensembles see of recordings, one a column; in the order of the ensembles.
  std::vector<Ensemble::Seen> seen(const Matrix& recordings) const;
  /// The evidence of other recordings than that of the search.
  std::vector<Evidence> judge(const std::vector<Ensemble::Seen>&) const;
  /// What one explanation has of each recording with some of another added to it, as many or one for all, as logarithms.
  Vector log_beliefs(const std::vector<Ensemble::Seen>& of, const std::vector<Ensemble::Seen>& added,
                     const Vector& times, int explanation) const;
  /// By recording, of such sums: the logarithm of the scale that the machine's errors seem to have, without any explanation.
  Vector log_scales(const std::vector<Ensemble::Seen>& of, const std::vector<Ensemble::Seen>& added,
                    const Vector& times) const;
  /// A recording of a machine in order, at the level of the recording beside its likeliest explanation; at that without
  /// any where all explanations together are no likelier than none: the best of hundreds would take chance away. Of a machine
  /// whose errors are so many times larger.
  Vector in_order(double larger, std::uint64_t seed, int replicate) const {
    const Baseline& likely = evidence_.statistic > 0 ? with_ : alone_;
    Level level = likely.level;
    level.g2 *= larger * larger;
    return ensembles_[likely.ensemble].simulated(level, {}, seed, replicate);
  }

  /// Standardised residuals beside a variant of any size: each row against its prediction from all others.
  Vector residuals_beside(const Variant& b) const { return leave_one_out(with_free(model_, {&b.signature}), hyper_); }

  /// G and u of a variant at the level of the recording, which is that with the likeliest explanation.
  Information information(int variant) const {
    return {between(variant, variant), likely().with_data(with_.level, variant, model_.y)};
  }
  /// H_a' P H_b at the level of the recording.
  Matrix between(int a, int b) const { return likely().between(with_.level, a, b); }
  /// H' P h of the columns of all variants, one after the other, with some of them.
  Matrix against_all(const std::vector<Eigen::Index>& columns) const {
    return likely().against_all(with_.level, columns);
  }
  Eigen::Index first_column(int variant) const { return likely().first_column(variant); }
  /// The sizes at which a variant was judged.
  const std::vector<Size>& sizes(int variant) const { return likely().sizes(variant); }

 private:
  /// `uncorrelated`: the noise if neighbours scatter independently, where they seem not to.
  EvidenceSearch(const LinearModel&, const Hyperparameters&, std::optional<Hyperparameters> uncorrelated,
                 const Explanations&);
  /// Ensembles of the specification and, if that is not out of the question, of rougher errors, with this
  /// noise; the belief in the latter.
  double add_machines(const LinearModel&, const Hyperparameters&, double log_prior);
  struct Baseline {
    std::size_t ensemble = 0;
    Level level;
  };
  struct Weighed {
    Vector log_null;   ///< by recording
    Matrix log_bayes;  ///< a row a recording; a column for each variant that was asked for
  };
  Weighed weigh(const std::vector<Ensemble::Sum>& y, const std::vector<int>& variants) const;
  /// The recording itself, and the baseline that it has without any explanation and with the likeliest.
  void judge_recording();
  /// The ensemble that makes a recording likeliest, and its level.
  Baseline likeliest(const std::vector<ByScale>& by_ensemble) const;
  const Ensemble& likely() const { return ensembles_[with_.ensemble]; }

  LinearModel model_;
  Hyperparameters hyper_;
  std::optional<Hyperparameters> uncorrelated_;
  std::vector<Explanation> explanations_;
  std::vector<Ensemble> ensembles_;
  std::vector<double> log_weight_;  ///< by variant
  std::size_t functions_ = 0;       ///< uneven error functions, before the variants
  Evidence evidence_;
  Baseline alone_, with_;
  double rough_ = 0;
};

/// Share of simulated values at or above the observed one, with (k + 1) / (n + 1); far out in the tail as the next
/// value would be of the exponential law that the upper tenth of the simulated values, at most thirty, follows.
double tail_probability(double observed, std::vector<double> simulated);

/// Belief in what chance alone shows with probability p, believed with `prior` before: the most that a
/// p-value can say for it, by the bound -e p ln p on the Bayes factor of chance. [Sellke, Bayarri & Berger,
/// The American Statistician 55 (2001), eq. 2]
double most_believed(double p, double prior);

}  // namespace abbe::diagnose
