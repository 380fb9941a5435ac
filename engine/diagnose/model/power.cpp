#include "engine/diagnose/model/power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

namespace {

constexpr int kForAlarm = 100, kTogether = EvidenceSearch::kTogether, kWithShift = 12;
static_assert(kForAlarm % kTogether == 0);

/// The value that a share of a law exceeds whose upper fifth is exponential.
double exceeded_by(double share, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t tail = values.size() / 5;
  const double from = values[values.size() - tail - 1];
  double mean = 0;
  for (std::size_t k = values.size() - tail; k < values.size(); ++k) mean += (values[k] - from) / double(tail);
  return from + mean * std::log(double(tail) / double(values.size()) / share);
}

}  // namespace

Power::Power(const EvidenceSearch& of, const EvidenceSearch& machines, std::uint64_t seed, int threads)
    : search_(of), seed_(seed) {
  const auto in_order = [&](int first, int count) {
    Matrix recordings(of.rows(), count);
    for (int k = 0; k < count; ++k) recordings.col(k) = machines.in_order(seed, first + k);
    return of.seen(recordings);
  };
  std::vector<double> statistics(kForAlarm);
  on_threads(kForAlarm / kTogether, threads, [&](int group) {
    const std::vector<Evidence> judged = of.judge(in_order(group * kTogether, kTogether));
    for (int k = 0; k < kTogether; ++k) statistics[group * kTogether + k] = judged[k].statistic;
  });
  in_order_ = in_order(0, kWithShift);
  alarm_ = exceeded_by(kAlarm, std::move(statistics));
}

double Power::detected_from(const Matrix& shift, int explanation, double share, double most) const {
  constexpr double kLeast = 0.5;
  constexpr int kHalvings = 7;
  Matrix shifts = shift;
  if (shift.cols() > 1) {
    shifts.resize(shift.rows(), kWithShift);
    for (int k = 0; k < kWithShift; ++k)
      shifts.col(k) = shift * standard_normal(shift.cols(), seed_, stream_of("diagnose.power"), k);
  }
  const std::vector<Ensemble::Seen> there = search_.seen(shifts);
  const double from = alarm_ + std::log(share);
  const auto log_beliefs = [&](const Vector& times) {
    return search_.log_beliefs(in_order_, there, times, explanation);
  };
  Vector low = Vector::Constant(kWithShift, kLeast), high = Vector::Constant(kWithShift, most);
  if ((log_beliefs(high).array() <= from).any()) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < kHalvings; ++i) {
    const Vector middle = (low.array() * high.array()).sqrt(), belief = log_beliefs(middle);
    for (int k = 0; k < kWithShift; ++k) (belief(k) > from ? high : low)(k) = middle(k);
  }
  const double mean = high.mean();
  return mean + kPowerDeviations * std::sqrt((high.array() - mean).square().sum() / (kWithShift - 1));
}

}  // namespace abbe::diagnose
