// OTHER: random patterns in each factor, for physics that the catalogue does not have. Without it a diagnosis
// names the nearest effect with great confidence whatever the truth is. A family is the patterns that lie in
// one factor: functions of it alone, and of it together with each other factor that physics may tie to it,
// because what the catalogue leaves out is seldom a function of one thing.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/diagnose/explanations/patterns/touch_factors.hpp"
#include "engine/diagnose/model/explanation.hpp"

namespace abbe::diagnose::patterns {

/// Appends the patterns of one factor to the explanations.
class Family {
 public:
  Family(Factor factor, Explanations& out) : factor_(factor), out_(out) {}

  /// One explanation with these variants: columns of um.
  void add(std::string shape, const std::vector<Matrix>& variants) { append(std::move(shape), variants); }
  void add(std::string shape, const Matrix& columns) { append(std::move(shape), {columns}); }
  /// The same, each with what is told of it.
  struct Told {
    std::string what;
    Matrix columns;
  };
  void add(std::string shape, const std::vector<Told>&);
  /// Any function of several factors, quick ones too: it stands for more kinds of physics than the others, and is
  /// believed kOfAny times as much.
  void add_any(std::string shape, const std::vector<Matrix>& variants) { append(std::move(shape), variants, kOfAny); }

 private:
  static constexpr double kOfAny = 4;
  void append(std::string shape, const std::vector<Matrix>& variants, double share = 1);

  Factor factor_;
  Explanations& out_;
};

void over_time(const TouchFactors&, Family&);
void over_position(const TouchFactors&, Family&);
void over_direction(const TouchFactors&, Family&);
void over_head(const TouchFactors&, Family&);
void over_sensor(const TouchFactors&, Family&);
void over_feature(const TouchFactors&, Family&);
void over_setup(const TouchFactors&, Family&);
void over_run(const TouchFactors&, Family&);
void over_speed(const TouchFactors&, Family&);
void over_temperature(const TouchFactors&, Family&);

}  // namespace abbe::diagnose::patterns
