#include "engine/diagnose/model/power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/on_threads.hpp"
#include "engine/diagnose/levels.hpp"
#include "engine/lanes/random.hpp"

namespace abbe::diagnose {

namespace {

/// Recordings to which a shift is added, of all: they tell its size as well as these the alarm, which is far out in a tail.
constexpr int kOneIn = 8;

/// The value that a share of a law exceeds whose upper tenth is exponential.
double exceeded_by(double share, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t tail = values.size() / 10;
  const double from = values[values.size() - tail - 1];
  double mean = 0;
  for (std::size_t k = values.size() - tail; k < values.size(); ++k) mean += (values[k] - from) / double(tail);
  return from + mean * std::log(double(tail) / double(values.size()) / share);
}

}  // namespace

Power::Power(const EvidenceSearch& of, LargerErrors larger, const EvidenceSearch& machines, int recordings,
             std::uint64_t seed, int threads)
    : recordings_(recordings),
      seed_(seed),
      alarm_(alarm_of(of, 1, machines, threads)),
      alarm_of_larger_(alarm_of(larger.search, larger.times, machines, threads)),
      larger_(larger) {
  Matrix in_order(of.rows(), recordings / kOneIn);
  for (int k = 0; k < in_order.cols(); ++k) in_order.col(k) = machines.in_order(1, seed, k);
  in_order_ = larger.search.seen(in_order);
  log_scales_ = larger.search.log_scales(in_order_, in_order_, Vector::Zero(in_order.cols()));
}

double Power::alarm_of(const EvidenceSearch& search, double times, const EvidenceSearch& machines, int threads) const {
  std::vector<double> statistics(static_cast<std::size_t>(recordings_));
  constexpr int kAtOnce = EvidenceSearch::kAtOnce;
  on_threads(recordings_ / kAtOnce, threads, [&](int group) {
    Matrix recordings(search.rows(), kAtOnce);
    for (int k = 0; k < kAtOnce; ++k) recordings.col(k) = machines.in_order(times, seed_, group * kAtOnce + k);
    const std::vector<Evidence> judged = search.judge(search.seen(recordings));
    for (int k = 0; k < kAtOnce; ++k) statistics[group * kAtOnce + k] = judged[k].statistic;
  });
  return exceeded_by(kAlarm, std::move(statistics));
}

double Power::detected_from(const Matrix& shift, int explanation, double share, double most) const {
  constexpr double kLeast = 0.5;
  constexpr int kHalvings = 7;
  const Eigen::Index count = log_scales_.size();
  Matrix shifts = shift;
  if (shift.cols() > 1) {
    shifts.resize(shift.rows(), count);
    for (int k = 0; k < count; ++k)
      shifts.col(k) = shift * standard_normal(shift.cols(), seed_, stream_of("diagnose.power"), k);
  }
  const EvidenceSearch& search = larger_.search;  // whatever size the errors then seem to have, it reckons with
  const std::vector<Ensemble::Seen> there = search.seen(shifts);
  const auto above_alarm = [&](const Vector& times) -> Vector {
    const Vector larger = (search.log_scales(in_order_, there, times) - log_scales_) / std::log(larger_.times);
    const Vector alarm = (alarm_ + (alarm_of_larger_ - alarm_) * larger.array()).cwiseMax(alarm_);
    return search.log_beliefs(in_order_, there, times, explanation).array() - alarm.array() - std::log(share);
  };
  Vector low = Vector::Constant(count, kLeast), high = Vector::Constant(count, most);
  if ((above_alarm(high).array() <= 0).any()) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < kHalvings; ++i) {
    const Vector middle = (low.array() * high.array()).sqrt(), above = above_alarm(middle);
    for (Eigen::Index k = 0; k < count; ++k) (above(k) > 0 ? high : low)(k) = middle(k);
  }
  const double mean = high.mean();
  return mean + kPowerDeviations * std::sqrt((high.array() - mean).square().sum() / double(count - 1));
}

}  // namespace abbe::diagnose
