// The list of acceptance tests, and what concerns them all.
#include <fmt/format.h>

#include <algorithm>

#include "engine/machine/acceptance/acceptance.hpp"
#include "engine/math/units.hpp"

namespace abbe {

extern const AcceptanceTest length_e0_test;
extern const AcceptanceTest length_e150_test;
extern const AcceptanceTest repeatability_r0_test;
extern const AcceptanceTest form_and_size_test;

std::span<const AcceptanceTest* const> acceptance_tests() {
  static constexpr const AcceptanceTest* all[] = {
      &length_e0_test,
      &length_e150_test,
      &repeatability_r0_test,
      &form_and_size_test,
  };
  return all;
}

std::vector<TestLine> test_lines(const Machine& machine) {
  std::vector<TestLine> lines;
  for (const AcceptanceTest* test : acceptance_tests())
    if (test->lines)
      for (const TestLine& line : test->lines(machine)) lines.push_back(line);
  return lines;
}

std::vector<ProbeCheck> probe_checks(const Machine& machine, std::uint64_t seed) {
  std::vector<ProbeCheck> checks;
  for (const AcceptanceTest* test : acceptance_tests())
    if (test->probe)
      for (const ProbeCheck& check : test->probe(machine, seed)) checks.push_back(check);
  return checks;
}

std::vector<Diagnostic> probe_warnings(const Machine& machine, std::span<const ProbeCheck> checks) {
  std::vector<Diagnostic> warnings;
  for (const ProbeCheck& check : checks)
    if (check.share_passed < 0.5)
      warnings.push_back(diagnostic(Code::W0418,
                                    fmt::format("the probe of \"{}\" would pass only {:.3g} % of the tests of {}: "
                                                "the median is {:.3g} um, the limit "
                                                "{:.3g} um",
                                                machine.name, 100 * check.share_passed, check.name,
                                                kUmPerMm * check.median_mm, kUmPerMm * check.limit_mm),
                                    fmt::format("check \"probe.sd_um\" and the limit against the data sheet: with "
                                                "the standard deviations multiplied "
                                                "by {:.2f}, half of the tests would pass",
                                                check.limit_mm / check.median_mm)));
  return warnings;
}

TestLine central_line(const Machine& machine, std::string_view test, std::string_view name, char mark, const Vec3& runs,
                      const Vec3& tip_mm, const LengthMpe& mpe) {
  constexpr double kShortest_mm = 25;  // below 30 mm, as the standard asks
  constexpr int n = kLengthsPerLine;
  Vec3 whole, middle;
  for (int a = 0; a < 3; ++a) {
    const double travel = machine.axes[a].direction * machine.axes[a].travel_mm;
    if (runs[a] != 0) whole[a] = runs[a] * travel;
    middle[a] = travel / 2;
  }
  const double longest = machine.specification.longest_share * norm(whole);
  const double shortest = std::min(kShortest_mm, longest / n);
  TestLine line{name, test, mark, middle - 0.5 * longest * unit(whole), unit(whole), tip_mm, mpe, {}, {}};
  for (int m = 0; m < n; ++m) {
    line.length_mm[m] = shortest + (longest - shortest) * m / (n - 1);
    line.mpe_mm[m] = mpe.at(line.length_mm[m]);
  }
  return line;
}

}  // namespace abbe
