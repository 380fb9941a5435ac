// Random samples for the tests of statistics, with exact distributions to compare them with.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/lanes/random.hpp"

namespace abbe::test {

/// The random numbers of one trial, one after the other.
class Trial {
 public:
  Trial(std::uint64_t seed, std::uint32_t number) : address_{seed, number, stream_of("test.stats")} {}

  double uniform() { return uniform_pair({address_.seed, address_.machine, address_.stream, 0, 0, address_.draw++}).a; }
  double rectangular(double low, double high) { return low + (high - low) * uniform(); }
  double normal(double mean = 0, double sd = 1) { return mean + sd * normal_quantile(uniform()); }
  /// Student's t with `dof` degrees of freedom: a normal over the root of an independent
  /// chi-squared, which is a sum of exponentials and, for odd dof, one squared normal.
  double student(int dof, double mean, double scale) {
    double chi_squared = 0;
    for (int i = 0; i < dof / 2; ++i) chi_squared -= 2 * std::log(uniform());
    if (dof % 2) chi_squared += std::pow(normal(), 2);
    return mean + scale * normal() / std::sqrt(chi_squared / dof);
  }
  /// U-shaped (arc sine) on [low, high]: JCGM 101, 6.4.6.
  double arc_sine(double low, double high) {
    return (low + high) / 2 + (high - low) / 2 * std::sin(2 * std::numbers::pi * uniform());
  }
  /// Rectangular with inexactly known limits: JCGM 101, 6.4.3.
  double curvilinear_trapezoid(double low, double high, double d) {
    const double left = (low - d) + 2 * d * uniform();
    return rectangular(left, low + high - left);
  }

 private:
  RandomAddress address_;
};

/// `n` values of a model, one per trial.
template <class Model>
std::vector<double> sample(int n, Model model, std::uint64_t seed = 1, std::uint32_t first = 0) {
  std::vector<double> y(n);
  for (int i = 0; i < n; ++i) {
    Trial trial(seed, first + static_cast<std::uint32_t>(i));
    y[i] = model(trial);
  }
  return y;
}

/// A sum of four rectangular variables on [-a_i, a_i], exactly: F(x) = sum over the signs s of
/// prod(s) (x + s.a)_+^4 divided by 4! prod(2 a_i).
struct FourRectangular {
  double a[4];

  double distribution(double x) const { return signed_powers(x, 4) / 24; }
  double density(double x) const { return signed_powers(x, 3) / 6; }
  double quantile(double p) const {
    double low = -(a[0] + a[1] + a[2] + a[3]), high = -low;
    for (int i = 0; i < 100; ++i) (distribution((low + high) / 2) < p ? low : high) = (low + high) / 2;
    return (low + high) / 2;
  }

 private:
  double signed_powers(double x, int power) const {
    double sum = 0;
    for (int signs = 0; signs < 16; ++signs) {
      double point = x, product = 1;
      for (int i = 0; i < 4; ++i) {
        const double s = signs >> i & 1 ? -1 : 1;
        point += s * a[i];
        product *= s / (2 * a[i]);
      }
      if (point > 0) sum += product * std::pow(point, power);
    }
    return sum;
  }
};

inline double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

}  // namespace abbe::test
