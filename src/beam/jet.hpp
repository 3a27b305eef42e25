// Second-order forward differentiation: a value with its gradient and Hessian in N variables.
// Only what the beam element needs.
#pragma once

#include <Eigen/Core>

namespace brainshift {

template <int N>
struct Jet {
  using Gradient = Eigen::Matrix<double, N, 1>;
  using Hessian = Eigen::Matrix<double, N, N>;

  double v = 0.0;
  Gradient g = Gradient::Zero();
  Hessian h = Hessian::Zero();

  Jet() = default;
  Jet(double value) : v(value) {}  // NOLINT: constants mix freely with jets
  static Jet variable(double value, int k) {
    Jet jet(value);
    jet.g[k] = 1.0;
    return jet;
  }

  Jet& operator+=(const Jet& b) {
    v += b.v, g += b.g, h += b.h;
    return *this;
  }
  Jet& operator-=(const Jet& b) {
    v -= b.v, g -= b.g, h -= b.h;
    return *this;
  }
  Jet& operator*=(double b) {
    v *= b, g *= b, h *= b;
    return *this;
  }
};

template <int N>
Jet<N> operator+(Jet<N> a, const Jet<N>& b) {
  return a += b;
}
template <int N>
Jet<N> operator-(Jet<N> a, const Jet<N>& b) {
  return a -= b;
}
template <int N>
Jet<N> operator+(Jet<N> a, double b) {
  a.v += b;
  return a;
}
template <int N>
Jet<N> operator-(const Jet<N>& a, double b) {
  return a + -b;
}
template <int N>
Jet<N> operator*(Jet<N> a, double b) {
  return a *= b;
}
template <int N>
Jet<N> operator*(double b, Jet<N> a) {
  return a *= b;
}
template <int N>
Jet<N> operator*(const Jet<N>& a, const Jet<N>& b) {
  Jet<N> c;
  c.v = a.v * b.v;
  c.g = a.v * b.g + b.v * a.g;
  for (int j = 0; j < N; ++j) {
    c.h.col(j) = a.v * b.h.col(j) + b.v * a.h.col(j) + b.g[j] * a.g + a.g[j] * b.g;
  }
  return c;
}

// f(a), from the value and the two derivatives of f there.
template <int N>
Jet<N> chain(const Jet<N>& a, double f, double df, double ddf) {
  Jet<N> c;
  c.v = f;
  c.g = df * a.g;
  c.h = df * a.h;
  const typename Jet<N>::Gradient scaled = ddf * a.g;
  c.h.noalias() += scaled * a.g.transpose();
  return c;
}
inline double chain(double, double f, double, double) { return f; }

inline double value(double a) { return a; }
template <int N>
double value(const Jet<N>& a) {
  return a.v;
}

template <class T>
T reciprocal(const T& a) {
  const double f = 1.0 / value(a);
  return chain(a, f, -f * f, 2.0 * f * f * f);
}

}  // namespace brainshift
