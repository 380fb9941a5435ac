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

Power::Power(const EvidenceSearch& of, std::uint64_t seed, int threads) : search_(of), seed_(seed) {
  std::vector<double> statistics(kForAlarm);
  in_order_.resize(kWithShift);
  on_threads(kForAlarm / kTogether, threads, [&](int group) {
    Matrix recordings(of.rows(), kTogether);
    for (int k = 0; k < kTogether; ++k) recordings.col(k) = of.in_order(seed, group * kTogether + k);
    auto seen = of.seen_of_each(recordings);
    for (std::size_t k = 0; k < kTogether; ++k) {
      const std::size_t at = static_cast<std::size_t>(group) * kTogether + k;
      statistics[at] = of.statistic_of(seen[k]);
      if (at < kWithShift) in_order_[at] = std::move(seen[k]);
    }
  });
  alarm_ = exceeded_by(kAlarm, std::move(statistics));
}

double Power::detected_from(const Matrix& shift, int explanation, double share, double most) const {
  constexpr double kLeast = 0.5;
  constexpr int kHalvings = 7;
  const bool drawn = shift.cols() > 1;
  Matrix shifts = shift;
  if (drawn) {
    shifts.resize(shift.rows(), kWithShift);
    for (int k = 0; k < kWithShift; ++k)
      shifts.col(k) = shift * standard_normal(shift.cols(), seed_, stream_of("diagnose.power"), k);
  }
  const auto all_there = search_.seen_of_each(shifts);
  double sum = 0, squares = 0;
  for (int k = 0; k < kWithShift; ++k) {
    const std::vector<Ensemble::Seen>& there = all_there[drawn ? static_cast<std::size_t>(k) : 0];
    const auto is_seen = [&](double times) {
      return search_.log_belief(in_order_[k], there, times, explanation) - std::log(share) > alarm_;
    };
    if (!is_seen(most)) return std::numeric_limits<double>::infinity();
    double low = kLeast, high = most;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = std::sqrt(low * high);
      (is_seen(middle) ? high : low) = middle;
    }
    sum += high, squares += high * high;
  }
  const double n = kWithShift, mean = sum / n;
  return mean + kPower * std::sqrt(std::max(0.0, squares - n * mean * mean) / (n - 1));
}

}  // namespace abbe::diagnose
