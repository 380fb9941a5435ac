#include "engine/recording/recording.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace abbe {
namespace {

/// Positions between -400 and 900 mm as a counter with this step reads them, and a file writes them.
std::vector<double> counted(double step_mm, double written_mm, int count, unsigned seed = 7) {
  std::mt19937 draw(seed);
  std::uniform_real_distribution<double> anywhere(-400, 900), beside(-0.005, 0.005);
  std::vector<double> out;
  for (int k = 0; k < count; ++k) {
    const double length = k % 3 == 2 ? out.back() + beside(draw) : anywhere(draw);  // a few on one plane
    out.push_back(written_mm * std::round(step_mm * std::round(length / step_mm) / written_mm));
  }
  return out;
}

TEST_CASE("the step of which all lengths are multiples is found, a round number or not") {
  for (const double step_um : {1.0, 0.55, 10.0, 5.2, 4.0 / 3, 10.0 / 3, 0.6328, 12.3456, 19.0 / 3, 1.29904})
    for (const double written_mm : {1e-6, 1e-7})
      for (const int count : {36, 400}) {
        CAPTURE(step_um);
        CAPTURE(written_mm);
        CHECK(common_step_mm(counted(step_um / 1000, written_mm, count)) ==
              doctest::Approx(step_um / 1000).epsilon(1e-6));
      }
}

TEST_CASE("lengths that are written to nanometres and not rounded have no other step") {
  for (const double written_mm : {1e-6, 1e-7})
    for (const int count : {9, 36, 4000}) CHECK(common_step_mm(counted(1e-9, written_mm, count)) <= 1e-6);
  int larger = 0;  // of a few, some have a step by chance
  for (unsigned seed = 0; seed < 2000; ++seed) larger += common_step_mm(counted(1e-9, 1e-6, 5, seed)) > 1e-5 ? 1 : 0;
  CHECK(larger == 0);
  CHECK(common_step_mm(std::vector<double>{}) == 0);
  CHECK(common_step_mm({0, 0}) == 0);
}

}  // namespace
}  // namespace abbe
