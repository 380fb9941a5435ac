// Acceptance tests: what a buyer of the machine would have tested, run on virtual machines. A test
// is one .cpp file in this folder and one line in all.cpp. A machine file asks for a test by
// stating its maximum permissible error (docs/machine.md).
//
// Tests of lengths (E0, E150): every virtual machine is measured on `lines`, and screening keeps
// those whose indicator v = min |MPE(l) / error| over all these lengths lies in the accepted range.
// Geometric errors only: the probe's noise would make a machine pass or fail by chance, and is
// tested on its own.
//
// Tests of the probe (R0, form and size): the repeatability of the probe is the same for all
// virtual machines, so there is nothing to select. `probe` says which share of such tests the
// standard deviations of the machine file would pass.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/machine.hpp"

namespace abbe {

inline constexpr int kLengthsPerLine = 5;

/// One line of a test of lengths: five lengths from the same first point.
struct TestLine {
  std::string_view name;     ///< "x", "y", "z", "d1".."d4"; of E150 "yz+", "yz-", "xz+", "xz-"
  std::string_view test;     ///< "E0", "E150"
  char mark;                 ///< stands for it in plots; no other line has it
  Vec3 start_mm, direction;  ///< scale readings of the common first point; unit vector
  Vec3 tip_mm;               ///< the tip, seen from the mount
  LengthMpe mpe;             ///< of the test
  std::array<double, kLengthsPerLine> length_mm{}, mpe_mm{};
};

/// What the probe's repeatability makes of one limit of the specification.
struct ProbeCheck {
  std::string_view name;    ///< symbol of the standard: "R0", "P_Form.Sph.1x25"
  double limit_mm = 0;      ///< as the machine file states it
  double median_mm = 0;     ///< of the tested quantity, over repeated tests
  double share_passed = 0;  ///< of the tests, all of whose values lie within the limit
};

struct AcceptanceTest {
  std::string_view name;
  std::string_view help;
  std::string_view source;  ///< standard and clause
  /// The lines of a test of lengths; none when the machine file does not state its MPE. nullptr: a
  /// test of the probe.
  std::vector<TestLine> (*lines)(const Machine&) = nullptr;
  /// The checks of a test of the probe; none when the machine file states no limit. nullptr: a test
  /// of lengths.
  std::vector<ProbeCheck> (*probe)(const Machine&, std::uint64_t seed) = nullptr;
};
std::span<const AcceptanceTest* const> acceptance_tests();

/// All lines of all tests that the machine file asks for; E0 first.
std::vector<TestLine> test_lines(const Machine&);
/// All checks of the probe that the machine file asks for.
std::vector<ProbeCheck> probe_checks(const Machine&, std::uint64_t seed);
/// A warning for each check that fewer than half of the tests pass: the machine file contradicts
/// itself.
std::vector<Diagnostic> probe_warnings(const Machine&, std::span<const ProbeCheck>);

// --- for the tests of this folder ---

/// The tip of the tests of lengths, seen from the mount: 300 mm straight down.
inline constexpr Vec3 kTestTip{0, 0, -300};
/// A line through the middle of the travels over `longest_share` of what they allow, centred.
/// `runs`: how it runs through each travel, away from home (1), towards home (-1) or not at all
/// (0). The five lengths start at the same end and are evenly spaced from 25 mm (a fifth of the
/// longest on lines under 125 mm).
TestLine central_line(const Machine&, std::string_view test, std::string_view name, char mark, const Vec3& runs,
                      const Vec3& tip_mm, const LengthMpe&);

/// P(range of three independent standard normal values <= r). Harter 1960; here by quadrature, to
/// 1e-12.
double range_of_three_cdf(double r);

/// The pattern that ISO 10360-5:2010, 6.2.4 proposes for a sphere: the pole, then 4, 8, 4 and 8 touches on circles 22.5
/// degrees apart down to the equator, each circle turned by 22.5 degrees against the one above. Outward normals, the pole
/// along z.
std::array<Vec3, 25> form_and_size_pattern();

}  // namespace abbe
