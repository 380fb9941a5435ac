// The evidence of explanations of recorded values, in closed form, with nothing free and nothing estimated: V
// is the covariance of the ensemble. For a variant with signature H and a size s
//     log B = -1/2 log|1 + s^2 G| + 1/2 s^2 u' (1 + s^2 G)^-1 u,      G = H' V^-1 H,  u = H' V^-1 y,
// averaged over sizes and the variants of an explanation; the statistic is the logarithm of the average over
// explanations (MacKay 2003, ch. 28). Of a variant that is linear near one size only, values are normal about o + H s with
// a covariance W of their own: y - o and W stand for y and V, and log N(y; o, W) - log N(y; 0, V) is added.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// What a variant does near the sizes s that fit best: values are normal about offset + slopes s with `covariance`.
struct NearSizes {
  Matrix slopes;
  Vector offset;
  Matrix covariance;
};

class ValueSearch {
 public:
  /// Values are normal about `mean` with `covariance`, beyond what an explanation adds. Of the columns `free`
  /// nothing is known.
  ValueSearch(Vector mean, const Matrix& covariance, Explanations, const Matrix& free = {});

  /// Only where nothing is free.
  void linearise(int variant, NearSizes);

  Evidence evidence(const Vector& deviation) const;
  Information information(int variant, const Vector& deviation) const;
  /// H_a' V^-1 H_b, of variants that are linear everywhere.
  Matrix between(int a, int b) const;
  /// The deviation in units in which it is uncorrelated, each of variance 1, without what the free columns can do.
  Vector white(const Vector& deviation) const;
  /// What a variant predicts with these sizes.
  Vector predicted(int variant, const Vector& sizes) const;
  const Explanations& explanations() const { return explanations_; }
  /// Of one explanation alone, without the values of `dropped`; `kept`: the others.
  ValueSearch rest(int explanation, const std::vector<char>& dropped, std::vector<Eigen::Index>& kept) const;

 private:
  /// What the values tell of a variant whatever they are, so that it is taken once for all machines.
  struct Told {
    Matrix white;                          ///< L^-1 H, without what the free columns can do
    Matrix g;                              ///< H' V^-1 H
    std::vector<Cholesky> by;              ///< of 1 + s^2 g, by size s
    std::vector<double> half_log_of_size;  ///< 1/2 log |1 + s^2 g|
  };
  struct Near {
    NearSizes of;
    Cholesky root;  ///< of the covariance
  };
  Explanations explanations_;
  std::vector<double> log_weight_;  ///< by variant
  Vector mean_;
  Matrix covariance_;
  Cholesky root_;             ///< V = L L'
  Matrix free_;               ///< orthonormal basis of L^-1 times the free columns
  std::vector<Told> told_;    ///< by variant
  std::map<int, Near> near_;  ///< by variant
  static Told told_of(Matrix white);
  Matrix whitened(const Matrix& columns) const;
  /// The deviation from the offset of a variant in units of its covariance, and log N(y; o, W) - log N(y; 0, V).
  std::pair<Vector, double> from_offset(int variant, const Vector& deviation, const Vector& white) const;
};

/// What a search says of each of some machines (rows).
std::vector<double> statistics_of(const ValueSearch&, const Matrix& machines);

}  // namespace abbe::diagnose
