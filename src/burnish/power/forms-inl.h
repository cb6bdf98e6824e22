// SPDX-License-Identifier: Apache-2.0
// The approximations of c^e, each written once. No include guard: power.cpp includes this file in its own
// namespace, the SIMD kernels include it again in one namespace per instruction set, so that every copy is
// compiled with that set's flags.
//
// The number type T is a template parameter. double gives the definition, a vector of floats the kernel, an
// interval with derivatives the proof and a node of an expression graph the shader text. T needs + - * /, a
// constructor from double and, found by argument, the functions
//   mul_add(a, b, c) = a b + c      neg_mul_add(a, b, c) = c - a b      max(a, b)      sqrt, exp2, log2
//   if_less(a, b, x, y) = a < b ? x : y                              short_exp2: 2^x within 7e-5 or better
//   power_at_inflection(V)          see Quadratic
// and for some members log_cosine and its inverse exp_of_log (to any one base), squared_angle, cos_of_root,
// split, floor_and_fraction and scale_by_power_of_two as noted there.
//
// Everything is homogeneous. With u = 1 - c, a member's value depends on c, u and coefficients k; coefficient
// k of u^i is a polynomial of degree i in (e, one), where one = 1. So replacing (e, one, u) by (1, 1/e, e u)
// changes no value, and the proofs of bounds.cpp run over the small box s = e u, v = 1/e instead of over all
// exponents.

template <class T>
struct Exponent {
  T e, one;
};

template <class T>
struct Cosine {
  T c, u;  // u = 1 - c
};

template <class T, class... B>
T polynomial(T x, double b, B... higher) {
  if constexpr (sizeof...(higher) == 0)
    return T(b);
  else
    return mul_add(polynomial(x, higher...), x, T(b));
}

/// The polynomial of these coefficients, the constant first.
template <class T, std::size_t count>
T polynomial(T x, const double (&coefficients)[count]) {
  T sum(coefficients[count - 1]);
  for (std::size_t i = count - 1; i-- > 0;) sum = mul_add(sum, x, T(coefficients[i]));
  return sum;
}

template <class T>
T clamp_negative(T x) {
  return max(x, T(0.0));
}

/// 1 - k u. Vectors that know c better than u take k c + (1 - k) instead.
template <class P, class T>
T falling_line(const T& k, const P& p) {
  return neg_mul_add(k, p.u, T(1.0));
}

/// x^(2^log2_n) by repeated squaring.
template <int log2_n, class T>
T power_of_two_power(T x) {
  if constexpr (log2_n == 0)
    return x;
  else
    return power_of_two_power<log2_n - 1>(x * x);
}

struct Exact {
  static constexpr int kCoefficients = 1;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e;
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    if constexpr (requires { exact_kernel<Exact>(p.c, k[0]); })
      return exact_kernel<Exact>(p.c, k[0]);
    else
      return exp_of_log(k[0] * log_cosine(p));
  }
  // The vectors' kernel, in doubles: log2(1 + t) for t in [-1/3, 1/3] is t times the polynomial of kLog2, within
  // 1.9e-11 of it; 2^f for f in [-1/2, 1/2] is that of kExp2, within 2e-9 of it, exact at 0.
  static constexpr double kLog2[] = {1.4426950408889634,   -0.7213475195890743,  0.4808983461624031,
                                     -0.36067397503253135, 0.2885392092154406,   -0.24043384189982597,
                                     0.20608494395275082,  -0.18080231601297725, 0.1607349572696111,
                                     -0.1374949345626878,  0.124816639367347,    -0.16599428813932715,
                                     0.15377125307658862};
  static constexpr double kExp2[] = {1.0,
                                     0.693147202855053,
                                     0.24022647913598957,
                                     0.055503324710729184,
                                     0.009618437360671965,
                                     0.0013398874441323428,
                                     0.00015353361213338683};
};

struct Schlick {
  static constexpr int kCoefficients = 1;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e;
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return p.c / mul_add(k[0], p.u, p.c);  // [Schlick 1994a]
  }
};

/// Taylor series of c^e = (1 - D^2/2)^e to D^6, D the chord; D^2/2 is u. The last term makes it fall below
/// zero, where it is cut.
struct Lyon {
  static constexpr int kCoefficients = 3;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e;
    k[1] = k[0] * (x.e - x.one) * T(0.5);
    k[2] = k[1] * (x.e - T(2.0) * x.one) * T(1.0 / 3);
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    const T inner = neg_mul_add(neg_mul_add(k[2], p.u, k[1]), p.u, k[0]);
    return clamp_negative(neg_mul_add(inner, p.u, T(1.0)));
  }
};

/// cos(sqrt(e / n) gamma)^n, zero from sqrt(e / n) gamma = pi / 2 on, n = 2^log2_n.
template <int log2_n>
struct Angle {
  static constexpr int kCoefficients = 1;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e * T(1.0 / (1 << log2_n));
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return power_of_two_power<log2_n>(cos_of_root(k[0] * squared_angle(p)));
  }
};

/// The paper's parabola a c^2 + (1 - a) c = c (1 - a u), with a by (7) as
///   a = (t^(e-1) - 1) / (t - 1) = e (1 + t) (1 - t^(e-1)),   t = cos x* = sqrt(1 - 1/e),
/// which does not cancel: 1 - t = (1 - t^2) / (1 + t) = (1/e) / (1 + t).
struct QuadraticRaw {
  static constexpr int kCoefficients = 1;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    const T inverse = x.one / x.e;
    const T t = sqrt(T(1.0) - inverse);
    k[0] = x.e * (T(1.0) + t) * (T(1.0) - power_at_inflection(inverse));  // [QuadraticBrdf, eq. 7]
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return p.c * falling_line(k[0], p);  // [QuadraticBrdf, eq. 1, 4]
  }
};

struct Quadratic : QuadraticRaw {
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return p.c * clamp_negative(falling_line(k[0], p));
  }
};

/// max(0, 1 - k u)^n, k affine in e.
template <int log2_n>
struct LinearPower {
  static constexpr int kCoefficients = 1, kLog2Power = log2_n;
  // Least largest error over e >= 2, 2.6, 5, 10 for n = 2, 4, 8, 16.
  static constexpr double kSlope[] = {0, 0.355945, 0.211344, 0.114994, 0.0599623};
  static constexpr double kOffset[] = {0, 0.157597, 0.121098, 0.0766, 0.0322371};
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = mul_add(T(kSlope[log2_n]), x.e, T(kOffset[log2_n]) * x.one);
  }
  /// max(0, top - u): what is raised to the power, with u scaled so that its coefficient is 1.
  template <class T>
  static T root(const T& u, const T*, const T& top) {
    return clamp_negative(top - u);
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return power_of_two_power<log2_n>(clamp_negative(falling_line(k[0], p)));
  }
};

/// Two parabolas in vertex form that meet with equal slope at u = s1 / e:
///   d (s1 - s)^2 + r (s2 - s)^2 near the centre, r (s2 - s)^2 up to s2, s = e u, r from the value 1 at s =
///   0.
/// Each is max(0, m - n u)^2 + o; the compare chooses m, n and o, two multiplies do the rest.
struct TwoPiece {
  static constexpr int kCoefficients = 6;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    const T v = x.one / x.e;
    const T d = polynomial(v, 0.219054, -0.0924642, 0.0690744);
    const T s1 = polynomial(v, 1.50074, 0.598014, 0.495079);
    const T s2 = polynomial(v, 4.37478, -3.83377, -0.657295);
    const T r = neg_mul_add(d * s1, s1, T(1.0)) / (s2 * s2);
    const T root_q = sqrt(r + d), root_r = sqrt(r);
    k[0] = s1 / x.e;
    k[1] = mul_add(r, s2, d * s1) / root_q;  // m near the centre
    k[2] = root_q * x.e;
    k[3] = neg_mul_add(k[1], k[1], T(1.0));
    k[4] = root_r * s2;
    k[5] = root_r * x.e;
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    const T m = if_less(p.u, k[0], k[1], k[4]);
    const T n = if_less(p.u, k[0], k[2], k[5]);
    const T o = if_less(p.u, k[0], k[3], T(0.0));
    const T w = clamp_negative(neg_mul_add(n, p.u, m));
    return mul_add(w, w, o);
  }
};

/// The paper's parabola up to u = s1 / e, below the level 0.56 where its relative error is counted, then
/// r (s2 - s)^2, continuous.
struct TwoPiecePaper {
  static constexpr int kCoefficients = 4;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    const T v = x.one / x.e;
    QuadraticRaw::coefficients(x, k);
    const T s1 = polynomial(v, 0.668927, 0.271691);
    const T s2 = polynomial(v, 3.83908, -3.30596, 0.0802625);
    const T level = neg_mul_add(v, s1, T(1.0)) * neg_mul_add(k[0] / x.e, s1, T(1.0));
    const T root_r = sqrt(level) / (s2 - s1);
    k[1] = s1 / x.e;
    k[2] = root_r * s2;
    k[3] = root_r * x.e;
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    const T w = clamp_negative(neg_mul_add(k[3], p.u, k[2]));
    return if_less(p.u, k[1], p.c * falling_line(k[0], p), w * w);
  }
};

/// max(0, 1 - k0 u + k1 u^2 - k2 u^3)^n.
template <int log2_n>
struct CubicPower {
  static constexpr int kCoefficients = 3, kLog2Power = log2_n;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    const T v = x.one / x.e, e2 = x.e * x.e;
    if constexpr (log2_n == 1) {  // least largest error over e >= 1.5
      k[0] = polynomial(v, 0.487014, 0.135328, -0.180465) * x.e;
      k[1] = polynomial(v, 0.100714, -0.0335795, -0.281918, 0.0784149) * e2;
      k[2] = polynomial(v, 0.0080634, 0.000696565, -0.167471, 0.369857) * (e2 * x.e);
    } else {  // over e >= 3.5
      k[0] = polynomial(v, 0.248985, 0.018763, -0.0467591) * x.e;
      k[1] = polynomial(v, 0.0292343, -0.0920301, -0.0690483, -0.0551332) * e2;
      k[2] = polynomial(v, 0.0015912, -0.0130853, 0.00976116, 0.073838, 0.0552656) * (e2 * x.e);
    }
  }
  /// max(0, top - k0 u + k1 u^2 - u^3), as LinearPower's.
  template <class T>
  static T root(const T& u, const T* k, const T& top) {
    return clamp_negative(neg_mul_add(neg_mul_add(k[1] - u, u, k[0]), u, top));
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    const T inner = neg_mul_add(neg_mul_add(k[2], p.u, k[1]), p.u, k[0]);
    return power_of_two_power<log2_n>(clamp_negative(neg_mul_add(inner, p.u, T(1.0))));
  }
};

/// c / (c + k0 u + k1 u^3); c itself at e = 1.
struct Rational {
  static constexpr int kCoefficients = 2;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    const T v = x.one / x.e;
    const T rest = T(1.0) - v;
    k[0] = mul_add(rest, polynomial(v, 0.141264, -0.343315), T(1.0)) * x.e;
    k[1] = rest * polynomial(v, 0.514445, 1.29806) * (x.e * x.e * x.e);
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return p.c / mul_add(mul_add(k[1] * p.u, p.u, k[0]), p.u, p.c);
  }
};

/// (c / (c + k0 u + k1 u^2))^n; c^n at e = n.
template <int log2_n>
struct RationalPower {
  static constexpr int kCoefficients = 2;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    const T v = x.one / x.e;
    const T rest = T(1.0 / (1 << log2_n)) - v;
    const T share = T(1.0 / (1 << log2_n));
    if constexpr (log2_n == 1) {
      k[0] = mul_add(rest, polynomial(v, -0.085392, -0.172787), share) * x.e;
      k[1] = rest * polynomial(v, 0.4145, 0.37519) * (x.e * x.e);
    } else {
      k[0] = mul_add(rest, polynomial(v, -0.0225979, -0.0919155), share) * x.e;
      k[1] = rest * polynomial(v, 0.164365, 0.170479) * (x.e * x.e);
    }
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return power_of_two_power<log2_n>(p.c / mul_add(mul_add(k[1], p.u, k[0]), p.u, p.c));
  }
};

/// Spherical Gaussian exp(-e u).
struct Gaussian {
  static constexpr int kCoefficients = 1;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e * T(-kLog2OfE);
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return short_exp2(k[0] * p.u);
  }
  static constexpr double kLog2OfE = 1.4426950408889634;
};

/// exp(-e (u + u^2 / 2)): one more term of log c = -u - u^2/2 - u^3/3 - ...
struct GaussianSecondOrder {
  static constexpr int kCoefficients = 2;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e * T(-Gaussian::kLog2OfE);
    k[1] = x.e * x.one * T(-Gaussian::kLog2OfE / 2);
  }
  template <class P, class T>
  static T value(const P& p, const T* k) {
    return short_exp2(mul_add(k[1], p.u, k[0]) * p.u);
  }
};

/// exp2(e log2 c) with both functions as polynomials: c = m 2^n, m in [0.645, 1.29) (formula/mantissa.h).
struct NearExact {
  static constexpr int kCoefficients = 1;
  template <class T>
  static void coefficients(const Exponent<T>& x, T* k) {
    k[0] = x.e;
  }
  /// log2(1 + t) for t in [-0.355, 0.29] is t times the polynomial of these. Weighted for least error of c^e.
  static constexpr double kLog2[] = {1.44268836,   -0.721631297, 0.480207006,
                                     -0.348687457, 0.315810036,  -0.362501085};
  template <class T>
  static T log2_ratio(T t) {
    return polynomial(t, kLog2);
  }
  /// 2^f for f in [0, 1], exact at both ends, in floats too.
  template <class T>
  static T exp2_of_fraction(T f) {
    return polynomial(f, 1.0, 0.693152964, 0.240147129, 0.0558552928, 0.00894775242, 0.00189684913);
  }
  /// 2^(m - 1) for m in [1, 2], exact at both ends, in floats too: for vectors that have m and not its fraction.
  template <class T>
  static T exp2_of_mantissa(T m) {
    return polynomial(m, 0.498189688, 0.354118109, 0.107298918, 0.0390330143, -0.000536574575, 0.00189685996);
  }
  /// 2^f to 7e-5 for f in [-1/2, 1/2], exact at 0: enough for the Gaussians.
  template <class T>
  static T exp2_near_zero_short(T f) {
    return polynomial(f, 1.0, 0.693346858, 0.242223814, 0.0547617041);
  }
  static constexpr double kMinPower = -125;  // 2^this is returned for everything smaller: no denormals

  template <class P, class T>
  static T value(const P& p, const T* k) {
    if constexpr (requires { near_exact_kernel<NearExact>(p.c, k[0]); }) {
      return near_exact_kernel<NearExact>(p.c, k[0]);  // vectors split numbers in ways of their own
    } else {
      const auto [n, m] = split(p.c);
      const T t = m - T(1.0);
      const T y = max(k[0] * mul_add(log2_ratio(t), t, n), T(kMinPower));
      const auto [whole, f] = floor_and_fraction(y);
      return scale_by_power_of_two(exp2_of_fraction(f), whole);
    }
  }
};

/// Every member, in the order of PowerMethod.
template <template <class...> class List>
using AllForms = List<Exact, Schlick, Lyon, Angle<1>, Angle<2>, Angle<3>, Angle<4>, QuadraticRaw, Quadratic,
                      LinearPower<1>, LinearPower<2>, LinearPower<3>, LinearPower<4>, TwoPiece, TwoPiecePaper,
                      CubicPower<1>, CubicPower<2>, Rational, RationalPower<1>, RationalPower<2>, Gaussian,
                      GaussianSecondOrder, NearExact>;
