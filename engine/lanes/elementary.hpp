// Elementary functions for lane kernels: branch-free, of exactly rounded operations only (+ - * /
// sqrt and bit operations), so that they vectorise and give the same bits on every machine and with
// every C library. libm gives neither.
//
// Angles come in half turns: sin_pi(u) = sin(pi u). The reduction to [-1/4, 1/4] is then exact,
// which it is not in radians. The polynomials: Taylor for sine and cosine (|x| <= pi/4; remainder
// below 1e-18), and for the logarithm the minimax polynomial of fdlibm's e_log.c (Sun Microsystems,
// 1993). Errors: below 2 units in the last place.
#pragma once

#include <bit>
#include <cstdint>

namespace abbe {

/// a0 + a1 x + a2 x^2 + ... by Horner's rule.
template <class... Rest>
[[gnu::always_inline]] constexpr double polynomial(double x, double a0, Rest... rest) {
  if constexpr (sizeof...(rest) == 0)
    return a0;
  else
    return a0 + x * polynomial(x, rest...);
}

/// The natural logarithm of a positive normal number.
[[gnu::always_inline]] inline double log_positive(double x) {
  // x = m 2^k with m in [sqrt(1/2), sqrt(2)): adding the distance from sqrt(1/2) to 1 carries into
  // the exponent where needed.
  constexpr std::uint64_t kOne = 0x3FF0000000000000u, kRootHalf = 0x3FE6A09E667F3BCDu;
  const std::uint64_t shifted = std::bit_cast<std::uint64_t>(x) + (kOne - kRootHalf);
  const double m = std::bit_cast<double>((shifted & 0x000FFFFFFFFFFFFFu) + kRootHalf);
  // The exponent as a double without an integer conversion (AVX2 has none): write it into the
  // mantissa of 2^52.
  const double k = std::bit_cast<double>((shifted >> 52) | 0x4330000000000000u) - (0x1p52 + 1023);
  const double f = m - 1, s = f / (2 + f), z = s * s, half_f2 = 0.5 * f * f;
  const double tail = z *
      polynomial(z, 6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
                 2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
                 1.479819860511658591e-01);
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  return k * kLn2High - ((half_f2 - (s * (half_f2 + tail) + k * kLn2Low)) - f);
}

/// e to the power x, for |x| < 700.
[[gnu::always_inline]] inline double exp_bounded(double x) {
  // x = k ln 2 + r with |r| <= ln 2 / 2; ln 2 in two parts, so that k ln 2 is exact. The Taylor
  // polynomial of degree 13 leaves less than 5e-18.
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  constexpr double kLog2e = 1.44269504088896338700, kRound = 0x1.8p52;
  const double rounded = x * kLog2e + kRound, k = rounded - kRound;
  const double r = (x - k * kLn2High) - k * kLn2Low;
  const double e_r = polynomial(r, 1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320,
                                1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600.0, 1.0 / 6227020800.0);
  // The low bits of `rounded` hold k; 2^k is written into the exponent.
  const std::uint64_t power = (std::bit_cast<std::uint64_t>(rounded) + 1023) << 52;
  return e_r * std::bit_cast<double>(power);
}

struct SinCos {
  double sin, cos;
};

/// sin(pi u) and cos(pi u) for |u| < 2^50.
[[gnu::always_inline]] inline SinCos sin_cos_pi(double u) {
  // Adding 1.5 * 2^52 rounds 2u to the nearest integer and leaves that integer in the low bits: the
  // quadrant.
  constexpr double kRound = 0x1.8p52;
  const double rounded = 2 * u + kRound;
  const std::uint64_t quadrant = std::bit_cast<std::uint64_t>(rounded);
  const double x = 3.14159265358979323846 * (u - 0.5 * (rounded - kRound)), z = x * x;
  const double s = x *
      polynomial(z, 1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800.0,
                 -1.0 / 1307674368000.0, 1.0 / 355687428096000.0);
  const double c = polynomial(z, 1.0, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600.0,
                              -1.0 / 87178291200.0, 1.0 / 20922789888000.0);
  // Odd quadrants swap the two; quadrants 2, 3 turn the sign of the sine, 1, 2 that of the cosine.
  // On bits: no branch.
  const std::uint64_t swap = 0 - (quadrant & 1);
  const std::uint64_t s_bits = std::bit_cast<std::uint64_t>(s), c_bits = std::bit_cast<std::uint64_t>(c);
  const std::uint64_t difference = (s_bits ^ c_bits) & swap;
  const std::uint64_t sin_sign = (quadrant & 2) << 62, cos_sign = ((quadrant + 1) & 2) << 62;
  return {std::bit_cast<double>(s_bits ^ difference ^ sin_sign), std::bit_cast<double>(c_bits ^ difference ^ cos_sign)};
}

}  // namespace abbe
