// The evidence of every explanation, and the p-value of the whole search.
//
// For a block with signature H (columns in units of the prior) and a size s, the Bayes factor against the baseline V is closed form:
//     log B = -1/2 log|1 + s^2 G| + 1/2 s^2 u' (1 + s^2 G)^-1 u,      G = H' P H,  u = H' P y,
// P the inverse of V with X projected out. An explanation averages over its blocks and over the sizes kSizes. The statistic of the search
// is the logarithm of the average over all explanations; its distribution without any mismatch is simulated at the fitted
// hyperparameters, with scale and noise fitted anew to every replicate (parametric bootstrap), so that one p-value holds for all that
// was looked for. [MacKay 2003, ch. 28; Davison & Hinkley 1997, ch. 4]
#pragma once

#include <cstdint>
#include <memory>

#include "engine/diagnose/explanation.hpp"

namespace abbe::diagnose {

struct Evidence {
  std::vector<double> log_bayes;        ///< by explanation
  std::vector<double> block_log_bayes;  ///< by block, sizes averaged
  double statistic = 0;                 ///< log of the average Bayes factor of all explanations
};

class EvidenceSearch {
 public:
  EvidenceSearch(const LinearModel&, const Hyperparameters&, const Explanations&);

  /// Of the recording.
  Evidence evidence() const;
  const Level& level() const { return level_; }

  /// Evidence of simulated recordings without mismatch, at most `replicates`: fewer once enough of them are as extreme as `observed` to
  /// know that it is nothing rare (Besag & Clifford, Biometrika 78, 1991). The same for any number of threads.
  std::vector<Evidence> bootstrap(double observed, int replicates, std::uint64_t seed, int threads) const;

  /// G and u of a block at the level of the recording.
  struct Information {
    Matrix g;
    Vector u;
  };
  Information information(int block) const;
  /// H_a' P H_b at the level of the recording.
  Matrix between(int a, int b) const;
  const Rotated& rotated() const { return rotated_; }

 private:
  struct Data;
  Data of_recording() const;
  Data simulated(std::uint64_t seed, int replicate) const;
  Evidence evaluate(const Data&) const;

  std::vector<Explanation> explanations_;
  Rotated rotated_;
  struct Projected {
    Matrix coordinates, remainder, square;   ///< a = U'h, b = h - U a, b'b
  };
  std::vector<Projected> blocks_;
  Level level_;
};

/// Share of simulated values at or above the observed one, with (k + 1) / (n + 1); far out in the tail by the exponential law that
/// the upper tenth of the simulated values follows.
double tail_probability(double observed, std::vector<double> simulated);

double log_sum_exp(const std::vector<double>&);

}  // namespace abbe::diagnose
