#include "engine/diagnose/explanations/patterns/functions.hpp"

#include <algorithm>
#include <cmath>

#include "engine/diagnose/model/rotated.hpp"

namespace abbe::diagnose::patterns {

namespace {

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

constexpr double kRidge = 1e-6;  // of the variance of a function: centres that are almost one stay two

/// A covariance of the squared distance, from each point to each.
template <class Covariance>
Matrix kernel(const Points& a, const Points& b, Covariance covariance) {
  Matrix k(a.size(), b.size());
  for (std::size_t j = 0; j < b.size(); ++j)
    for (std::size_t i = 0; i < a.size(); ++i) k(i, j) = covariance(squared_distance(a[i], b[j]));
  return k;
}

/// Functions of the points with such a covariance, one about each centre.
template <class Covariance>
Matrix functions(const Points& points, const Points& at, Covariance covariance) {
  return kernel(points, at, covariance) *
      inverse_root(kernel(at, at, covariance) + kRidge * Matrix::Identity(at.size(), at.size()));
}

/// The largest principal components of those functions, which are drawn together.
template <class Covariance>
Matrix principal_functions(const Points& points, const Points& at, Covariance covariance, int most) {
  const Matrix columns =
      Cholesky(kernel(at, at, covariance), kRidge).whitened(kernel(at, points, covariance)).transpose();
  if (columns.cols() <= most) return columns;
  const auto [axes, variance] = principal_axes(columns);
  const Eigen::Index kept = std::min<Eigen::Index>(most, variance.size());
  return axes.rightCols(kept) * variance.tail(kept).cwiseSqrt().asDiagonal();
}

auto exponential(double length) {
  return [length](double d2) { return std::exp(-std::sqrt(d2) / length); };
}

auto gaussian(double length) {
  return [length](double d2) { return std::exp(-d2 / (2 * length * length)); };
}

/// The factors side by side, each divided by its length.
Points joined(const std::vector<Within>& factors) {
  Points out(factors.front().points.size());
  for (const Within& f : factors)
    for (std::size_t i = 0; i < out.size(); ++i)
      for (const double v : f.points[i]) out[i].push_back(v / f.length);
  return out;
}

constexpr int kCentres = 3;  // for each principal function

}  // namespace

Matrix smooth_over(const std::vector<Within>& factors, int most) {
  const Points points = joined(factors);
  return principal_functions(points, centres(points, 1, kCentres * most), gaussian(1), most);
}

Matrix rugged_over(const std::vector<Within>& factors, int most) {
  const Points points = joined(factors);
  return principal_functions(points, centres(points, 0.5, kCentres * most), exponential(1), most);
}

Matrix smooth(const Points& points, double length, int most) {
  return functions(points, centres(points, length, most), gaussian(length));
}

Matrix rugged(const Points& points, double length, int most) {
  return functions(points, centres(points, 4.0 / most, most), exponential(length));
}

Points centres(const Points& points, double length, int most) {
  Points chosen{points.front()};
  std::vector<double> nearest(points.size(), 1e300);
  while (static_cast<int>(chosen.size()) < most) {
    std::size_t far = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = std::min(nearest[i], squared_distance(points[i], chosen.back()));
      if (nearest[i] > nearest[far]) far = i;
    }
    if (nearest[far] < length * length / 4) break;
    chosen.push_back(points[far]);
  }
  return chosen;
}

Matrix bump(const Points& points, const std::vector<double>& centre, double width) {
  Matrix out(points.size(), 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    out(static_cast<Eigen::Index>(i), 0) = std::exp(-squared_distance(points[i], centre) / (2 * width * width));
  return out;
}

Matrix constant(std::size_t rows) { return Matrix::Ones(static_cast<Eigen::Index>(rows), 1); }

Matrix linear(const Points& points) {
  Matrix m(points.size(), 1 + points.front().size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    m(row, 0) = 1;
    for (std::size_t k = 0; k < points[i].size(); ++k) m(row, static_cast<Eigen::Index>(k) + 1) = points[i][k];
  }
  return m;
}

Vector from_middle(const Points& line) {
  Vector v(static_cast<Eigen::Index>(line.size()));
  for (std::size_t i = 0; i < line.size(); ++i) v(static_cast<Eigen::Index>(i)) = 2 * line[i][0] - 1;
  return v;
}

Vector component(const Directions& directions, int axis) {
  Vector v(static_cast<Eigen::Index>(directions.size()));
  for (std::size_t i = 0; i < directions.size(); ++i) v(static_cast<Eigen::Index>(i)) = directions[i][axis];
  return v;
}

Points as_points(const Directions& directions) {
  Points out;
  for (const Vec3& d : directions) out.push_back({d.x, d.y, d.z});
  return out;
}

Matrix along(const Matrix& field, const Directions& directions) {
  Matrix out(field.rows(), 3 * field.cols());
  for (int k = 0; k < 3; ++k)
    out.middleCols(k * field.cols(), field.cols()) = component(directions, k).asDiagonal() * field;
  return out;
}

std::vector<Matrix> along_all_or_one(const Matrix& field, const Directions& directions) {
  std::vector<Matrix> out{along(field, directions)};
  // the half of the 27 directions with components -1, 0, 1 that is after the middle
  for (int code = 14; code < 27; ++code) {
    const Vec3 d{double(code / 9 - 1), double(code / 3 % 3 - 1), double(code % 3 - 1)};
    Vector share(field.rows());
    for (Eigen::Index i = 0; i < field.rows(); ++i) share(i) = dot(directions[i], d) / norm(d);
    out.push_back(share.asDiagonal() * field);
  }
  return out;
}

Points as_points(const std::vector<int>& group) {
  const Matrix in = indicator(group) / std::sqrt(2.0);
  Points out(group.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vector row = in.row(static_cast<Eigen::Index>(i));
    out[i].assign(row.begin(), row.end());
  }
  return out;
}

Matrix lobes(const Directions& d, int axis, int count) {
  const Vector x = component(d, (axis + 1) % 3), y = component(d, (axis + 2) % 3);
  Matrix m(x.size(), 2);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double angle = count * std::atan2(y(i), x(i)), equator = x(i) * x(i) + y(i) * y(i);
    m.row(i) << equator * std::cos(angle), equator * std::sin(angle);
  }
  return m;
}

Matrix products(const Matrix& a, const Matrix& b) {
  Matrix out(a.rows(), a.cols() * b.cols());
  for (Eigen::Index k = 0; k < b.cols(); ++k) out.middleCols(k * a.cols(), a.cols()) = b.col(k).asDiagonal() * a;
  return out;
}

}  // namespace abbe::diagnose::patterns
