#include "engine/diagnose/baseline/rough_geometry.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <span>

#include "engine/diagnose/explanations/explanation.hpp"
#include "engine/machine/geometry.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kKnots = 17;
/// Lengths of the covariance, in halves of the travel.
constexpr double kLengths[] = {0.25, 0.6, 1.5};
constexpr double kShortLengths[] = {0.25};
/// Standard deviation of a function over its largest value: of a smooth random function of bounded range.
constexpr double kShareOfLargest = 0.3;

double covariance(double a, double b, std::span<const double> lengths, double line) {
  double sum = 0;
  for (const double length : lengths) {
    const double h = std::sqrt(5.0) * std::abs(a - b) / length;
    sum += (1 + h + h * h / 3) * std::exp(-h) / double(lengths.size());
  }
  return sum + line * line * a * b;
}

/// Functions of u in [-1, 1] with unit-size coefficients: at u, less their values at home.
class Functions {
 public:
  Functions(std::span<const double> lengths, double line) : lengths_(lengths), line_(line) {
    Matrix k(kKnots, kKnots);
    for (int i = 0; i < kKnots; ++i)
      for (int j = 0; j < kKnots; ++j) k(i, j) = covariance(knot(i), knot(j), lengths, line);
    root_ = Eigen::SelfAdjointEigenSolver<Matrix>(k + 1e-9 * Matrix::Identity(kKnots, kKnots)).operatorInverseSqrt();
    home_ = row(-1);
  }
  Vector at(double u) const { return row(u) - home_; }

 private:
  static double knot(int i) { return -1 + 2.0 * i / (kKnots - 1); }
  Vector row(double u) const {
    Vector k(kKnots);
    for (int i = 0; i < kKnots; ++i) k(i) = covariance(u, knot(i), lengths_, line_);
    return root_ * k;
  }
  std::span<const double> lengths_;
  double line_;
  Matrix root_;
  Vector home_;
};

/// All error functions, kKnots columns each.
Matrix function_columns(const RecordedTouches& t, const Machine& machine, const Functions& functions) {
  constexpr double kMmPerM = 1e-3;
  Matrix out = Matrix::Zero(static_cast<Eigen::Index>(t.touches.size()), kComponents * kKnots);
  for (std::size_t i = 0; i < t.touches.size(); ++i) {
    const TouchScene& s = t.touches[i].scene;
    for (int axis = 0; axis < 3; ++axis) {
      const MachineAxis& a = machine[static_cast<Axis>(axis)];
      const Vector f = functions.at(2 * std::abs(s.reading[axis]) / a.travel_mm - 1);
      for (int c = 0; c < kComponents; ++c) {
        if (axis_of(static_cast<Component>(c)) != static_cast<Axis>(axis)) continue;
        AxisErrors unit;
        unit.value[c] = machine.components[static_cast<std::size_t>(c)].e_max * a.travel_mm * kMmPerM * kShareOfLargest;
        const double um =
            kUmPerMm * dot(s.normal, geometric_error(machine, unit, s.reading, s.stylus.tip_from_mount_mm));
        out.row(static_cast<Eigen::Index>(i)).segment(c * kKnots, kKnots) = um * f;
      }
    }
  }
  return out;
}

}  // namespace

Matrix rough_geometry(const RecordedTouches& t, const Machine& machine, double line) {
  return function_columns(t, machine, Functions(kLengths, line));
}

std::vector<Matrix> uneven_functions(const RecordedTouches& t, const Machine& machine) {
  const Matrix all = function_columns(t, machine, Functions(kShortLengths, 0));
  std::vector<Matrix> out;
  for (int c = 0; c < kComponents; ++c) out.push_back(compressed(all.middleCols(c * kKnots, kKnots)));
  return out;
}

}  // namespace abbe::diagnose
