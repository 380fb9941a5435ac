#include "engine/diagnose/planning/next_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/explanations/catalogue.hpp"
#include "engine/diagnose/model/precision.hpp"
#include "engine/diagnose/planning/program.hpp"
#include "engine/diagnose/planning/question.hpp"
#include "engine/diagnose/words.hpp"

namespace abbe::diagnose {

namespace {

constexpr std::size_t kShown = 3, kPaired = 6;
/// A round of measuring and judging takes this long beside the measurement itself, min.
constexpr double kRound_min = 60;
/// Expected probability of the truth from which on a measurement counts as deciding.
constexpr double kDecides = 0.95;
/// What it must be above guessing, or the measurement is no proposal; and what a pair of changes must add, or
/// one of them is enough.
constexpr double kAboveChance = 0.05;
/// Expected probabilities are no more exact than this.
constexpr double kAlike = 0.01;
/// Signal-to-noise that a plan without data reckons with.
constexpr double kPlanned = 6;

using Seen = Precision::Seen;

/// The variants of one rival, and what it would be as the truth.
struct Contender {
  std::vector<Seen> first, both;  ///< by variant: columns on the first recording, and on both
  Seen shift_first, shift_both;   ///< as the truth
};

/// As the truth: the variant that explains the first recording best, of the size that it takes there; of a
/// plan, the one that shows best.
void suppose(const Seen& y, Contender& c) {
  const bool planned = y.rows.squaredNorm() == 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < c.first.size(); ++k) {
    const Seen& w = c.first[k];
    const Matrix g = inner(w, w);
    if (planned) {
      Eigen::Index column = 0;
      const double information = g.diagonal().maxCoeff(&column);
      if (information <= std::max(most, 0.0)) continue;
      most = information;
      const Vector size = kPlanned / std::sqrt(information) * Vector::Unit(g.cols(), column);
      c.shift_first = w * size, c.shift_both = c.both[k] * size;
      continue;
    }
    const LikeliestSize size = likeliest_size({g, inner(w, y)}, sizes_of(g.trace()));
    if (size.log_belief <= most) continue;
    most = size.log_belief;
    c.shift_first = w * size.coefficients, c.shift_both = c.both[k] * size.coefficients;
  }
}

/// The effects beside a question, as both recordings see them.
std::vector<Matrix> signatures_beside(const Case& c, const Question& question, const Longer& longer,
                                      const std::vector<int>& rows) {
  std::vector<Matrix> out;
  for (const Finding& f : question.beside) {
    const Variant& found = c.explanations.variants[f.variant];
    Variant seen = variant_like(found, *c.explanations.list[f.explanation].effect, longer.touches, rows);
    if (seen.signature.cols() > 0) out.push_back(std::move(seen.signature));
  }
  return out;
}

/// The columns of each variant, on these rows of it, as a recording sees them: all at once takes far less time.
template <class Rows>
std::vector<Seen> seen_each(const std::vector<Variant>& variants, const Rows& rows, const Precision& by) {
  Eigen::Index columns = 0, first = 0;
  for (const Variant& b : variants) columns += b.signature.cols();
  std::vector<Seen> out;
  if (variants.empty()) return out;
  Matrix all(variants.front().signature(rows, Eigen::all).rows(), columns);
  for (const Variant& b : variants) {
    all.middleCols(first, b.signature.cols()) = b.signature(rows, Eigen::all);
    first += b.signature.cols();
  }
  const Seen seen = by.seen(all);
  first = 0;
  for (const Variant& b : variants) {
    out.push_back({seen.rows.middleCols(first, b.signature.cols()), seen.taken.middleCols(first, b.signature.cols())});
    first += b.signature.cols();
  }
  return out;
}

std::vector<Contender> contenders_of(const Case& c, const Hyperparameters& fitted, const Question& question,
                                     const Longer& longer, const Precision& first) {
  std::vector<char> masked(longer.touches.touches.size(), 0);
  std::copy(c.masked.begin(), c.masked.end(), masked.begin());
  std::vector<int> rows;
  for (std::size_t i = 0; i < masked.size(); ++i)
    if (!masked[i]) rows.push_back(static_cast<int>(i));
  std::vector<Eigen::Index> of_first;  // among `rows`: what takes part in the first recording
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::binary_search(c.rows.begin(), c.rows.end(), rows[k])) of_first.push_back(static_cast<Eigen::Index>(k));
  const Baseline baseline = baseline_of(c, longer);
  const std::vector<Matrix> beside = signatures_beside(c, question, longer, rows);
  const Precision both(with_free(likelier_ensemble(c, without_rows(baseline.model, masked)), pointers_to(beside)),
                       fitted);
  std::vector<Contender> out;
  for (const int rival : question.rivals) {
    const Explanations own = named_explanations(longer.touches, rows, {c.explanations.list[rival].name});
    Contender contender{seen_each(own.variants, of_first, first), seen_each(own.variants, Eigen::all, both), {}, {}};
    suppose(first.y(), contender);
    if (contender.shift_both.rows.size() > 0) out.push_back(std::move(contender));
  }
  return out;
}

/// What the likeliest of some variants leaves of each truth, which is one column.
Vector left_of(const Seen& truths, const std::vector<Seen>& variants) {
  const Vector squares = inner(truths, truths).diagonal();
  Vector left = squares;
  for (const Seen& w : variants) left = left.cwiseMin(squares - explained(inner(w, w), inner(w, truths)));
  return left.cwiseMax(0);
}

/// The columns side by side.
Seen side_by_side(const std::vector<Contender>& list, Seen Contender::*column) {
  const auto columns = static_cast<Eigen::Index>(list.size());
  Seen out{Matrix((list.front().*column).rows.rows(), columns), Matrix((list.front().*column).taken.rows(), columns)};
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Seen& s = list[k].*column;
    out.rows.col(k) = s.rows, out.taken.col(k) = s.taken;
  }
  return out;
}

/// The probability that the truth would have, on average over the rivals as truth.
double expected_probability(const std::vector<Contender>& list) {
  // Gauss-Hermite nodes and weights of a standard normal (Abramowitz & Stegun 25.10).
  constexpr double kNodes[] = {-2.8569700, -1.3556262, 0, 1.3556262, 2.8569700},
                   kWeights[] = {0.0112574, 0.2220759, 0.5333333, 0.2220759, 0.0112574};
  if (list.empty()) return 0;
  const Seen first = side_by_side(list, &Contender::shift_first), both = side_by_side(list, &Contender::shift_both);
  Matrix gain(list.size(), list.size());  // by truth and rival: what the second recording adds
  for (std::size_t rival = 0; rival < list.size(); ++rival)
    gain.col(static_cast<Eigen::Index>(rival)) =
        (left_of(both, list[rival].both) - left_of(first, list[rival].first)).cwiseMax(0);
  double expected = 0;
  for (Eigen::Index truth = 0; truth < gain.rows(); ++truth) {
    for (int i = 0; i < 5; ++i) {
      double against = 0;
      for (Eigen::Index rival = 0; rival < gain.cols(); ++rival)
        if (rival != truth) against += std::exp(-gain(truth, rival) / 2 - std::sqrt(gain(truth, rival)) * kNodes[i]);
      expected += kWeights[i] / (1 + against) / double(list.size());
    }
  }
  return expected;
}

struct Scored {
  NextMeasurement measurement;
  double gain = 0;   ///< in probability
  double worth = 0;  ///< the same, per minute
  Change change;
  Longer longer;
};

/// Judges changes for a case.
class Judge {
 public:
  Judge(const Case& c, const Hyperparameters& hyper, const Question& question)
      : case_(c),
        hyper_(hyper),
        question_(question),
        first_(with_free(likelier_ensemble(c, c.model), signatures_of(c, question.beside)), hyper) {}

  void add(const std::vector<Change>& changes) {
    list_ = scored(changes);
    leave_out_no_better_than_a_repeat();
    rank();
  }
  const std::vector<Scored>& list() const { return list_; }

  /// Where one change does not decide: two of those that say most by themselves, if the two say more than the
  /// better one.
  void add_pairs() {
    std::vector<Scored> singles = list_;
    std::erase_if(singles, [&](const Scored& s) { return !s.change.changes_touches || s.gain < kAboveChance / 2; });
    std::stable_sort(singles.begin(), singles.end(), [](const Scored& a, const Scored& b) { return a.gain > b.gain; });
    if (singles.size() > kPaired) singles.erase(singles.begin() + kPaired, singles.end());
    std::vector<Change> pairs;
    std::vector<double> better;
    for (std::size_t b = 1; b < singles.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        pairs.push_back(joined(singles[a].change, singles[b].change)), better.push_back(singles[a].gain);
    std::vector<Scored> kept;
    for (Scored& s : scored(pairs)) {
      const auto k = static_cast<std::size_t>(
          std::find_if(pairs.begin(), pairs.end(), [&](const Change& c) { return c.text == s.change.text; }) -
          pairs.begin());
      if (s.gain > better[k] + kAboveChance) kept.push_back(std::move(s));
    }
    std::move(kept.begin(), kept.end(), std::back_inserter(list_));
    rank();
  }

 private:
  /// A change that tells no more than the same touches once more has no part in it: what tells is that they
  /// are measured twice.
  void leave_out_no_better_than_a_repeat() {
    const auto plain = [](const Scored& s) { return !s.change.changes_touches && !s.change.reversed; };
    const auto repeat = std::find_if(list_.begin(), list_.end(), plain);
    if (repeat == list_.end()) return;
    const double enough = repeat->gain + kAlike;
    std::erase_if(list_, [&](const Scored& s) { return !plain(s) && s.gain <= enough; });
  }

  std::vector<Scored> scored(const std::vector<Change>& changes) const {
    std::vector<std::optional<Scored>> each(changes.size());
    on_threads(static_cast<int>(changes.size()), case_.options.threads, [&](int k) { each[k] = judged(changes[k]); });
    std::vector<Scored> out;
    for (std::optional<Scored>& s : each)
      if (s) out.push_back(std::move(*s));
    return out;
  }

  /// By gain per minute; first those that gain at least half of what can be gained: a cheap measurement that
  /// decides nothing is only a round more.
  void rank() {
    double most = 0;
    for (const Scored& s : list_) most = std::max(most, s.gain);
    const auto key = [&](const Scored& s) { return std::pair{s.gain >= most / 2, s.worth}; };
    std::stable_sort(list_.begin(), list_.end(), [&](const Scored& a, const Scored& b) { return key(a) > key(b); });
  }

  std::optional<Scored> judged(const Change& change) const {
    constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
    std::optional<Longer> whole = repeated(case_, change, kAll);
    const std::optional<Longer> some = whole ? repeated(case_, change) : std::nullopt;
    if (!whole || !some) return std::nullopt;
    NextMeasurement m;
    m.change = change.text;
    const std::string before = change.instruction.empty() ? "" : change.instruction + ". ";
    m.instruction = capitalised(before + recording_sentence(*whole));
    for (const int k : question_.rivals) m.separates.push_back(case_.explanations.list[k].name);
    m.expected_probability = expected_probability(contenders_of(case_, hyper_, question_, *some, first_));
    m.minutes = change.minutes + minutes_of(*whole);
    const double gain = m.expected_probability - 1 / double(question_.rivals.size()),
                 worth = gain / (kRound_min + m.minutes);
    return Scored{std::move(m), gain, worth, change, std::move(*whole)};
  }

  const Case& case_;
  const Hyperparameters& hyper_;
  const Question& question_;
  Precision first_;
  std::vector<Scored> list_;  ///< the best first
};

/// The best changes for a question, the first as a program.
std::vector<NextMeasurement> best_changes(const Case& c, const Hyperparameters& hyper, const Question& question,
                                          std::size_t most) {
  if (question.rivals.size() < 2) return {};
  Judge judge(c, hyper, question);
  judge.add(changes_for(c));
  if (!judge.list().empty() && judge.list().front().measurement.expected_probability < kDecides) judge.add_pairs();
  std::vector<NextMeasurement> out;
  for (std::size_t k = 0; k < std::min(most, judge.list().size()); ++k) {
    const Scored& s = judge.list()[k];
    if (s.gain < kAboveChance) break;
    out.push_back(s.measurement);
    if (k == 0) out.back().program = dmis_program(c, s.longer, s.change);
  }
  return out;
}

}  // namespace

std::vector<NextMeasurement> next_measurements(const Case& c, const SearchResult* result,
                                               const std::vector<Detectable>& detectable) {
  if (result) return best_changes(c, result->hyper_of_likelier, question_of(*result), kShown);
  std::vector<NextMeasurement> out;
  for (const Question& question : questions_of(c, detectable, kShown))
    for (NextMeasurement& best : best_changes(c, c.hyper, question, 1)) {
      if (!out.empty()) best.program.clear();  // one program at a time: the first
      out.push_back(std::move(best));
    }
  return out;
}

}  // namespace abbe::diagnose
