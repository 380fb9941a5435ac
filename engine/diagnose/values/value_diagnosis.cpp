#include "engine/diagnose/values/value_diagnosis.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "engine/diagnose/case.hpp"
#include "engine/diagnose/findings/doubt.hpp"
#include "engine/diagnose/findings/search.hpp"
#include "engine/diagnose/median.hpp"
#include "engine/diagnose/values/value_estimate.hpp"
#include "engine/diagnose/values/value_search.hpp"
#include "engine/diagnose/values/value_signature.hpp"
#include "engine/diagnose/words.hpp"
#include "engine/lanes/random.hpp"

namespace abbe {

using namespace diagnose;

namespace {

constexpr int kHalf = 1000, kPerValue = 10, kMostValues = 500;
constexpr double kLeast_um = 1e-3;  // what rounding leaves of a value that no error reaches

/// The values on the bench.
struct ValueCase {
  const ValueRecording* recording = nullptr;
  const std::vector<ValueProgram>* programs = nullptr;
  const Machine* machine = nullptr;
  const DiagnoseOptions* options = nullptr;
  ValueEnsemble ensemble;
  Vector deviation;
  Matrix calibration;  ///< one column for each artefact: a standard deviation of its calibration
  Matrix judges;       ///< machines of the first half: mean and covariance
  Matrix judged;       ///< of the second half, with errors of calibration: what the recording is compared with
  Vector mean;
  Matrix covariance;
  std::optional<ValueSearch> search;
};

/// Simulated machines as they would be recorded: each with its own errors of calibration.
Matrix with_calibration(Matrix m, const Matrix& calibration, std::uint64_t seed) {
  constexpr std::uint32_t stream = stream_of("diagnose.values.calibration");
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index k = 0; k < calibration.cols(); ++k)
      m.row(i) +=
          calibration.col(k).transpose() *
          normal_quantile(
              uniform_pair({seed, static_cast<std::uint32_t>(i), stream, static_cast<std::uint32_t>(k), 0, 0}).a);
  return m;
}

ValueCase on_the_bench(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                       const Machine& machine, const DiagnoseOptions& options) {
  const int n = static_cast<int>(recording.rows.size());
  if (n > kMostValues)
    throw UserError(diagnostic(Code::E0552, fmt::format("{}: {} values are too many", recording.source.name(), n),
                               fmt::format("at most {} are judged together; split the file", kMostValues)));
  ValueCase c{&recording,
              &programs,
              &machine,
              &options,
              value_ensemble(recording, programs, machine, options, 2 * (kHalf + kPerValue * n)),
              {},
              {},
              {},
              {},
              {},
              {},
              {}};
  c.deviation.resize(n), c.calibration.setZero(n, n);
  for (int k = 0; k < n; ++k) {
    const RecordedValue& v = c.ensemble.values[static_cast<std::size_t>(k)];
    c.deviation(k) = v.deviation, c.calibration(k, v.artefact) = v.calibration;
  }
  const Eigen::Index half = c.ensemble.simulated.rows() / 2;
  if (half < n + 2)
    throw UserError(diagnostic(
        Code::E0553, fmt::format("{}: hardly any virtual machine reaches all of these values", recording.source.name()),
        "`abbe run` says where they stop"));
  c.judges = c.ensemble.simulated.topRows(half);
  c.judged = with_calibration(c.ensemble.simulated.bottomRows(c.ensemble.simulated.rows() - half), c.calibration,
                              options.seed);
  c.mean = c.judges.colwise().mean();
  const Matrix centred = c.judges.rowwise() - c.mean.transpose();
  c.covariance = centred.transpose() * centred / double(half - 1) + c.calibration * c.calibration.transpose();
  c.covariance.diagonal().array() += kLeast_um * kLeast_um;
  add_value_patterns(c.covariance, c.ensemble.explanations);
  c.search.emplace(c.mean, c.covariance, c.ensemble.explanations);
  return c;
}

/// Each value by itself: how far out it is among those of the virtual machines.
std::vector<JudgedValue> judge_each(const ValueCase& c) {
  std::vector<JudgedValue> out;
  for (std::size_t k = 0; k < c.ensemble.values.size(); ++k) {
    const RecordedValue& v = c.ensemble.values[k];
    const ValueRow& row = c.recording->rows[k];
    const auto at = static_cast<Eigen::Index>(k);
    std::vector<double> simulated(c.judged.col(at).begin(), c.judged.col(at).end());
    std::sort(simulated.begin(), simulated.end());
    const double n = double(simulated.size()), distance = std::abs(v.deviation - c.mean(at));
    const auto beyond = std::count_if(simulated.begin(), simulated.end(),
                                      [&](double s) { return std::abs(s - c.mean(at)) >= distance; });
    const double u = std::sqrt(c.covariance(at, at)), unit = v.reported();
    const auto point = [&](double p) { return simulated[static_cast<std::size_t>(p * (n - 1) + 0.5)] * unit; };
    const SourceFile& source = *(*c.programs)[static_cast<std::size_t>(v.program)].source;
    const std::string program =
        row.program.empty() ? std::filesystem::path(source.name()).filename().string() : row.program;
    out.push_back({row.characteristic, program, v.angle ? "deg" : "mm", row.run, row.occurrence, row.value, v.reference,
                   v.deviation * unit, u * unit, (v.deviation - c.mean(at)) / u, (double(beyond) + 1) / (n + 1),
                   point(0.025), point(0.975)});
  }
  return out;
}

/// Of the coefficients of a block, under a prior so wide that it does not pull.
Sizes sizes_of(const ValueSearch& search, int block, const Vector& deviation) {
  const auto info = search.information(block, deviation);
  constexpr double kWide = 30;  // typical sizes
  const Eigen::LLT<Matrix> llt(info.g + Matrix::Identity(info.g.rows(), info.g.cols()) / (kWide * kWide));
  return {llt.solve(info.u), llt.solve(Matrix::Identity(info.g.rows(), info.g.cols()))};
}

std::vector<DiagnosedParameter> parameters_of(const ValueCase& c, const Finding& f) {
  const Block& b = c.search->explanations().blocks[static_cast<std::size_t>(f.block)];
  const Effect& effect = *c.search->explanations().list[static_cast<std::size_t>(f.explanation)].effect;
  const Sizes alone = sizes_of(*c.search, f.block, c.deviation);
  const Sizes s = sizes_beside_errors({c.ensemble.values, *c.programs, *c.machine, *c.options, c.deviation,
                                       c.covariance, c.calibration},
                                      effect, b, alone.mean)
                      .value_or(alone);
  std::vector<DiagnosedParameter> out;
  for (std::size_t k = 0; k < b.columns.size(); ++k) {
    const EffectParameter& p = effect.parameters[static_cast<std::size_t>(b.columns[k].parameter)];
    const auto at = static_cast<Eigen::Index>(k);
    const double value = s.mean(at) * b.columns[k].unit, u = std::sqrt(s.covariance(at, at)) * b.columns[k].unit;
    const double low = value - 1.96 * u, high = value + 1.96 * u;
    out.push_back({std::string(p.name), std::string(p.unit), value, u, low, high, {}, high >= p.low && low <= p.high});
  }
  for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
    const EffectParameter& parameter = effect.parameters[p];
    if (parameter.choices.empty()) continue;
    DiagnosedParameter choice{.name = std::string(parameter.name), .unit = ""};
    choice.word = parameter.choices[static_cast<std::size_t>(std::lround(b.theta[p] - parameter.low))];
    out.push_back(std::move(choice));
  }
  return out;
}

void tell_pattern(const ValueCase& c, const Finding& f, Diagnosis& out) {
  const Explanations& all = c.search->explanations();
  const Explanation& e = all.list[static_cast<std::size_t>(f.explanation)];
  const Sizes s = sizes_of(*c.search, f.block, c.deviation);
  const Vector pattern = all.blocks[static_cast<std::size_t>(f.block)].signature * s.mean;
  const double rms = std::sqrt(pattern.squaredNorm() / double(pattern.size())),
               u = rms / std::sqrt(2.0 * double(pattern.size()));
  out.unexplained = Unexplained{
      std::string(name(e.factor)),
      e.shape,
      rms,
      u,
      std::max(0.0, rms - 1.96 * u),
      rms + 1.96 * u,
      e.shape == "single values"
          ? "No effect of the catalogue explains it: single values stray (the table says which)."
          : "No effect of the catalogue explains it: the values deviate as those of a machine with larger errors than specified."};
  out.verdict = Verdict::unexplained;
}

void tell_name(const ValueCase& c, const Finding& f, double adequacy, Diagnosis& out) {
  const Explanations& all = c.search->explanations();
  DiagnosedEffect e;
  std::vector<std::string_view> titles;
  for (const int k : f.set) {
    e.members.push_back(all.list[static_cast<std::size_t>(k)].name);
    titles.push_back(all.list[static_cast<std::size_t>(k)].effect->title);
  }
  const Effect& effect = *all.list[static_cast<std::size_t>(f.explanation)].effect;
  e.parameters = parameters_of(c, f);
  const bool size = plausible(e.parameters);
  e.probability = believed(f.probability, adequacy < kInadequate || !size);
  e.sentence = explanation_sentence(titles, e.parameters, "a file of values", {}, e.probability < kTold);
  if (!size)
    e.sentence += kNoSuchSize;
  else
    out.model_effects.push_back(nearest_possible(effect, setting_of(e.members.front(), e.parameters)));
  out.adequacy_p = adequacy;
  out.verdict = f.set.size() > 1 ? Verdict::one_of : Verdict::named;
  out.effects.push_back(std::move(e));
}

/// The groups that are left out in turn: programs, else single values.
std::vector<int> groups_of(const ValueCase& c, std::string& scheme) {
  std::vector<int> program;
  for (const RecordedValue& v : c.ensemble.values) program.push_back(v.program);
  scheme = "leave-one-program-out";
  if (std::set<int>(program.begin(), program.end()).size() >= 3) return program;
  scheme = "leave-one-value-out";
  std::iota(program.begin(), program.end(), 0);
  return program;
}

/// What the explanation predicts of values that it was not fitted to (improvement.cpp has the formula).
void show_improvement(const ValueCase& c, const Finding& f, Diagnosis& out) {
  Improvement i;
  const std::vector<int> group = groups_of(c, i.scheme);
  const Explanations one = only(c.search->explanations(), {f.explanation});
  const double complete = ValueSearch(c.mean, c.covariance, one).evidence(c.deviation).log_bayes[0];
  std::vector<double> gain;
  Vector predicted = Vector::Zero(c.deviation.size());
  for (const int g : std::set<int>(group.begin(), group.end())) {
    std::vector<char> dropped;
    for (const int k : group) dropped.push_back(k == g);
    std::vector<Eigen::Index> kept;
    const ValueSearch search = search_without(c.mean, c.covariance, one, dropped, kept);
    if (kept.empty()) return;
    const Vector rest = c.deviation(kept);
    const Evidence evidence = search.evidence(rest);
    gain.push_back(complete - evidence.log_bayes[0]);
    const auto best =
        static_cast<int>(std::max_element(evidence.block_log_bayes.begin(), evidence.block_log_bayes.end()) -
                         evidence.block_log_bayes.begin());
    const Vector all = one.blocks[static_cast<std::size_t>(best)].signature * sizes_of(search, best, rest).mean;
    for (std::size_t k = 0; k < group.size(); ++k)
      if (group[k] == g) predicted(static_cast<Eigen::Index>(k)) = all(static_cast<Eigen::Index>(k));
  }
  const double n = double(gain.size()), k = double(c.deviation.size());
  i.log_score_gain = std::accumulate(gain.begin(), gain.end(), 0.0);
  double square = 0;
  for (const double g : gain) square += std::pow(g - i.log_score_gain / n, 2);
  i.se = n > 1 ? std::sqrt(n * square / (n - 1)) : 0;
  const Vector before = c.deviation - c.mean, after = before - predicted;
  i.rms_before_um = std::sqrt(before.squaredNorm() / k), i.rms_after_um = std::sqrt(after.squaredNorm() / k);
  const Vector sense = predicted.array().sign();
  i.bias_before_um = before.dot(sense) / k, i.bias_after_um = after.dot(sense) / k;
  i.chi2_per_dof_before = c.search->white(c.deviation).squaredNorm() / k;
  i.chi2_per_dof_after = c.search->white(c.deviation - predicted).squaredNorm() / k;
  out.improvement = i;
}

/// What is left of the information on one column once a rival takes what it can, as a share.
double left(const ValueSearch& s, int block, Eigen::Index column, int rival) {
  const Vector cross = s.between(rival, block).col(column);
  const Matrix g = s.between(rival, rival);
  const double own = s.between(block, block)(column, column);
  return 1 -
      cross.dot(Eigen::LDLT<Matrix>(g + 1e-9 * g.trace() * Matrix::Identity(g.rows(), g.cols())).solve(cross)) / own;
}

std::vector<Detectable> smallest_detectable(const ValueCase& c) {
  const ValueSearch& s = *c.search;
  const Explanations& all = s.explanations();
  std::vector<Detectable> out;
  for (std::size_t k = 0; k < all.list.size(); ++k) {
    if (!all.list[k].effect) continue;
    int best = all.list[k].blocks.front();
    Eigen::Index column = 0;
    double most = 0;
    for (const int b : all.list[k].blocks) {
      Eigen::Index at = 0;
      const double information = s.between(b, b).diagonal().maxCoeff(&at);
      if (information > most) most = information, best = b, column = at;
    }
    if (most < 1e-12) continue;
    const Block& block = all.blocks[static_cast<std::size_t>(best)];
    const Column& of = block.columns[static_cast<std::size_t>(column)];
    const EffectParameter& p = all.list[k].effect->parameters[static_cast<std::size_t>(of.parameter)];
    const double largest = block.signature.col(column).cwiseAbs().maxCoeff(), size = kDetects / std::sqrt(most);
    Detectable d{.effect = all.list[k].name,
                 .parameter = std::string(p.name),
                 .unit = std::string(p.unit),
                 .name = {},
                 .name_um = {},
                 .confounded_with = {}};
    d.detect = of.unit * size, d.detect_um = largest * size;
    double least = 1;
    for (std::size_t j = 0; j < all.list.size(); ++j) {
      if (j == k || !all.list[j].effect) continue;
      double share = 1;
      for (const int b : all.list[j].blocks) share = std::min(share, left(s, best, column, b));
      least = std::min(least, share);
      if (share < 1 - kConfounded * kConfounded && d.confounded_with.size() < 4)
        d.confounded_with.push_back(all.list[j].name);
    }
    if (least > kInseparable) {
      const double named = kNames / std::sqrt(most * least);
      d.name = of.unit * named, d.name_um = largest * named;
    }
    out.push_back(std::move(d));
  }
  return out;
}

/// How often virtual machines look as unusual to a search as the recording does.
double chance_of(const ValueCase& c, const ValueSearch& search) {
  std::vector<double> simulated;
  for (Eigen::Index i = 0; i < c.judged.rows(); ++i)
    simulated.push_back(search.evidence(c.judged.row(i).transpose()).statistic);
  return tail_probability(search.evidence(c.deviation).statistic, std::move(simulated));
}

/// How often chance leaves as much as a name does.
double adequacy_of(const ValueCase& c, const Finding& name) {
  const Explanations& all = c.search->explanations();
  return name.explanation < 0
      ? 1
      : chance_of(c,
                  ValueSearch(c.mean, c.covariance, all, all.blocks[static_cast<std::size_t>(name.block)].signature));
}

/// A name, or what stands for none; what is told is returned.
Finding tell(const ValueCase& c, Diagnosis& out) {
  const Explanations& all = c.search->explanations();
  const Evidence evidence = c.search->evidence(c.deviation);
  const Finding name = finding_of(all, evidence, true), pattern = finding_of(all, evidence, false);
  const double adequacy = adequacy_of(c, name);
  const bool doubted = adequacy < kInadequate && leaves_less(adequacy_of(c, pattern), adequacy);
  const bool named = likelier(name, pattern, doubted ? kNamedInDoubt : kNamed);
  if (named)
    tell_name(c, name, adequacy, out);
  else
    tell_pattern(c, pattern, out);
  return named ? name : pattern;
}

/// Calibrations that say less of most values than any machine of the specification would.
void doubt_calibrations(const ValueCase& c, std::vector<Diagnostic>& messages) {
  constexpr double kTimes = 3;
  std::vector<double> times;
  for (Eigen::Index k = 0; k < c.deviation.size(); ++k) {
    const double calibrated = c.calibration.row(k).norm(), of_both = std::sqrt(c.covariance(k, k));
    times.push_back(calibrated /
                    std::sqrt(std::max(of_both * of_both - calibrated * calibrated, kLeast_um * kLeast_um)));
  }
  const double middle = median(std::move(times));
  if (middle < kTimes) return;
  messages.push_back(diagnostic(
      Code::W0726,
      fmt::format("{}: by U the calibrated values are known {:.0f} times worse than the machine measures them",
                  c.recording->source.name(), middle),
      "U is the expanded uncertainty (k = 2) in mm or degrees, as the value is; as it stands, only errors larger than U show"));
}

}  // namespace

Diagnosis diagnose_values(const ValueRecording& recording, const std::vector<ValueProgram>& programs,
                          const Machine& machine, const DiagnoseOptions& options) {
  begins(options.progress, "virtual machines of the specification, and every effect on them");
  const ValueCase c = on_the_bench(recording, programs, machine, options);
  Diagnosis out;
  out.judged = !options.design_only;
  doubt_calibrations(c, out.messages);
  out.cannot_judge = cannot_judge(c.search->explanations());
  begins(options.progress, "what these values could detect");
  out.smallest_detectable = smallest_detectable(c);
  if (options.design_only) return out;
  begins(options.progress, "simulated recordings without a mismatch");
  out.values = judge_each(c);
  out.p_value = chance_of(c, *c.search);
  if (out.p_value > kAlarm) return out;
  begins(options.progress, "sizes of what was found");
  show_improvement(c, tell(c, out), out);
  const auto worst =
      std::max_element(out.values.begin(), out.values.end(),
                       [](const JudgedValue& a, const JudgedValue& b) { return std::abs(a.z) < std::abs(b.z); });
  double squares = 0;
  for (const JudgedValue& v : out.values) squares += v.z * v.z;
  out.location.push_back(
      {"feature",
       {{"characteristic", worst->characteristic}, {"program", worst->program}, {"run", std::to_string(worst->run)}},
       worst->z * worst->z / squares,
       std::min(1.0, worst->p * double(out.values.size()))});
  return out;
}

}  // namespace abbe
