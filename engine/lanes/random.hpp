// Random numbers without state: Philox4x32-10 (Salmon et al., SC'11) addressed by (seed, machine, effect, site, visit,
// draw). So a number depends on nothing but its own address: not on threads, blocks, the order of work, or on
// which other effects exist. Integer and exactly rounded operations only: the same bits on every machine.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace abbe {

struct Philox4 {
  std::uint32_t v[4];
};

constexpr Philox4 philox4x32(std::uint32_t c0, std::uint32_t c1, std::uint32_t c2, std::uint32_t c3, std::uint32_t k0,
                             std::uint32_t k1) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * c0;
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57u} * c2;
    const auto hi0 = static_cast<std::uint32_t>(p0 >> 32), lo0 = static_cast<std::uint32_t>(p0);
    const auto hi1 = static_cast<std::uint32_t>(p1 >> 32), lo1 = static_cast<std::uint32_t>(p1);
    c0 = hi1 ^ c1 ^ k0;
    c1 = lo1;
    c2 = hi0 ^ c3 ^ k1;
    c3 = lo0;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return {{c0, c1, c2, c3}};
}

/// FNV-1a hash of an effect's name: its own stream of numbers, whatever else exists.
constexpr std::uint32_t stream_of(std::string_view effect) {
  std::uint32_t h = 2166136261u;
  for (const char c : effect) h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
  return h;
}

/// `draw` has so many bits of an address, `visit` the others of its word.
inline constexpr int kDrawBits = 12;
inline constexpr std::uint64_t kMostVisits = std::uint64_t{1} << (32 - kDrawBits);

/// The address of a pair of random numbers. `site`: the place in the program (index of the operation), 0 for
/// what is drawn once per machine; `visit`: how often this machine has been there (below kMostVisits);
/// `draw`: which pair of that visit.
struct RandomAddress {
  std::uint64_t seed = 1;
  std::uint32_t machine = 0;
  std::uint32_t stream = 0;
  std::uint32_t site = 0;
  std::uint32_t visit = 0;
  std::uint32_t draw = 0;
};

constexpr Philox4 random_bits(const RandomAddress& a) {
  return philox4x32(a.machine, a.stream, a.site, (a.visit << kDrawBits) | a.draw, static_cast<std::uint32_t>(a.seed),
                    static_cast<std::uint32_t>(a.seed >> 32));
}

/// 52 random bits as a double in (0, 1): never 0, never 1, symmetric about 1/2.
constexpr double uniform_from_bits(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 12;
  return std::bit_cast<double>(bits | 0x3FF0000000000000u) - (1.0 - 0x1p-53);
}

/// A seed of its own for the k-th of what has one in common; that of the first. Odd steps of the whole range: those of
/// neighbouring seeds do not meet.
constexpr std::uint64_t seed_of(std::uint64_t seed, std::uint64_t k) { return seed + 0x9E3779B97F4A7C15u * k; }

struct UniformPair {
  double a, b;
};
constexpr UniformPair uniform_pair(const RandomAddress& address) {
  const Philox4 r = random_bits(address);
  return {uniform_from_bits(r.v[0], r.v[1]), uniform_from_bits(r.v[2], r.v[3])};
}

/// The standard normal quantile of p in (0, 1): algorithm AS 241 (Wichura 1988), branch-free, relative error
/// below 1e-15.
double normal_quantile(double p);

/// n pairs of standard normal numbers for n machines at one (stream, site, draw): the kernel of per-touch noise.
/// visit[i] belongs to machine[i].
void normal_pairs(int n, std::uint64_t seed, const std::uint32_t* machine, std::uint32_t stream, std::uint32_t site,
                  const std::uint32_t* visit, std::uint32_t draw, double* first, double* second);

}  // namespace abbe
