#include "engine/machine/screening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/memory.hpp"
#include "engine/base/on_threads.hpp"

namespace abbe {

namespace {

constexpr int kBatch = 128;                  ///< candidates drawn and tested together
constexpr std::uint64_t kPatience = 20'000;  ///< candidates before next to none accepted is called hopeless
constexpr std::uint64_t kHopeless = 10'000;  ///< one in so many

using Lines = std::vector<TestLine>;
/// Of one machine, line by line.
using LengthErrors = std::vector<std::array<double, kLengthsPerLine>>;

/// Length errors of the virtual test on every lane of the block: (d(end) - d(start)) . direction.
std::vector<LengthErrors> length_errors(const Lines& lines, const GeometryBlock& block) {
  const int n = block.lanes();
  std::vector<int> lane(n);
  for (int i = 0; i < n; ++i) lane[i] = i;
  std::vector<double> columns(9 * static_cast<std::size_t>(n));
  double* const c = columns.data();
  double* const enc[3] = {c, c + n, c + 2 * n};
  double* const tip[3] = {c + 3 * n, c + 4 * n, c + 5 * n};
  double* const d[3] = {c + 6 * n, c + 7 * n, c + 8 * n};

  // The error along the line, at a distance from its start, on every lane.
  const auto error_along = [&](const TestLine& line, double distance_mm, std::vector<double>& out) {
    const Vec3 at = line.start_mm + distance_mm * line.direction;
    for (int k = 0; k < 3; ++k) {
      std::fill_n(enc[k], n, at[k]);
      std::fill_n(tip[k], n, line.tip_mm[k]);
      std::fill_n(d[k], n, 0.0);
    }
    block.add_error(n, lane.data(), enc, tip, d);
    for (int i = 0; i < n; ++i) out[i] = dot({d[0][i], d[1][i], d[2][i]}, line.direction);
  };

  std::vector<LengthErrors> errors(n, LengthErrors(lines.size()));
  std::vector<double> start(n), end(n);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    error_along(lines[k], 0, start);
    for (int m = 0; m < kLengthsPerLine; ++m) {
      error_along(lines[k], lines[k].length_mm[m], end);
      for (int i = 0; i < n; ++i) errors[i][k][m] = end[i] - start[i];
    }
  }
  return errors;
}

/// v = min |MPE(l) / (known + factor * drawn)|.
double indicator(const Lines& lines, const LengthErrors& known, const LengthErrors& drawn, double factor) {
  double v = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < lines.size(); ++k)
    for (int m = 0; m < kLengthsPerLine; ++m)
      v = std::min(v, lines[k].mpe_mm[m] / std::fabs(known[k][m] + factor * drawn[k][m]));
  return v;
}

/// Consecutive candidates with their length errors.
struct Batch {
  std::vector<GeometryCoefficients> geometry;
  std::vector<LengthErrors> errors;
};

Batch draw_batch(const Machine& machine, const Lines& lines, std::uint64_t seed, std::uint32_t first, int count) {
  Batch batch;
  std::vector<const GeometryCoefficients*> pointers;
  for (int i = 0; i < count; ++i)
    batch.geometry.push_back(draw_geometry(machine, seed, first + static_cast<std::uint32_t>(i)));
  for (const GeometryCoefficients& one : batch.geometry) pointers.push_back(&one);
  batch.errors = length_errors(lines, GeometryBlock(machine, pointers));
  return batch;
}

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

/// Length errors of candidates, as a factor on e_max changes them: known + factor * drawn. Errors grow in
/// proportion to e_max; only the known squarenesses, which every candidate shares, do not.
struct ScalableErrors {
  LengthErrors known;
  std::vector<LengthErrors> drawn;
};

ScalableErrors scalable_errors(const Machine& machine, const Lines& lines, std::uint64_t seed, int first,
                               int candidates, int threads) {
  Machine known_only = machine;
  for (ComponentSpec& component : known_only.components) component.e_max = 0;
  ScalableErrors out{draw_batch(known_only, lines, seed, 0, 1).errors.front(), std::vector<LengthErrors>(candidates)};
  on_threads((candidates + kBatch - 1) / kBatch, threads, [&](int b) {
    const int from = b * kBatch;
    Batch batch =
        draw_batch(machine, lines, seed, static_cast<std::uint32_t>(first + from), std::min(kBatch, candidates - from));
    for (std::size_t i = 0; i < batch.errors.size(); ++i) {
      for (std::size_t k = 0; k < lines.size(); ++k)
        for (int m = 0; m < kLengthsPerLine; ++m) batch.errors[i][k][m] -= out.known[k][m];
      out.drawn[from + i] = std::move(batch.errors[i]);
    }
  });
  return out;
}

double share_accepted(const Specification& spec, const Lines& lines, const ScalableErrors& errors, double factor) {
  int accepted = 0;
  for (const LengthErrors& drawn : errors.drawn) {
    const double v = indicator(lines, errors.known, drawn, factor);
    accepted += v >= spec.v_min && v <= spec.v_max;
  }
  return double(accepted) / double(errors.drawn.size());
}

// From 1/100 to 100 in steps of 2 %.
constexpr int kFactorSteps = 466;
double factor_of(int step) { return 0.01 * std::pow(1.02, step); }

/// A factor with which fewer are accepted is no advice.
constexpr double kHelps = 0.01;

/// What a factor on e_max would change, as part of a sentence.
std::string effect_of(const SuggestedFactor& best) {
  return fmt::format("by {:.2g}, then about {:.0f} % are accepted", best.factor, 100 * best.share_accepted);
}

constexpr const char* kLetBetterPass =
    "\"v_max\": \"unlimited\" in the specification lets machines pass however good they are";

std::string way_out(const ScreeningCounts& counts, const std::optional<SuggestedFactor>& best) {
  const bool helps = best && best->share_accepted >= kHelps;
  if (counts.too_small <= counts.failed_mpe)
    return helps ? "multiply every e_max " + effect_of(*best)
                 : "no factor on all of e_max from 0.01 to 100 helps: check the MPE (um, um/m), each e_max (um/m, "
                   "um/m2), the offsets and the squarenesses of the machine file";
  return helps ? fmt::format("multiply every e_max {}; or else {}", effect_of(*best), kLetBetterPass)
               : fmt::format("they are better than v_max allows, and no factor on e_max helps: {}", kLetBetterPass);
}

[[noreturn]] void give_up(const Machine& machine, std::uint64_t seed, const ScreeningCounts& counts, int threads) {
  const auto best = suggest_e_max_factor(machine, seed, kSuggestionCandidates, threads);
  throw UserError(
      diagnostic(Code::E0415,
                 fmt::format("only {} of {} virtual machines of \"{}\" satisfy its specification: {} fail the "
                             "MPE, {} have errors too small for it",
                             counts.used, counts.generated, machine.name,
                             percent(double(counts.failed_mpe) / double(counts.generated)),
                             percent(double(counts.too_small) / double(counts.generated))),
                 way_out(counts, best)));
}

/// The coefficients of all accepted machines are kept: said before the hours of drawing them.
void check_memory(const Machine& machine, int count) {
  constexpr double kGigabyte = 1e9;
  const double bytes = double(count) * kComponents * basis_size(machine.harmonics) * sizeof(double);
  if (bytes > memory_bytes())
    throw UserError(diagnostic(Code::E0620,
                               fmt::format("{} virtual machines take {:.3g} GB of memory, and there are {:.3g} GB",
                                           count, bytes / kGigabyte, memory_bytes() / kGigabyte),
                               "ask for fewer: 1000 machines give u to about 2 %, and a million to 0.07 %"));
}

}  // namespace

TestResult virtual_acceptance_test(const Machine& machine, const GeometryCoefficients& geometry) {
  const Lines lines = test_lines(machine);
  const GeometryCoefficients* const one[] = {&geometry};
  const LengthErrors errors = length_errors(lines, GeometryBlock(machine, one)).front();
  return {errors, indicator(lines, LengthErrors(lines.size()), errors, 1)};
}

VirtualMachines screened_machines(const Machine& machine, std::uint64_t seed, int count, int threads) {
  return more_screened_machines(machine, seed, count, threads, 0);
}

VirtualMachines more_screened_machines(const Machine& machine, std::uint64_t seed, int count, int threads,
                                       std::uint32_t first_candidate) {
  check_memory(machine, count);
  const Lines lines = test_lines(machine);
  const LengthErrors none(lines.size());
  const Specification& spec = machine.specification;
  VirtualMachines out;
  // Batches are drawn `threads` at a time and judged in their order, candidate by candidate, until
  // there are enough.
  std::vector<Batch> round(std::max(1, threads));
  for (std::uint32_t first = first_candidate; out.size() < count;) {
    on_threads(static_cast<int>(round.size()), threads, [&](int b) {
      round[b] = draw_batch(machine, lines, seed, first + static_cast<std::uint32_t>(b * kBatch), kBatch);
    });
    for (Batch& batch : round) {
      for (int i = 0; i < kBatch && out.size() < count; ++i) {
        const double v = indicator(lines, none, batch.errors[i], 1);
        ++out.counts.generated;
        if (v < spec.v_min) {
          ++out.counts.failed_mpe;
        } else if (v > spec.v_max) {
          ++out.counts.too_small;
        } else {
          ++out.counts.used;
          out.index.push_back(first + static_cast<std::uint32_t>(i));
          out.geometry.push_back(std::move(batch.geometry[i]));
          out.v.push_back(v);
        }
      }
      first += kBatch;
      if (out.counts.generated >= kPatience && out.counts.used * kHopeless < out.counts.generated)
        give_up(machine, seed, out.counts, threads);
    }
  }
  return out;
}

std::optional<Diagnostic> screening_warning(const Machine& machine, const ScreeningCounts& counts, std::uint64_t seed,
                                            int threads) {
  if (counts.share_accepted() >= 0.5) return std::nullopt;
  const auto best = suggest_e_max_factor(machine, seed, kSuggestionCandidates, threads);
  return diagnostic(Code::W0416,
                    fmt::format("only {} of the virtual machines of \"{}\" satisfy its specification: {} fail the "
                                "MPE, {} have errors too small for it",
                                percent(counts.share_accepted()), machine.name,
                                percent(double(counts.failed_mpe) / double(counts.generated)),
                                percent(double(counts.too_small) / double(counts.generated))),
                    "the e_max of the machine file fit its specification badly: " + way_out(counts, best));
}

std::optional<Diagnostic> contradicts_specification(const Machine& machine, std::uint64_t seed, int threads) {
  constexpr int kCandidates = 2000;
  constexpr double kHardlyAny = 0.01;
  const Lines lines = test_lines(machine);
  const double share =
      share_accepted(machine.specification, lines, scalable_errors(machine, lines, seed, 0, kCandidates, threads), 1);
  if (share >= kHardlyAny) return std::nullopt;
  return diagnostic(Code::W0416,
                    fmt::format("hardly any of the virtual machines of \"{}\" satisfies its specification ({} of {}): "
                                "it is no machine that a recording can be compared with",
                                machine.name, std::lround(share * kCandidates), kCandidates),
                    "correct e_max or the MPE of the machine file; 'abbe machine screen' says which e_max would fit");
}

std::optional<SuggestedFactor> suggest_e_max_factor(const Machine& machine, std::uint64_t seed, int candidates,
                                                    int threads) {
  const Lines lines = test_lines(machine);
  const Specification& spec = machine.specification;
  const ScalableErrors chosen_with = scalable_errors(machine, lines, seed, 0, candidates, threads);
  std::vector<double> share(kFactorSteps);
  on_threads(kFactorSteps, threads,
             [&](int step) { share[step] = share_accepted(spec, lines, chosen_with, factor_of(step)); });
  const auto [fewest, most] = std::minmax_element(share.begin(), share.end());
  if (*fewest == *most) return std::nullopt;
  const auto enough = std::find_if(share.rbegin(), share.rend(), [](double s) { return s >= kEnoughAccepted; });
  const bool largest = enough != share.rend();
  const double factor = factor_of(static_cast<int>((largest ? enough.base() - 1 : most) - share.begin()));
  const ScalableErrors fresh = scalable_errors(machine, lines, seed, candidates, candidates, threads);
  return SuggestedFactor{factor, share_accepted(spec, lines, fresh, factor), largest};
}

}  // namespace abbe
