// The evidence of explanations of recorded values, in closed form, with nothing free and nothing estimated: V
// is the covariance of the ensemble. For a block with signature H and a size s
//     log B = -1/2 log|1 + s^2 G| + 1/2 s^2 u' (1 + s^2 G)^-1 u,      G = H' V^-1 H,  u = H' V^-1 y,
// averaged over sizes and the blocks of an explanation; the statistic is the logarithm of the average over
// explanations (MacKay 2003, ch. 28).
#pragma once

#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

class ValueSearch {
 public:
  /// Values are normal about `mean` with `covariance`, beyond what an explanation adds. Of the columns `free`
  /// nothing is known.
  ValueSearch(Vector mean, const Matrix& covariance, Explanations, const Matrix& free = {});

  Evidence evidence(const Vector& deviation) const;
  Information information(int block, const Vector& deviation) const;
  /// H_a' V^-1 H_b.
  Matrix between(int a, int b) const {
    return white_[static_cast<std::size_t>(a)].transpose() * white_[static_cast<std::size_t>(b)];
  }
  /// The deviation in units in which it is uncorrelated, each of variance 1, without what the free columns can do.
  Vector white(const Vector& deviation) const;
  const Explanations& explanations() const { return explanations_; }

 private:
  Explanations explanations_;
  Vector mean_;
  Matrix root_;                ///< lower triangle L of V = L L'
  Matrix free_;                ///< orthonormal basis of L^-1 times the free columns
  std::vector<Matrix> white_;  ///< L^-1 H by block, without them
  Matrix whitened(const Matrix& columns) const;
};

/// Without the values of `dropped`.
ValueSearch search_without(const Vector& mean, const Matrix& covariance, const Explanations&,
                           const std::vector<char>& dropped, std::vector<Eigen::Index>& kept);

}  // namespace abbe::diagnose
