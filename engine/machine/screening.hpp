// Virtual machines that satisfy the specification: a virtual ISO 10360-2 test of each candidate (paper section 7,
// physics.md section 3).
//
// The lines run in scale readings through the middle of the travels, over `longest_share` of what the travels allow, centred. The
// five lengths of a line start at the same end and are evenly spaced from 25 mm (a fifth of the longest on lines under 125 mm). Which end
// matters: errors are zero at home, so lengths that start there meet smaller ones, and the share accepted moves by some
// percent. The axes start at home; of each diagonal's two corners the one is taken that makes the four starting points alternate corners
// of the volume, one of them home: no end of any axis is favoured.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/geometry.hpp"

namespace abbe {

/// One of the seven lines of the test and its five lengths, as tip positions in scale readings.
struct TestLine {
  std::string_view name;          ///< "x", "y", "z", "d1".."d4"
  Vec3 start_mm, direction;       ///< scale readings of the common first point; unit vector
  std::array<double, 5> length_mm{};
};
std::array<TestLine, 7> test_lines(const Machine&);
/// The tip of the virtual test, seen from the mount: 300 mm straight down.
inline constexpr Vec3 kTestTip{0, 0, -300};

/// Errors of indication of the 35 lengths, mm, and the performance indicator v = min |MPE(l) / err| (paper eq. 19).
struct TestResult {
  std::array<std::array<double, 5>, 7> error_mm{};
  double v = 0;
};
TestResult virtual_acceptance_test(const Machine&, const GeometryCoefficients&);

struct ScreeningCounts {
  std::uint64_t generated = 0, failed_mpe = 0, too_small = 0, used = 0;
  double share_accepted() const { return generated ? double(used) / double(generated) : 0; }
};

/// Accepted virtual machines in the order of their candidate index.
struct VirtualMachines {
  std::vector<std::uint32_t> index;                ///< candidate index: keys every random number of that machine
  std::vector<GeometryCoefficients> geometry;
  std::vector<double> v;
  ScreeningCounts counts;
  int size() const { return static_cast<int>(index.size()); }
};

/// Draws candidates 0, 1, 2, ... until `count` are accepted. The same for any number of threads. Throws UserError when fewer than
/// one in ten thousand pass, naming the share and the factor on e_max that would fit.
VirtualMachines screened_machines(const Machine&, std::uint64_t seed, int count, int threads);
/// Continues where `after` stopped: the next `count` accepted machines (adaptive runs).
VirtualMachines more_screened_machines(const Machine&, std::uint64_t seed, int count, int threads, std::uint32_t first_candidate);

/// What the user must hear of a screening: over half of the candidates fall outside the specification, and which factor on e_max
/// would fit. Nothing when more pass.
std::optional<Diagnostic> screening_warning(const Machine&, const ScreeningCounts&, std::uint64_t seed, int threads);

/// Candidates enough for a factor good to some percent: with them the share accepted is known to 1 %.
inline constexpr int kSuggestionCandidates = 2000;
/// The factor on all e_max for which the share accepted is largest, from `candidates` candidates.
struct SuggestedFactor {
  double factor = 1, share_accepted = 0;
};
SuggestedFactor suggest_e_max_factor(const Machine&, std::uint64_t seed, int candidates, int threads);

}  // namespace abbe
