// The linear-Gaussian model of a recording.
//
//     y = X b + Z u + e,      u ~ N(0, scale_g^2 1) by group,      e ~ N(0, D) with a common correlation phi of neighbours
//
// y: residuals, um. X: what nothing is known of (placement of the part, unknown sizes). Z: what the simulated
// ensemble may do, scaled so that one unit is one standard deviation of the ensemble. Its hyperparameters are the scale
// of a group of Z, the factor on the noise of a group of rows, and phi.
#pragma once

#include <span>
#include <vector>

#include "engine/diagnose/model/decompositions.hpp"
#include "engine/math/units.hpp"

namespace abbe::diagnose {

/// Of residuals in um.
struct LinearModel {
  Vector y;                       ///< um
  Matrix free;                    ///< X, one column per unknown of which nothing is known
  Matrix random;                  ///< Z, um per standard deviation
  std::vector<int> random_group;  ///< by column of Z; 0 is the group whose scale is estimated, the others keep theirs
  Matrix rough;  ///< another ensemble in the place of group 0: no columns when there is none (rough_geometry.hpp)
  /// one error function, or all of an axis, that are more uneven than the others: no physics left out (rough_geometry.hpp)
  std::vector<Matrix> uneven;
  Vector noise_um;               ///< standard deviation of a row as the machine file states it
  std::vector<int> noise_group;  ///< by row
  int noise_groups = 1;
  /// of group 0 that is believed: whatever asks for more is no machine of this specification, or not the
  /// known one
  double largest_scale = 2.5;
  /// of the logarithm of the scale of group 0: how far a machine's errors may be from the specification's
  double scale_spread = 0.5;
  /// least factor on noise_um: no probe is so much better than its specification
  double quietest = 0.05;
  std::vector<char> follows;  ///< by row: measured right after the row before, with the same stylus
};

struct Hyperparameters {
  double scale = 1;        ///< of group 0 of Z
  Vector noise;            ///< factor on noise_um, by noise group
  double correlation = 0;  ///< phi of neighbouring rows
};

/// By row: whether the others say nothing of it, because an unknown of its own takes it up, as that of a surface point
/// that was touched once does.
std::vector<char> alone(const LinearModel&);

/// Columns of Z that are of group 0, whose scale is estimated, or those that are not.
std::vector<Eigen::Index> columns_of_group(const LinearModel&, bool scaled);

/// Z with group 0 at its scale.
Matrix random_at_scale(const LinearModel&, const Hyperparameters&);

/// The same model without the combinations of group 0 of Z, and of the other ensemble, that stay far below the noise.
LinearModel compact(const LinearModel&);

/// The model whose group 0 of Z is the other ensemble.
LinearModel rougher(const LinearModel&);

/// The model with these columns, um per standard deviation, beside its ensemble, at the size that they have.
LinearModel with_random(LinearModel, const Matrix& columns);

/// The columns of all of them, which have so many rows, one after the other.
Matrix side_by_side(Eigen::Index rows, std::span<const Matrix* const>);
Matrix side_by_side(const Matrix&, const Matrix&);
std::vector<const Matrix*> pointers_to(const std::vector<Matrix>&);

/// Columns that are worked on at once: a basis is read from memory once for all of them.
inline constexpr Eigen::Index kPortion = 512;
/// How many of the first have so many.
std::size_t portion(std::span<const Matrix* const>);

/// One column for each group: 1 in its rows.
Matrix indicator(const std::vector<int>& group);
/// The columns kept apart by group.
Matrix by_group(const Matrix&, const std::vector<int>& group);

/// What of this displacement of the rows, um, shows beside all that X can do.
Vector beside_free(const LinearModel&, const Vector&);

/// The model with one factor of the noise for all rows, so that a difference between groups shows.
LinearModel with_one_noise(LinearModel);

/// The model without some rows.
LinearModel without_rows(const LinearModel&, const std::vector<char>& dropped);

/// The model with the signatures of some variants as unknowns without a prior.
LinearModel with_free(const LinearModel&, const std::vector<const Matrix*>& signatures);

}  // namespace abbe::diagnose
