#include "engine/diagnose/next_measurement.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace abbe::diagnose {

namespace {

constexpr std::size_t kMostTouches = 60, kShown = 3, kMostRivals = 5;
constexpr double kSecondsPerTouch = 5, kPlanned = 6;   // kPlanned: signal-to-noise that a plan without data reckons with

/// An explanation in the running: its weight and the size that it would have.
struct Rival {
  int explanation;
  double weight;
};

/// The effect that a plan confounds with most others, and these.
std::vector<Rival> confounded(const Case& c, const std::vector<Detectable>& detectable) {
  const auto most = std::max_element(detectable.begin(), detectable.end(),
                                     [](const Detectable& a, const Detectable& b) { return a.confounded_with.size() < b.confounded_with.size(); });
  std::vector<Rival> list;
  if (most == detectable.end()) return list;
  std::vector<std::string> names = most->confounded_with;
  names.push_back(most->effect);
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k)
    if (std::find(names.begin(), names.end(), c.explanations.list[k].name) != names.end()) list.push_back({static_cast<int>(k), 1});
  return list;
}

/// Those that could not be told apart; without data, those that the plan could not tell apart.
std::vector<Rival> rivals_of(const Case& c, const SearchResult* result, const std::vector<Detectable>& detectable) {
  std::vector<Rival> list;
  if (!result) list = confounded(c, detectable);
  if (result && !result->findings.empty()) {
    const Finding& f = result->findings.front();
    for (const int k : f.set)
      if (list.size() < kMostRivals) list.push_back({k, c.explanations.list[k].prior * std::exp(f.evidence.log_bayes[k] - f.evidence.log_bayes[f.explanation])});
  }
  double total = 0;
  for (const Rival& r : list) total += r.weight;
  for (Rival& r : list) r.weight /= total;
  return list;
}

/// The recording with a share of its touches repeated under a change.
struct Longer {
  RecordedTouches touches;
  std::vector<RecordedTouch> added;
};
Longer longer(const Case& c, const Change& change) {
  Longer out{c.touches, {}};
  const std::size_t n = c.rows.size(), step = std::max<std::size_t>(1, n / kMostTouches);
  const double end_s = c.touches.touches.back().scene.time_s + 60;
  for (std::size_t k = 0; k < n; k += step) {
    RecordedTouch t = c.touches.touches[c.rows[k]];
    t.scene.time_s = end_s + kSecondsPerTouch * double(out.added.size());
    change.apply(t);
    out.added.push_back(t);
  }
  out.touches.touches.insert(out.touches.touches.end(), out.added.begin(), out.added.end());
  out.touches.known |= change.makes_known;
  out.touches.varying |= change.makes_known;
  return out;
}

/// One variant of an explanation and the size of its coefficients.
struct Supposed {
  std::size_t variant = 0;
  Vector size;
};

/// The strongest variant by the data so far, with the size that it took there; of a plan, the one that shows best, of a size to be found.
Supposed supposed(const Case& c, int explanation) {
  const EvidenceSearch own(c.model, c.hyper, only(c.explanations, {explanation}));
  const std::size_t variants = c.explanations.list[explanation].blocks.size();
  if (c.options.design_only) {
    Supposed best;
    double most = 0;
    for (std::size_t k = 0; k < variants; ++k) {
      const Matrix g = own.between(static_cast<int>(k), static_cast<int>(k));
      Eigen::Index column = 0;
      const double information = g.diagonal().maxCoeff(&column);
      if (information <= most) continue;
      most = information;
      best = {k, Vector::Unit(g.rows(), column) * (kPlanned / std::sqrt(information))};
    }
    return best;
  }
  const std::vector<double>& logs = own.evidence().block_log_bayes;
  const auto variant = static_cast<std::size_t>(std::max_element(logs.begin(), logs.end()) - logs.begin());
  const auto info = own.information(static_cast<int>(variant));
  return {variant, Eigen::LLT<Matrix>(info.g + Matrix::Identity(info.g.rows(), info.g.cols()) / 9).solve(info.u)};
}

/// The probability that the truth would have, on average over the rivals as truth.
double expected_probability(const Case& c, const std::vector<Rival>& rivals, const Longer& recording) {
  const KnownGeometry known{c.baseline.mean, c.baseline.factor};
  const Baseline baseline = baseline_of(recording.touches, *c.machine, {Surfaces::calibrated, &known, c.options.seed, c.options.threads});
  std::vector<std::string> names;
  std::vector<int> rows;
  for (const Rival& r : rivals) names.push_back(c.explanations.list[r.explanation].name);
  for (std::size_t i = 0; i < recording.touches.touches.size(); ++i) rows.push_back(static_cast<int>(i));
  const Explanations all = named_explanations(recording.touches, rows, names);
  Hyperparameters hyper = c.hyper;
  hyper.noise = Vector::Constant(baseline.model.noise_groups, c.hyper.noise.mean());
  const EvidenceSearch search(baseline.model, hyper, all);
  double expected = 0;
  for (std::size_t j = 0; j < rivals.size(); ++j) {
    const auto [variant, size] = supposed(c, rivals[j].explanation);
    if (j >= all.list.size() || variant >= all.list[j].blocks.size()) return 0;
    const int truth = all.list[j].blocks[variant];
    const Matrix g = search.between(truth, truth);
    if (g.rows() != size.size()) return 0;
    double against = 0;
    for (std::size_t k = 0; k < rivals.size() && k < all.list.size(); ++k) {
      if (k == j) continue;
      double least = size.dot(g * size);
      for (const int b : all.list[k].blocks) {
        const Vector cross = search.between(b, truth) * size;
        const Matrix h = search.between(b, b);
        least = std::min(least, size.dot(g * size) - cross.dot(Eigen::LDLT<Matrix>(h + 1e-9 * (h.trace() + 1) * Matrix::Identity(h.rows(), h.cols())).solve(cross)));
      }
      against += rivals[k].weight * std::exp(-0.5 * std::max(0.0, least));
    }
    expected += rivals[j].weight * rivals[j].weight / (rivals[j].weight + against);
  }
  return expected;
}

}  // namespace

std::vector<NextMeasurement> next_measurements(const Case& c, const SearchResult* result, const std::vector<Detectable>& detectable) {
  const std::vector<Rival> rivals = rivals_of(c, result, detectable);
  if (rivals.size() < 2) return {};
  struct Scored {
    NextMeasurement measurement;
    double worth;
    Change change;
    std::vector<RecordedTouch> touches;
  };
  double now = 0;
  for (const Rival& r : rivals) now = std::max(now, r.weight);
  std::vector<Scored> list;
  for (const Change& change : changes_for(c)) {
    const Longer recording = longer(c, change);
    NextMeasurement m;
    m.change = change.text;
    for (const Rival& r : rivals) m.separates.push_back(c.explanations.list[r.explanation].name);
    m.expected_probability = expected_probability(c, rivals, recording);
    m.minutes = change.minutes + kSecondsPerTouch * double(recording.added.size()) / 60;
    list.push_back({std::move(m), 0, change, recording.added});
    list.back().worth = (list.back().measurement.expected_probability - now) / (5 + list.back().measurement.minutes);
  }
  std::stable_sort(list.begin(), list.end(), [](const Scored& a, const Scored& b) { return a.worth > b.worth; });
  std::vector<NextMeasurement> out;
  for (std::size_t k = 0; k < std::min(kShown, list.size()); ++k) {
    if (k == 0) list[k].measurement.program = dmis_program(c, list[k].change, list[k].touches);
    out.push_back(std::move(list[k].measurement));
  }
  return out;
}

}  // namespace abbe::diagnose
