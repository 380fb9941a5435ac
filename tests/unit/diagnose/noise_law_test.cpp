#include "engine/diagnose/model/noise_law.hpp"

#include <doctest/doctest.h>

#include "engine/lanes/random.hpp"

using namespace abbe;
using namespace abbe::diagnose;

namespace {

constexpr std::uint32_t kNoiseLawStream = stream_of("test.noise_law");

/// Of 200 recordings of this noise, those of which a normal law is believed with one half or more.
int taken_for_normal(const NoiseLaw& law, Eigen::Index touches) {
  int count = 0;
  for (int k = 0; k < 200; ++k)
    count += NoiseLaw(3.0 * law.simulated(touches, 1, kNoiseLawStream, k)).belief_in_normal() >= 0.5;
  return count;
}

}  // namespace

TEST_CASE("noise with tails is known by them, whatever its scale") {
  CHECK(taken_for_normal(NoiseLaw(), 75) > 170);
  CHECK(taken_for_normal(NoiseLaw(), 300) > 170);
  CHECK(taken_for_normal(NoiseLaw::student_t(4), 300) < 10);
  CHECK(NoiseLaw(Vector::Zero(20)).belief_in_normal() == 1);
}

TEST_CASE("numbers of a noise law have unit variance, and those of a t are no gross outliers") {
  constexpr int kMany = 200000;
  const auto variance = [](const Vector& v) { return v.squaredNorm() / kMany; };
  CHECK(variance(NoiseLaw().simulated(kMany, 7, kNoiseLawStream, 0)) == doctest::Approx(1).epsilon(0.02));
  CHECK(variance(NoiseLaw::student_t(10).simulated(kMany, 7, kNoiseLawStream, 0)) == doctest::Approx(1).epsilon(0.02));
  const Vector v = NoiseLaw::student_t(4).simulated(kMany, 7, kNoiseLawStream, 0);
  // cutting them off at 4.2 takes 8 % of the variance away
  CHECK(variance(v) == doctest::Approx(0.92).epsilon(0.02));
  CHECK(std::abs(v.mean()) < 0.01);
  CHECK(v.cwiseAbs().maxCoeff() <= kOutlier);
}
