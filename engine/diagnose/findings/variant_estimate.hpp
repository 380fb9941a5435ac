// What a recording says of the parameters that make the columns of one variant: sizes, and the directions and
// phases that columns span.
#pragma once

#include <optional>
#include <set>

#include "engine/diagnose/model/evidence.hpp"

namespace abbe::diagnose {

/// An estimate with its standard uncertainty, in the unit of its parameter.
struct Estimate {
  double value = 0, u = 0;
  bool length = false;  ///< of a vector: never less than nothing
};

/// A direction in the frame in which the effect names it, as a unit vector, and the standard uncertainty
/// across it, rad.
struct SpannedDirection {
  double x = 0, y = 0, z = 0;
  double u = 0;
  bool whole = true;  ///< whether every component is told; else it is that of the motion which the touches see
};

/// Linear-Gaussian posterior of the coefficients of a variant, with priors so wide that they do not pull.
/// Where several parameters do the same to these touches the first of those that can have such a size tells it, and the
/// others nothing: their sum is known, not their shares. Where they do nearly the same, so that each by itself may be
/// nothing and all together cannot, the one that explains most tells it: beside each other their uncertainties would say
/// nothing, and a machine file has no place for what they have in common.
///
/// Columns along three directions and two phases span more than an effect does, which moves along one
/// direction with one phase. Size, direction and phase are those of the nearest such motion: the leading term
/// of the singular value decomposition of the coefficients (Eckart & Young 1936). The direction's largest
/// component is positive where there is a phase to take its sign; the size is positive.
class VariantEstimate {
 public:
  VariantEstimate(const Effect&, const Variant&, const Information&);

  /// Of a parameter in which displacements are linear; nothing where no column tells it.
  std::optional<Estimate> size(int parameter) const;
  /// Along which the first such parameter acts; nothing where no directions are spanned.
  std::optional<SpannedDirection> direction() const;
  /// Of that parameter, deg; nothing where no phases are spanned.
  std::optional<Estimate> phase_deg(int parameter) const;
  /// What the coefficients do along the normal of every touch, um.
  Vector shift_um() const;

 private:
  /// sigma u w' of the coefficients of one parameter, by direction and phase.
  struct Motion {
    double size = 0;
    Vector along;       ///< u, by direction
    Vector phase;       ///< w, by phase
    Matrix covariance;  ///< of the coefficients, direction + directions * phase
    bool whole = true;  ///< whether the touches see it from every direction
  };
  std::optional<Motion> motion(int parameter) const;
  /// `later`: parameters that tell only what no other one does; `only`: the one that tells anything.
  void solve(const Information&, const std::set<int>& later, std::optional<int> only = {});
  /// The parameter that tells for all, where all together are certain and none by itself is.
  std::optional<int> one_for_all(const Information&) const;

  const Effect& effect_;
  const Variant& variant_;
  int directions_ = 1, phases_ = 1;
  Vector mean_;  ///< by column; 0 for one that is told by others
  Matrix covariance_;
};

}  // namespace abbe::diagnose
