#include "engine/diagnose/values/value_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/diagnose/values/value_patterns.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kHalf = 1000, kPerValue = 10;
constexpr std::size_t kMostValues = 500;

/// The steps to which values of the kind of value `k`, lengths or angles, are rounded: those of the one with the most
/// digits, since zeros at the end may be left out.
double step_of(const ValueCase& c, std::size_t k) {
  double step = 0;
  for (std::size_t j = 0; j < c.ensemble.values.size(); ++j) {
    const double digit = c.recording->rows[j].last_digit;
    if (c.ensemble.values[j].angle == c.ensemble.values[k].angle && digit > 0)
      step = step > 0 ? std::min(step, digit) : digit;
  }
  return step / c.ensemble.values[k].reported();
}

}  // namespace

std::vector<std::string> labels_of(const ValueCase& c) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    out.push_back(fmt::format("{} of {}", c.recording->rows[k].characteristic, program_of(c, k)));
    if (v.occurrence > 1) out.back() += fmt::format(", evaluation {}", v.occurrence);
  }
  return out;
}

int machines_for(std::size_t values) { return 2 * (kHalf + kPerValue * static_cast<int>(values)); }
bool enough(const Matrix& simulated) { return simulated.rows() / 2 >= simulated.cols() + 2; }

Judges judges_of(const Matrix& simulated, const Matrix& recorded, std::uint64_t seed) {
  const Eigen::Index half = simulated.rows() / 2;
  Judges out;
  out.judged = as_recorded(simulated.bottomRows(simulated.rows() - half), recorded, seed);
  out.mean = simulated.topRows(half).colwise().mean();
  const Matrix centred = simulated.topRows(half).rowwise() - out.mean.transpose();
  out.covariance = centred.transpose() * centred / double(half - 1) + recorded * recorded.transpose();
  out.covariance.diagonal().array() += kLeastOfValue_um * kLeastOfValue_um;
  return out;
}

std::string program_of(const ValueCase& c, std::size_t value) {
  const std::string& said = c.recording->rows[value].program;
  const SourceFile& source = *(*c.programs)[c.ensemble.values[value].program].source;
  return said.empty() ? std::filesystem::path(source.name()).filename().string() : said;
}

void refuse_too_many(const ValueRecording& recording) {
  const std::size_t n = recording.rows.size();
  if (n > kMostValues)
    throw UserError(diagnostic(Code::E0552, fmt::format("{}: {} values are too many", recording.source.name(), n),
                               fmt::format("at most {} are judged together; split the file", kMostValues)));
}

std::optional<ValueCase> value_case_of(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                                       const Machine& machine, const VirtualMachines& machines,
                                       const DiagnoseOptions& options) {
  const int n = static_cast<int>(recording.rows.size());
  ValueCase c;
  c.recording = &recording, c.programs = &programs, c.machine = &machine, c.options = &options;
  c.ensemble = value_ensemble(recording, programs, machine, machines, options);
  c.deviation.resize(n), c.recorded.setZero(n, 2 * n);
  for (int k = 0; k < n; ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    c.deviation(k) = v.deviation, c.recorded(k, v.artefact) = v.calibration;
    c.recorded(k, n + k) = step_of(c, k) / std::sqrt(12.0);
  }
  if (!enough(c.ensemble.simulated)) return std::nullopt;
  c.judges = judges_of(c.ensemble.simulated, c.recorded, options.seed);
  add_value_patterns(c);
  c.search.emplace(c.judges.mean, c.judges.covariance, c.ensemble.explanations);
  return c;
}

}  // namespace abbe::diagnose
