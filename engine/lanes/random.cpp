#include "engine/lanes/random.hpp"

#include "engine/lanes/for_lanes.hpp"
#include "engine/lanes/normal_quantile.hpp"

namespace abbe {

double normal_quantile(double p) { return normal_quantile_inline(p); }

void normal_pairs(int n, std::uint64_t seed, const std::uint32_t* machine, std::uint32_t stream, std::uint32_t site,
                  const std::uint32_t* visit, std::uint32_t draw, double* first, double* second) {
  for_lanes(n, [=](int i) {
    const UniformPair u = uniform_pair({seed, machine[i], stream, site, visit[i], draw});
    first[i] = normal_quantile_inline(u.a);
    second[i] = normal_quantile_inline(u.b);
  });
}

}  // namespace abbe
