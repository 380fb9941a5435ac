#include "engine/diagnose/next_measurement.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace abbe::diagnose {

namespace {

constexpr std::size_t kShown = 3, kMostRivals = 8;
/// A round of measuring and judging takes this long beside the measurement itself, min.
constexpr double kRound_min = 60;
/// Expected probability of the truth from which on a measurement counts as deciding.
constexpr double kDecides = 0.95;
/// What it must be above chance, or the measurement is not worth a proposal.
constexpr double kAboveChance = 0.05;
/// Signal-to-noise that a plan without data reckons with.
constexpr double kPlanned = 6;

/// The effect that a plan confounds with most others, and these.
std::vector<int> confounded(const Case& c, const std::vector<Detectable>& detectable) {
  const auto most = std::max_element(detectable.begin(), detectable.end(),
                                     [](const Detectable& a, const Detectable& b) { return a.confounded_with.size() < b.confounded_with.size(); });
  std::vector<int> list;
  if (most == detectable.end()) return list;
  std::vector<std::string> names = most->confounded_with;
  names.push_back(most->effect);
  for (std::size_t k = 0; k < c.explanations.list.size(); ++k)
    if (std::find(names.begin(), names.end(), c.explanations.list[k].name) != names.end()) list.push_back(static_cast<int>(k));
  return list;
}

/// Those of the first finding that could not be told apart; without data, those that the plan could not tell apart.
std::vector<int> rivals_of(const Case& c, const SearchResult* result, const std::vector<Detectable>& detectable) {
  std::vector<int> list;
  if (!result) list = confounded(c, detectable);
  for (std::size_t i = 0; result && list.empty() && i < result->findings.size(); ++i) {
    const Finding& f = result->findings[i];
    if (f.set.size() < 2) continue;
    list.assign(f.set.begin(), f.set.begin() + static_cast<std::ptrdiff_t>(std::min(f.set.size(), kMostRivals)));
  }
  return list;
}

/// Rows in the metric of a model: inner products are those of its precision, what is free projected out.
class Metric {
 public:
  Metric(const LinearModel& model, const Hyperparameters& h) : rotated_(model, h) {}

  Matrix operator()(const Matrix& columns) const { return of_projected(rotated_.project(columns)); }
  Vector y() const { return of_projected(rotated_.y()); }

 private:
  Matrix of_projected(const Matrix& m) const {
    const Matrix a = rotated_.coordinates(m), rest = rotated_.remainder(m, a);
    Matrix out(a.rows() + rest.rows(), m.cols());
    out << ((1 + rotated_.lambda().array()).rsqrt().matrix().asDiagonal() * a), rest;
    return out;
  }

  Rotated rotated_;
};

/// What columns cannot imitate of a vector.
double left_of(const Vector& s, const Matrix& columns) {
  constexpr double kRidge = 1e-9;
  const Matrix g = columns.transpose() * columns;
  const Vector cross = columns.transpose() * s;
  const double shared = cross.dot(Eigen::LDLT<Matrix>(g + kRidge * (g.trace() + 1) * Matrix::Identity(g.rows(), g.cols())).solve(cross));
  return std::max(0.0, s.squaredNorm() - shared);
}

/// The variants of one rival, and what it would be as the truth.
struct Contender {
  std::vector<Matrix> first, both;         ///< by variant: columns on the first recording, and on both
  Vector shift_first, shift_both;          ///< as the truth
};

/// As the truth: the variant that explains the first recording best, of the size that it takes there; of a plan, the one that shows best.
void suppose(const Vector& y, Contender& c) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < c.first.size(); ++k) {
    const Matrix& w = c.first[k];
    const Matrix g = w.transpose() * w;
    if (y.squaredNorm() == 0) {
      Eigen::Index column = 0;
      const double information = g.diagonal().maxCoeff(&column);
      if (information <= std::max(most, 0.0)) continue;
      most = information;
      c.shift_first = kPlanned / std::sqrt(information) * w.col(column), c.shift_both = kPlanned / std::sqrt(information) * c.both[k].col(column);
      continue;
    }
    for (const Size& size : sizes_of(g.trace())) {
      const double s2 = size.factor * size.factor;
      const Matrix posterior = g + Matrix::Identity(g.rows(), g.cols()) / s2;
      const Eigen::LLT<Matrix> llt(posterior);
      const Vector u = w.transpose() * y, theta = llt.solve(u);
      const double log_bayes = size.log_prior + 0.5 * u.dot(theta) - 0.5 * double(g.rows()) * std::log(s2) - Matrix(llt.matrixL()).diagonal().array().log().sum();
      if (log_bayes <= most) continue;
      most = log_bayes;
      c.shift_first = w * theta, c.shift_both = c.both[k] * theta;
    }
  }
}

std::vector<Contender> contenders_of(const Case& c, const std::vector<int>& rivals, const Longer& longer, const Metric& first) {
  std::vector<char> masked(longer.touches.touches.size(), 0);
  std::copy(c.masked.begin(), c.masked.end(), masked.begin());
  std::vector<int> rows;
  for (std::size_t i = 0; i < masked.size(); ++i)
    if (!masked[i]) rows.push_back(static_cast<int>(i));
  const Baseline baseline = baseline_of(c, longer);
  Hyperparameters hyper = c.hyper;
  hyper.noise = Vector::Constant(baseline.model.noise_groups, c.hyper.noise.mean());
  const LinearModel model = without_rows(baseline.model, masked);
  const Metric both(c.rough && model.rough.cols() > 0 ? rougher(model) : model, hyper);
  std::vector<Contender> out;
  for (const int rival : rivals) {
    const Explanations own = named_explanations(longer.touches, rows, {c.explanations.list[static_cast<std::size_t>(rival)].name});
    Contender contender;
    for (const Block& b : own.blocks) {
      contender.first.push_back(first(b.signature.topRows(static_cast<Eigen::Index>(c.rows.size()))));
      contender.both.push_back(both(b.signature));
    }
    suppose(first.y(), contender);
    if (contender.shift_both.size() > 0) out.push_back(std::move(contender));
  }
  return out;
}

/// The probability that the truth would have, on average over the rivals as truth.
double expected_probability(const std::vector<Contender>& list) {
  // Gauss-Hermite nodes and weights of a standard normal (Abramowitz & Stegun 25.10).
  constexpr double kNodes[] = {-2.8569700, -1.3556262, 0, 1.3556262, 2.8569700}, kWeights[] = {0.0112574, 0.2220759, 0.5333333, 0.2220759, 0.0112574};
  double expected = 0;
  for (const Contender& truth : list) {
    std::vector<double> gains;   // what the second recording adds against each rival
    for (const Contender& rival : list) {
      if (&rival == &truth) continue;
      double before = std::numeric_limits<double>::infinity(), after = before;
      for (const Matrix& w : rival.first) before = std::min(before, left_of(truth.shift_first, w));
      for (const Matrix& w : rival.both) after = std::min(after, left_of(truth.shift_both, w));
      gains.push_back(std::max(0.0, after - before));
    }
    for (int i = 0; i < 5; ++i) {
      double against = 0;
      for (const double gain : gains) against += std::exp(-gain / 2 - std::sqrt(gain) * kNodes[i]);
      expected += kWeights[i] / (1 + against) / double(list.size());
    }
  }
  return expected;
}

/// Both changes at once.
Change joined(const Change& a, const Change& b) {
  constexpr std::string_view kRepeat = "repeat ";
  const auto both = [](const std::string& x, const std::string& y, std::string_view between) { return x.empty() || y.empty() ? x + y : x + std::string(between) + y; };
  return {.text = a.text + " and " + b.text.substr(kRepeat.size()), .instruction = both(a.instruction, b.instruction, "; "),
          .statement = both(a.statement, b.statement, "\n"), .minutes = a.minutes + b.minutes,
          .apply = [a, b](RecordingRow& row, Machine& machine) { a.apply(row, machine), b.apply(row, machine); }, .reversed = a.reversed || b.reversed};
}

struct Scored {
  NextMeasurement measurement;
  double worth = 0;                        ///< gain in probability per minute
  Change change;
  Longer longer;
};

/// Judges changes for a case.
class Judge {
 public:
  Judge(const Case& c, const std::vector<int>& rivals) : case_(c), rivals_(rivals), first_(c.rough && c.model.rough.cols() > 0 ? rougher(c.model) : c.model, c.hyper) {}

  void add(const Change& change) {
    std::optional<Longer> longer = repeated(case_, change);
    if (!longer) return;
    NextMeasurement m;
    m.change = change.text;
    for (const int k : rivals_) m.separates.push_back(case_.explanations.list[static_cast<std::size_t>(k)].name);
    m.expected_probability = expected_probability(contenders_of(case_, rivals_, *longer, first_));
    m.minutes = change.minutes + minutes_of(*longer);
    const double worth = (m.expected_probability - 1 / double(rivals_.size())) / (kRound_min + m.minutes);
    list_.push_back({std::move(m), worth, change, std::move(*longer)});
    std::stable_sort(list_.begin(), list_.end(), [](const Scored& a, const Scored& b) { return a.worth > b.worth; });
  }
  const std::vector<Scored>& list() const { return list_; }

 private:
  const Case& case_;
  const std::vector<int>& rivals_;
  Metric first_;
  std::vector<Scored> list_;               ///< the best first
};

}  // namespace

std::vector<NextMeasurement> next_measurements(const Case& c, const SearchResult* result, const std::vector<Detectable>& detectable) {
  const std::vector<int> rivals = rivals_of(c, result, detectable);
  if (rivals.size() < 2) return {};
  Judge judge(c, rivals);
  const std::vector<Change> menu = changes_for(c);
  for (const Change& change : menu) judge.add(change);
  // Where one change does not decide, the best one together with each of the others.
  if (!judge.list().empty() && judge.list().front().measurement.expected_probability < kDecides) {
    const Change best = judge.list().front().change;
    for (const Change& change : menu)
      if (change.changes_touches && best.changes_touches && change.text != best.text) judge.add(joined(best, change));
  }
  std::vector<NextMeasurement> out;
  for (std::size_t k = 0; k < std::min(kShown, judge.list().size()); ++k) {
    const Scored& s = judge.list()[k];
    if (s.measurement.expected_probability < 1 / double(rivals.size()) + kAboveChance) break;
    out.push_back(s.measurement);
    if (k == 0) out.back().program = dmis_program(s.longer, s.change);
  }
  return out;
}

std::string otherwise(const Case& c, const SearchResult& result, const std::vector<NextMeasurement>& next) {
  const std::vector<int> rivals = next.empty() ? rivals_of(c, &result, {}) : std::vector<int>{};
  if (rivals.size() < 2) return "";
  std::string out = "No other run of these touches would tell them apart. What would:";
  for (const int k : rivals) {
    const Explanation& e = c.explanations.list[static_cast<std::size_t>(k)];
    out += fmt::format(" {}: {}.", e.name, e.effect->separate);
  }
  return out;
}

}  // namespace abbe::diagnose
