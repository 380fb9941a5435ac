// The distribution of a sample as counts in equal bins (JCGM 101:2008, 7.5: a scaled histogram shows the
// distribution of the output quantity).
#pragma once

#include <span>
#include <vector>

namespace abbe {

struct Histogram {
  double low = 0, high = 0;  ///< ends of the first and the last bin, in the unit of the sample
  std::vector<int> counts;   ///< one a bin, at least one; their sum is the size of the sample
};

/// From the smallest to the largest value, in bins of about 2 iqr n^(-1/3) (Freedman, Diaconis 1981), at most
/// 40. One bin when all values are the same. The order of the sample, not empty, does not matter.
Histogram histogram(std::span<const double> sample);

}  // namespace abbe
