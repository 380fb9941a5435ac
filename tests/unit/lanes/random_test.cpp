#include "engine/lanes/random.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tests/unit/lanes/levels.hpp"

namespace abbe {

TEST_CASE("Philox4x32-10 equals the known answers published with Random123") {
  struct {
    std::uint32_t counter[4], key[2], answer[4];
  } const known[] = {{{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
                     {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
                      {0xffffffff, 0xffffffff},
                      {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
                     {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
                      {0xa4093822, 0x299f31d0},
                      {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}};
  for (const auto& k : known) {
    const Philox4 r = philox4x32(k.counter[0], k.counter[1], k.counter[2], k.counter[3], k.key[0], k.key[1]);
    for (int i = 0; i < 4; ++i) CHECK(r.v[i] == k.answer[i]);
  }
}

TEST_CASE("uniform numbers stay inside (0, 1) and are symmetric about 1/2") {
  const double smallest = uniform_from_bits(0, 0), largest = uniform_from_bits(0xffffffff, 0xffffffff);
  CHECK(smallest == 0x1p-53);
  CHECK(largest == 1 - 0x1p-53);
}

TEST_CASE("every part of an address gives its own numbers") {
  const RandomAddress base{1, 2, 3, 4, 5, 6};
  std::vector<RandomAddress> others(6, base);
  others[0].seed = 7;
  others[1].machine = 7;
  others[2].stream = 7;
  others[3].site = 7;
  others[4].visit = 7;
  others[5].draw = 7;
  for (const RandomAddress& other : others) CHECK(uniform_pair(other).a != uniform_pair(base).a);
  CHECK(stream_of("probe") != stream_of("head"));
}

TEST_CASE("the normal quantile agrees with 20-digit values to 1e-14") {
  struct {
    double p, x;
  } const known[] = {
      {1e-300, -37.047096299361199237},  {1e-20, -9.2623400897984075796},   {1e-10, -6.3613409024040561991},
      {1.3e-11, -6.6676114565107408347}, {1.4e-11, -6.6567230915181836356}, {0.001, -3.0902323061678135354},
      {0.02, -2.0537489106318230443},    {0.075, -1.4395314709384559349},   {0.0749999, -1.4395321773759005864},
      {0.2, -0.84162123357291416552},    {0.49, -0.025068908258711058033},  {0.6, 0.25334710313579974132},
      {0.925, 1.4395314709384562291},    {0.95, 1.6448536269514722843},     {0.975, 1.9599639845400538556},
      {0.999999, 4.7534243088170877657}};
  for (const auto& [p, x] : known) {
    CAPTURE(p);
    CHECK(normal_quantile(p) == doctest::Approx(x).epsilon(1e-14));
  }
  CHECK(normal_quantile(0.5) == 0);
}

TEST_CASE("a normal number is the same alone and in company, at every instruction set level") {
  const int n = 1000;
  std::vector<std::uint32_t> machine(n), visit(n);
  for (int i = 0; i < n; ++i)
    machine[i] = static_cast<std::uint32_t>(977 * i), visit[i] = static_cast<std::uint32_t>(i % 5);
  std::vector<double> a(n), b(n), a1(n), b1(n);
  normal_pairs(n, 42, machine.data(), 3, 4, visit.data(), 1, a.data(), b.data());
  for (int i = 0; i < n; ++i) normal_pairs(1, 42, &machine[i], 3, 4, &visit[i], 1, &a1[i], &b1[i]);
  CHECK(a == a1);
  CHECK(b == b1);
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  const auto same = [&](const char* level, auto& pairs) {
    CAPTURE(level);
    pairs(n, 42, machine.data(), 3, 4, visit.data(), 1, a1.data(), b1.data());
    CHECK(a == a1);
    CHECK(b == b1);
  };
  if (__builtin_cpu_supports("x86-64-v2")) same("x86-64-v2", abbe_v2::normal_pairs);
  if (__builtin_cpu_supports("x86-64-v3")) same("x86-64-v3", abbe_v3::normal_pairs);
  if (__builtin_cpu_supports("x86-64-v4")) same("x86-64-v4", abbe_v4::normal_pairs);
#endif
}

// Each statistic lies within 4.5 of its standard deviations: a false alarm in 7 per million for
// each, 4 checks. The seed is fixed, so the test passes always or never; the rate says how far
// chance explains a failure after a change.
TEST_CASE("moments of the normal numbers") {
  const int n = 1'000'000;
  std::vector<std::uint32_t> machine(n), visit(n);
  for (int i = 0; i < n; ++i) machine[i] = static_cast<std::uint32_t>(i);
  std::vector<double> a(n), b(n);
  normal_pairs(n, 1, machine.data(), stream_of("probe"), 0, visit.data(), 0, a.data(), b.data());
  double mean = 0, square = 0, fourth = 0, product = 0;
  for (int i = 0; i < n; ++i) mean += a[i], square += a[i] * a[i], fourth += std::pow(a[i], 4), product += a[i] * b[i];
  const double sd = 4.5 / std::sqrt(n);
  CHECK(std::fabs(mean / n) < sd);
  CHECK(std::fabs(square / n - 1) < sd * std::sqrt(2.0));
  CHECK(std::fabs(fourth / n - 3) < sd * std::sqrt(96.0));
  CHECK(std::fabs(product / n) < sd);
}

}  // namespace abbe
