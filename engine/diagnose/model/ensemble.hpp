// One family of baselines: an ensemble of machines whose errors are scaled by g, and what every variant of
// columns gains on it.
//
// With V_g the covariance of the recording (ensemble_basis.hpp) and P_g its inverse with X projected out, a variant with signature H
// whose coefficients are drawn at size s has, with a common factor on all variances integrated out (inverse
// gamma prior), the marginal likelihood
//
//     L(g, s) ~ |V_g|^-1/2 |1 + s^2 G|^-1/2 (b + (y' P_g y - s^2 u' (1 + s^2 G)^-1 u) / 2)^-(a + n/2),      G = H' P_g H,  u = H' P_g y,
//
// and the family alone has L(g, 0). [O'Hagan & Forster 2004, ch. 11]
// Scales are averaged over, because the scale must be judged anew with every explanation: an ensemble of
// larger errors would swallow what the explanation is about. Sizes are spread over the signal-to-noise ratios
// at which a recording can tell anything; one above what is typical of the effect loses belief.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "engine/diagnose/model/ensemble_basis.hpp"
#include "engine/diagnose/model/explanation.hpp"
#include "engine/diagnose/model/marginal_likelihood.hpp"
#include "engine/diagnose/model/noise_law.hpp"

namespace abbe::diagnose {

/// Signal-to-noise ratios that an explanation of a certain size has on average.
inline constexpr double kRatios[] = {3, 6, 12, 24, 96};

/// The sizes at which a variant has these ratios. `information`: the trace of G at a size of 1.
std::vector<Size> sizes_of(double information);

/// Factors on the variances of machine and noise.
struct Level {
  double g2 = 1, s2 = 1;
};

class Ensemble {
 public:
  /// `log_prior`: of this family among others.
  Ensemble(const LinearModel&, const Hyperparameters&, double log_prior);
  /// One that differs from `other` only in the columns whose scale is judged: it judges the same columns of variants.
  Ensemble(const LinearModel&, const Hyperparameters&, double log_prior, const Ensemble& other);
  Ensemble(Ensemble&&) = default;
  Ensemble& operator=(Ensemble&&) = default;
  /// Makes it ready to judge error functions that are larger than the others. Before any variant.
  void prepare(const std::vector<Matrix>& uneven);
  /// Makes it ready to judge variants, after those before.
  void add(std::span<const Variant>);
  /// Forgets the variants after the first `count`.
  void keep(std::size_t count);

  /// What the family sees of recordings.
  struct Seen {
    Matrix z, rest;  ///< by eigenvector, and off the model; a column each
    Matrix u;  ///< H' P_g y: a column for each column of the variants, with the recordings of a scale, then of the next

    int recordings() const { return static_cast<int>(z.cols()); }
  };
  /// Of recordings, um, one a column.
  Seen seen(const Matrix& recordings) const;
  /// What is seen of recordings with others added to them, so many times each: as many, or one for all.
  struct Sum {
    const Seen& of;
    const Seen* added = nullptr;
    Vector times = {};
  };
  /// Averaged over scales and sizes; the constants that all families share are left out.
  struct LogLikelihoods {
    Vector alone;  ///< by recording: without any variant
    Matrix with;   ///< a row a recording; a column for each error function, then for each variant that was asked for
  };
  LogLikelihoods judge(const Sum&, const std::vector<int>& variants) const;
  /// By recording: the logarithm of the scale that its machine's errors seem to have, beside its noise, without any
  /// variant.
  Vector log_scales(const Sum&) const;
  /// Of the first recording, by scale: without any variant, with an error function, with a variant.
  ByScale alone(const Seen&) const;
  ByScale with_function(const Seen& y, std::size_t function) const { return with(y, variants_[function]); }
  ByScale with_variant(const Seen& y, int variant) const { return with(y, of(variant)); }
  /// The likely level, given what is believed of each scale and what it leaves of the sum of squares.
  Level level(const ByScale&) const;

  /// A recording of such a machine, um, without what nothing is known of.
  Vector simulated(const Level&, const NoiseLaw&, std::uint64_t seed, int replicate) const;

  /// H_a' P H_b, H_a' P y, and H' P h of the columns of all variants with some of them; at a level.
  Matrix between(const Level&, int a, int b) const;
  Vector with_data(const Level&, int variant, const Vector& y) const;
  Matrix against_all(const Level&, const std::vector<Eigen::Index>& columns) const;

  const std::vector<Size>& sizes(int variant) const { return of(variant).sizes; }
  /// Where the columns of a variant begin among those of all.
  Eigen::Index first_column(int variant) const { return of(variant).first; }

 private:
  /// `variants`: whose signatures they are; none: error functions of the machine.
  void prepare(const std::vector<const Matrix*>& signatures, std::span<const Variant> variants);
  void project(std::span<const Matrix* const> signatures);
  PreparedVariant prepared(Eigen::Index first, Eigen::Index count, const Variant*) const;
  const PreparedVariant& of(int variant) const { return variants_[functions_ + static_cast<std::size_t>(variant)]; }
  /// What recordings with others added to them are by eigenvector, and off the model.
  static std::pair<Matrix, Matrix> added_up(const Sum&);
  /// Of these recordings, without any variant.
  MarginalLikelihood likelihood(const Matrix& z, const Matrix& rest) const;
  ByScale with(const Seen&, const PreparedVariant&) const;
  Vector precision(double g) const;
  Vector precision(const Level&) const;
  /// What the model adds to the precision that noise alone would have: h' P h = a' (this) a + h' h / s^2, a = U' h.
  Vector beside_noise(const Level&) const;

  EnsembleBasis basis_;
  double shape_ = 0;            ///< a + n / 2
  std::vector<double> scales_;  ///< g
  Matrix precision_;            ///< 1 / (g^2 lambda + 1), one column for each scale
  Vector log_scale_;            ///< log prior of family and scale, and its determinant
  /// of all columns: U' h, and h; what is off the model, h - U U' h, is seen in products with h alone
  Matrix coordinates_;
  /// the largest that a search keeps, and free of what the ensemble is: ensembles of one noise share it
  std::shared_ptr<Matrix> projected_ = std::make_shared<Matrix>();
  std::size_t functions_ = 0;  ///< of the machine; variants follow them
  std::vector<PreparedVariant> variants_;
};

}  // namespace abbe::diagnose
