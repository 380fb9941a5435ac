// The marginal likelihoods of recordings, without and with a variant, averaged over scales and sizes (ensemble.hpp). Most of
// a diagnosis is spent here: the loops go over recordings, and are compiled for every level of the processor.
#pragma once

#include <vector>

#include "engine/diagnose/model/explanation.hpp"

namespace abbe::diagnose {

/// What a variant asks of a family of baselines at each scale g, where G = H' P_g H = Q T Q', T of three diagonals: enough
/// for 1 + s^2 G = Q L D L' Q' at every size s, L with one diagonal beside its ones. All scales lie in one piece of memory,
/// since a search reads it for every variant.
struct PreparedVariant {
  Eigen::Index first = 0, count = 0;  ///< columns
  std::vector<Size> sizes;            ///< of an error function at the scale 1: they are in proportion to it
  Matrix axes;                        ///< Q', of the scales side by side
  Matrix carried;                     ///< by size and axis, likewise: what L has beside its ones, 0 for the first axis
  Matrix share;                       ///< s^2 / D: of a square of L^-1 Q' u, what the variant takes
  Matrix log_weight;                  ///< by size and scale: prior and determinant

  PreparedVariant(Eigen::Index first_column, Eigen::Index columns, std::vector<Size>, Eigen::Index scales);
  /// G at a scale; what the sizes are multiplied by there.
  void set(Eigen::Index scale, const Matrix& g, double times);
};

/// u = H' P_g y of the columns of a variant: where each has its first recording at the first scale. The recordings of a scale
/// follow each other, then those of the next.
using WithData = std::vector<const double*>;

/// Of one recording, by scale.
struct ByScale {
  Vector log_likelihood;  ///< averaged over sizes
  Vector squares;         ///< what is left of the sum of squares, at the best size
  Vector size;            ///< that size; none without a variant
};

class MarginalLikelihood {
 public:
  /// `squares`: what is left of the sums of squares without any variant, 2 b of the prior included; a row a recording, a
  /// column a scale. `log_scale`: prior and determinant of a scale. `shape`: a + n / 2.
  MarginalLikelihood(Matrix squares, Vector log_scale, double shape);

  /// Logarithms by recording, without any variant and with one.
  Vector alone();
  void with(const PreparedVariant&, const WithData&, double* out);

  /// Of the first recording.
  ByScale alone_by_scale();
  ByScale with_by_scale(const PreparedVariant&, const WithData&);

 private:
  int recordings() const { return static_cast<int>(squares_.rows()); }
  int scales() const { return static_cast<int>(squares_.cols()); }
  /// What the loops read at the first scale, and their room.
  struct AtScale;
  AtScale at_first_scale(const PreparedVariant&, const WithData&);

  Matrix squares_;
  Vector log_scale_;
  double shape_;
  std::vector<double> along_, before_, left_, logs_, top_, by_scale_;
};

}  // namespace abbe::diagnose
