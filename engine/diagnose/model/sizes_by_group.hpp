// Whether something is of one size in all groups of touches.
//
// A shape that was fitted to all touches, f, gets a size of its own in each group g of them: f becomes sum_g t_g f 1_g. How
// much better that explains the recording than one size is chi-squared of as many degrees of freedom as sizes can
// differ, if the shape is right: the score test of homogeneity, beside all that the model and what was found are free
// to do. [Cox & Hinkley 1974, 9.3]
#pragma once

#include <vector>

#include "engine/diagnose/model/precision.hpp"

namespace abbe::diagnose {

/// Sizes in units of that of all touches, with their standard uncertainties, by group in the order of their numbers;
/// of a group that tells nothing u is infinite.
struct SizesByGroup {
  Vector size, u;
  double chi2 = 0;  ///< by how much sizes of their own explain the recording better
  int dof = 0;      ///< 0: no size can differ

  /// The probability that a shape of one size shows such differences.
  double p() const;
};

class OneShape {
 public:
  /// `found`: the signatures of all that was found, of which one makes the shape.
  OneShape(const LinearModel&, const Hyperparameters&, const std::vector<const Matrix*>& found, std::size_t which);

  SizesByGroup by(const std::vector<int>& group) const;
  /// What it explains, as chi-squared.
  double explains() const { return explains_; }

 private:
  Precision precision_;
  Precision::Seen y_, found_, others_;  ///< others: what was found but the shape
  Vector coefficients_, shape_;
  Matrix information_;  ///< of all that was found
  double explains_ = 0;
};

}  // namespace abbe::diagnose
