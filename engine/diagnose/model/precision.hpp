// The precision of a recording, the inverse of its covariance with X projected out, as an inner product of columns. With
// the projected Z and L L' = 1 + Z'Z it is a'P b = a'b - (L^-1 Z'a)'(L^-1 Z'b): no eigen-decomposition, so the cheaper
// way when scale and noise stay as they are.
#pragma once

#include "engine/diagnose/model/projection.hpp"

namespace abbe::diagnose {

class Precision {
 public:
  Precision(const LinearModel&, const Hyperparameters&);

  /// Columns as it sees them.
  struct Seen {
    Matrix rows, taken;  ///< projected; and what of them the ensemble can do

    Seen operator*(const Matrix& coefficients) const;
  };
  Seen seen(const Matrix& patterns) const;
  Seen y() const;

 private:
  Seen with_taken(Matrix rows) const;

  Projection project_;
  Matrix reach_;  ///< L^-1 Z'
  Vector y_;
};

/// a'P b.
Matrix inner(const Precision::Seen& a, const Precision::Seen& b);

}  // namespace abbe::diagnose
