#include "engine/stats/histogram.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/ids.hpp"

namespace abbe {

Histogram histogram(std::span<const double> sample) {
  constexpr double kMostBins = 40;
  ABBE_CHECK(!sample.empty());
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = sorted.size();
  Histogram out{sorted.front(), sorted.back(), {}};
  const double extent = out.high - out.low, width = 2 * (sorted[3 * n / 4] - sorted[n / 4]) / std::cbrt(double(n));
  const double bins = !(extent > 0) ? 1 : width > 0 ? std::clamp(std::ceil(extent / width), 1.0, kMostBins) : kMostBins;
  out.counts.assign(static_cast<std::size_t>(bins), 0);
  for (const double v : sorted)
    ++out.counts[extent > 0 ? std::min(static_cast<std::size_t>(bins * ((v - out.low) / extent)), out.counts.size() - 1)
                            : 0];
  return out;
}

}  // namespace abbe
