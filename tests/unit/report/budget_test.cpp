#include "engine/report/budget.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "sample_plan.hpp"

using namespace abbe;
using namespace abbe::test;

namespace {

/// Deviations that are uncorrelated: a alternates, b goes in pairs. Both have the mean 0.
constexpr int kMachines = 400;
std::vector<double> values(double a, double b, double ab = 0) {
  std::vector<double> out;
  for (int i = 0; i < kMachines; ++i) {
    const double x = i % 2 ? 1 : -1, y = i % 4 < 2 ? 1 : -1;
    out.push_back(500 + a * x + b * y + ab * x * y);
  }
  return out;
}

Samples of(std::vector<double> v) { return samples(0, 500, {}, std::move(v)); }

}  // namespace

TEST_CASE("a budget has the uncertainty of each source and shares that sum to one") {
  const auto run = [](double a) { return run_of({of(values(a, 0))}, kMachines); };
  const auto lines = variance_budget({{"exx", run(0.002)}, {"head", run(0)}, {"probe", run(0.001)}}, run(0.002).samples,
                                     0, Unit::mm, 1);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].name == "exx");
  CHECK(lines[0].share == doctest::Approx(0.8));
  CHECK(lines[0].u == doctest::Approx(0.002 * std::sqrt(kMachines / (kMachines - 1.0))));
  CHECK(lines[1].share == 0);
  CHECK(lines[1].u == 0);
  CHECK(lines[2].share == doctest::Approx(0.2));
}

TEST_CASE("alignment and feature share the variance by their covariances with the whole") {
  const auto lines = alignment_split(of(values(0.001, 0.002)), of(values(0.001, 0)), of(values(0, 0.002)), Unit::mm, 1);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].name == "alignment");
  CHECK(lines[0].share == doctest::Approx(0.2));
  CHECK(lines[1].name == "feature");
  CHECK(lines[1].share == doctest::Approx(0.8));
  CHECK(lines[0].u / lines[1].u == doctest::Approx(0.5));
}

TEST_CASE("correlated parts may compensate: one share is negative and the sum is one") {
  const auto lines = alignment_split(of(values(0.001, 0)), of(values(-0.001, 0)), of(values(0.002, 0)), Unit::mm, 1);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].share == doctest::Approx(-1));
  CHECK(lines[1].share == doctest::Approx(2));
}

TEST_CASE("what the two leave open is their interaction, named when it matters") {
  const auto split = [](double ab) {
    return alignment_split(of(values(0.001, 0.001, ab)), of(values(0.001, 0)), of(values(0, 0.001)), Unit::mm, 1);
  };
  CHECK(split(1e-5).size() == 2);  // 0.005 % of the variance
  const auto lines = split(0.001);
  REQUIRE(lines.size() == 3);
  CHECK(lines[2].name == "interaction");
  CHECK(lines[2].share == doctest::Approx(1.0 / 3));
  CHECK(lines[0].share + lines[1].share + lines[2].share == doctest::Approx(1));
  for (const auto& line : lines)
    CHECK(line.u == doctest::Approx(0.001 * std::sqrt(kMachines / (kMachines - 1.0))).epsilon(1e-6));
}

TEST_CASE("only machines that are in all three samples are compared") {
  Samples alignment = of({1, 2}), feature = of({1, 1, 1});
  alignment.machine = {2, 1};
  const Samples all = of({5, 3, 2});
  const auto lines = alignment_split(all, alignment, feature, Unit::mm, 1);  // machines 1 and 2
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].share == doctest::Approx(1));
  alignment.machine = {7, 8};
  CHECK(alignment_split(all, alignment, feature, Unit::mm, 1).empty());
}

TEST_CASE("what varies by less than a nanometre has no shares") {
  for (const double a : {1e-12, 5e-7})
    for (const auto& line : alignment_split(of(values(a, 0)), of(values(a, 0)), of(values(0, 0)), Unit::mm, 1)) {
      CHECK(line.share == 0);
      CHECK(line.u == 0);
    }
}
