// Orthogonal least-squares fits of one set of points, with or without a starting element.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/features/element.hpp"

namespace abbe {

struct FitProblem {
  Shape shape{};
  std::vector<Vec3> points;    ///< mm
  std::optional<Vec3> normal;  ///< circle: prescribed normal of its plane, any length but not zero
};

struct FitError {
  /// "too_few_points", "identical_points", "collinear_points", "coplanar_points", "not_finite", "bad_normal",
  /// "not_unique", "no_apex", "not_converged"
  std::string code;
  std::string message;  ///< what is wrong, in plain words
};

struct FitSolution {
  Element element;  ///< `point` as the contract of `abbe fit` asks: docs/recording.md
  Vec3 apex;        ///< cone only
  double rms = 0, form = 0;
  std::optional<FitError> error;
};

/// The least-squares element from the points alone: global start, then full convergence in centred, scaled coordinates.
FitSolution fit_points(const FitProblem&);

}  // namespace abbe
