// Columns of which patterns are made: random functions of points, by group or along directions.
#pragma once

#include <vector>

#include "engine/diagnose/model/linear.hpp"
#include "engine/math/vec.hpp"

namespace abbe::diagnose::patterns {

/// One point by row of the recording, of any dimension.
using Points = std::vector<std::vector<double>>;
using Directions = std::vector<Vec3>;

/// Functions of the points with a squared-exponential covariance of this length, which are smooth, or with an
/// exponential one, which may jump: columns of variance about 1, on at most `most` centres. Gaussian
/// processes in their subset-of-regressors form, K_rows,centres K_centres^(-1/2) (Rasmussen & Williams 2006,
/// 4.2.1 and 8.3.1).
Matrix smooth(const Points&, double length, int most);
Matrix rugged(const Points&, double length, int most);

/// The points of one factor of several, and the length within which what happens is alike.
struct Within {
  Points points;
  double length = 1;
};
/// What is alike where all these factors are: functions of all of them with a squared-exponential covariance, or an
/// exponential one, which may jump. So many points would need more columns than they have rows: the `most` principal
/// ones of the process (Rasmussen & Williams 2006, 8.1).
Matrix smooth_over(const std::vector<Within>&, int most);
Matrix rugged_over(const std::vector<Within>&, int most);
/// Groups as points, each at a distance of 1 from the others.
Points as_points(const std::vector<int>& group);

/// Points spread over all: each the one farthest from those before, until all are nearer than half a length, or `most`.
Points centres(const Points&, double length, int most);
/// One column: 1 at the centre, falling to exp(-1/2) at the distance `width`.
Matrix bump(const Points&, const std::vector<double>& centre, double width);

/// 1 in every row.
Matrix constant(std::size_t rows);
/// 1 and the coordinates of the points.
Matrix linear(const Points&);
/// The values of points of one dimension, which lie in [0, 1], from -1 to 1.
Vector from_middle(const Points&);
/// One component of each direction.
Vector component(const Directions&, int axis);
Points as_points(const Directions&);

/// Columns times each component of a direction by row: a vector field seen along the directions.
Matrix along(const Matrix& field, const Directions&);
/// The field in every direction, or in one of thirteen: the axes, and halfway between two or three of them.
std::vector<Matrix> along_all_or_one(const Matrix& field, const Directions&);
/// So many lobes about an axis of the directions, greatest on its equator: two columns, for any phase.
Matrix lobes(const Directions&, int axis, int count);
/// Every column of one times every column of the other.
Matrix products(const Matrix&, const Matrix&);

}  // namespace abbe::diagnose::patterns
