// Second-order automatic differentiation: a number that carries its gradient and Hessian with respect to N unknowns.
// For where the exact Hessian is wanted (Newton steps with large residuals) and as an independent check of
// derivatives written by hand. Forward mode, truncated Taylor arithmetic (Griewank, Walther: Evaluating
// Derivatives, ch. 13).
#pragma once

#include <cmath>

namespace abbe {

template <class Real, int N>
struct Jet {
  Real value = 0;
  Real gradient[N] = {};
  Real hessian[N][N] = {};  ///< lower triangle, j <= i

  Jet() = default;
  Jet(Real constant) : value(constant) {}  // NOLINT: constants mix with jets as they do on paper
  static Jet unknown(Real value, int index) {
    Jet j(value);
    j.gradient[index] = 1;
    return j;
  }
};

/// f(a) from f, f', f'' at a.value.
template <class Real, int N>
Jet<Real, N> chain(const Jet<Real, N>& a, Real f, Real f1, Real f2) {
  Jet<Real, N> r(f);
  for (int i = 0; i < N; ++i) {
    r.gradient[i] = f1 * a.gradient[i];
    for (int j = 0; j <= i; ++j) r.hessian[i][j] = f1 * a.hessian[i][j] + f2 * a.gradient[i] * a.gradient[j];
  }
  return r;
}

template <class Real, int N>
Jet<Real, N> operator+(Jet<Real, N> a, const Jet<Real, N>& b) {
  a.value += b.value;
  for (int i = 0; i < N; ++i) {
    a.gradient[i] += b.gradient[i];
    for (int j = 0; j <= i; ++j) a.hessian[i][j] += b.hessian[i][j];
  }
  return a;
}

template <class Real, int N>
Jet<Real, N> operator-(Jet<Real, N> a, const Jet<Real, N>& b) {
  a.value -= b.value;
  for (int i = 0; i < N; ++i) {
    a.gradient[i] -= b.gradient[i];
    for (int j = 0; j <= i; ++j) a.hessian[i][j] -= b.hessian[i][j];
  }
  return a;
}

template <class Real, int N>
Jet<Real, N> operator*(const Jet<Real, N>& a, const Jet<Real, N>& b) {
  Jet<Real, N> r(a.value * b.value);
  for (int i = 0; i < N; ++i) {
    r.gradient[i] = a.value * b.gradient[i] + b.value * a.gradient[i];
    for (int j = 0; j <= i; ++j)
      r.hessian[i][j] = a.value * b.hessian[i][j] + b.value * a.hessian[i][j] + a.gradient[i] * b.gradient[j] +
          b.gradient[i] * a.gradient[j];
  }
  return r;
}

template <class Real, int N>
Jet<Real, N> sqrt(const Jet<Real, N>& a) {
  const Real root = std::sqrt(a.value);
  return chain(a, root, 1 / (2 * root), -1 / (4 * root * a.value));
}

template <class Real, int N>
Jet<Real, N> reciprocal(const Jet<Real, N>& a) {
  const Real r = 1 / a.value;
  return chain(a, r, -r * r, 2 * r * r * r);
}

template <class Real, int N>
Jet<Real, N> sin(const Jet<Real, N>& a) {
  return chain(a, std::sin(a.value), std::cos(a.value), -std::sin(a.value));
}

template <class Real, int N>
Jet<Real, N> cos(const Jet<Real, N>& a) {
  return chain(a, std::cos(a.value), -std::sin(a.value), -std::cos(a.value));
}

}  // namespace abbe
