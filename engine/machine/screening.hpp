// Virtual machines that satisfy the specification: a virtual acceptance test of each candidate (paper section 7,
// docs/machine.md, "Screening"). The lines of the test, seven of E0 and with an E150 stated four more, come from
// engine/machine/acceptance; a machine is as good as its worst length.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/diagnostic.hpp"
#include "engine/machine/acceptance/acceptance.hpp"
#include "engine/machine/geometry.hpp"

namespace abbe {

/// Errors of indication of all lengths, mm, line by line as in test_lines(), and the performance indicator
/// v = min |MPE(l) / err| (paper eq. 19).
struct TestResult {
  std::vector<std::array<double, kLengthsPerLine>> error_mm;
  double v = 0;
};
TestResult virtual_acceptance_test(const Machine&, const GeometryCoefficients&);

struct ScreeningCounts {
  std::uint64_t generated = 0, failed_mpe = 0, too_small = 0, used = 0;
  double share_accepted() const { return generated ? double(used) / double(generated) : 0; }
};

/// Accepted virtual machines in the order of their candidate index.
struct VirtualMachines {
  std::vector<std::uint32_t> index;  ///< candidate index: keys every random number of that machine
  std::vector<GeometryCoefficients> geometry;
  std::vector<double> v;
  ScreeningCounts counts;
  int size() const { return static_cast<int>(index.size()); }
};

/// Draws candidates 0, 1, 2, ... until `count` are accepted. The same for any number of threads. Throws
/// UserError when fewer than one in ten thousand pass, naming the share and the factor on e_max that would
/// fit, and when there is no room for so many.
VirtualMachines screened_machines(const Machine&, std::uint64_t seed, int count, int threads);
/// Continues a screening: the next `count` accepted machines from `first_candidate` on (adaptive runs).
VirtualMachines more_screened_machines(const Machine&, std::uint64_t seed, int count, int threads,
                                       std::uint32_t first_candidate);

/// W0416 where fewer than one in a hundred candidates satisfies the specification: a slip in e_max or in the MPE.
std::optional<Diagnostic> contradicts_specification(const Machine&, std::uint64_t seed, int threads);

/// What the user must hear of a screening: over half of the candidates fall outside the specification, and
/// which factor on e_max would fit. Nothing when more pass.
std::optional<Diagnostic> screening_warning(const Machine&, const ScreeningCounts&, std::uint64_t seed, int threads);

/// Candidates enough for a factor good to some percent: with them the share accepted is known to 1 %.
inline constexpr int kSuggestionCandidates = 2000;
/// Accepted by a factor that is good enough. Where better machines pass without limit, or with a generous
/// one, every smaller factor is as good or better, and only the largest that still does says something of the
/// machine.
inline constexpr double kEnoughAccepted = 0.95;
struct SuggestedFactor {
  double factor = 1;
  /// of as many fresh candidates: that of the candidates it was chosen with is the luckiest of many
  double share_accepted = 0;
  /// the largest factor with which kEnoughAccepted are accepted; else the one with which most are
  bool largest = false;
};
/// A factor on all e_max, between 1/100 and 100, from `candidates` candidates. None when no factor makes a
/// difference: none of them lets a candidate pass, or the machine has no errors to multiply.
std::optional<SuggestedFactor> suggest_e_max_factor(const Machine&, std::uint64_t seed, int candidates, int threads);

}  // namespace abbe
