// SPDX-License-Identifier: Apache-2.0
// Projections and warps, each written once. There is no include guard. The file is included in a namespace of its own
// for double (the definition) and for nodes of expression graphs (text, costs, graphs for other programs). It is
// included again in one per instruction set for vectors of floats, so that every copy is compiled with that set's
// flags.
//
// T is the number type, V a vector of three of them with members x, y and z. T needs + - * /, max, min, sqrt,
// abs, a constructor from double and, found by argument or declared before,
//   mul_add(a, b, c) = a b + c, neg_mul_add(a, b, c) = c - a b   fused or not
//   if_less(a, b, x, y) = a < b ? x : y
//   power(t, exponent) = t^exponent, t >= 0; exponent of any type that it takes
//   length(x, y), length(x, y, z)       in whatever order is best for T
//   least_positive(T)                   a number to divide by in place of 0
//   named(name, x) = x                  where text should say the name
// and V + - of each other and double * V, mirror(V) = (-x, -y, z) of math/vec3.h.
//
// Exchanging the directions must change no bit of what a reciprocal model is looked up by. It keeps wi + wo
// and changes the signs of wi - wo. Squares, absolute values and lengths of both stay the same, fused or not;
// of two different products' sum one has to be rounded: a u + b v with a != b is not fused at all, and in
// s_y d_x - s_x d_y the signs of both terms change together, whichever of them is rounded.

/// tan(theta / 2) = r / den of a projected direction: not normalized, so that warps divide once.
template <class T>
struct Polar {
  T r, den;
};

/// Returns the polar angle of a vector of this length, z >= 0: r = |(x, y)|, den = length + z.
template <class V, class T>
FORMULA_INLINE Polar<T> polar_of(const V& v, const T& size) {
  return {named("r", length(v.x, v.y)), size + v.z};
}

/// a u + b v; where a == b as a (u + v), so that exchanging u and v changes no bit.
template <class V>
FORMULA_INLINE V combined(double a, const V& u, double b, const V& v) {
  return a == b ? a * named("sum", u + v) : a * u + b * v;
}

/// wi WI + wo WO + mirror mirror(WI) + n N of an affine projection, which may point below the horizon
/// [HomomorphicBrdf, eq. 4].
template <class V>
FORMULA_INLINE V combination(const Projection& p, const V& wi, const V& wo) {
  V v = combined(p.wi, wi, p.wo, wo);
  if (p.mirror != 0) v = v + p.mirror * mirror(wi);
  if (p.n != 0) v.z = named("up", v.z + decltype(v.z)(p.n));
  return v;
}

/// The combination, of a vector below the horizon the part along it, with its polar angle; where it vanishes
/// (opposite directions) the normal.
template <class V, class T>
struct Affine {
  V vector;
  Polar<T> polar;
};
template <class V>
FORMULA_INLINE auto affine(const Projection& p, const V& wi, const V& wo) {
  using T = decltype(wi.x);
  V v = combination(p, wi, wo);
  if (p.wi < 0 || p.wo < 0 || p.mirror < 0 || p.n < 0) v.z = named("up", max(v.z, T(0.0)));
  Polar<T> polar = polar_of(v, length(v.x, v.y, v.z));
  polar.den = named("den", max(polar.den, least_positive(T())));
  return Affine<V, T>{v, polar};
}

/// A pair of directions as the projections below see it: members `sum` = wi + wo and `apart` = wi - wo, V,
/// and sum_length(), |wi + wo| = 2 cos theta_d. |wi - wo| = 2 sin theta_d; wi - wo is orthogonal to the half
/// vector, so that its components along the half vector's frame lose no digits.

/// x and y of `e` in the frame whose z axis is h and whose x axis lies in the plane of h and the normal [Rusinkiewicz
/// 1998]: h = frame / size, of any length. For e = wi - wo it is 2 sin theta_d (cos phi_d, sin phi_d), for e = wi
/// half of that.
template <class T>
struct Across {
  T x, y;
};
template <class V, class T>
FORMULA_INLINE Across<T> across_half(const V& frame, const T& size, const V& e) {
  const T none(0.0), sine = length(frame.x, frame.y);
  const T cos_phi = named("cosine", if_less(none, sine, frame.x / sine, T(1.0)));
  const T sin_phi = named("sine", if_less(none, sine, frame.y / sine, none));
  const T along =
      named("along", neg_mul_add(e.z, sine, mul_add(e.y, frame.z * sin_phi, e.x * (frame.z * cos_phi))));
  return {named("x", if_less(none, size, along / size, along)),
          named("y", neg_mul_add(sin_phi, e.x, cos_phi * e.y))};
}

/// theta_d: cos theta_d = |wi + wo| / 2, sin theta_d = |wi - wo| / 2.
template <class Pair>
FORMULA_INLINE auto difference_angle(const Pair& pair) {
  using T = decltype(pair.sum.x);
  const auto& d = pair.apart;
  return Polar<T>{named("r", length(d.x, d.y, d.z)), named("den", T(2.0) + pair.sum_length())};
}

/// theta_m: the same of the mirrored light, whose sum with wo and distance from it have the components of
/// wi - wo and wi + wo, up to signs.
template <class Pair>
FORMULA_INLINE auto deviation_angle(const Pair& pair) {
  using T = decltype(pair.sum.x);
  const auto &s = pair.sum, &d = pair.apart;
  return Polar<T>{named("r", length(s.x, s.y, d.z)), named("den", T(2.0) + length(d.x, d.y, s.z))};
}

/// r / den = 1/2 + scale turn / (2 half), between 0 and 1.
template <class T>
FORMULA_INLINE Polar<T> off_the_middle(double scale, const T& turn, const T& half) {
  if constexpr (std::is_same_v<T, double>) {  // in the order that models were fitted with
    return {min(max(0.5 + 0.5 * scale * turn / half, 0.0), 1.0), 1.0};
  } else {
    const T den = named("den", half + half);
    return {named("r", max(min(mul_add(turn, T(scale), half), den), T(0.0))), den};
  }
}

/// theta_t: r / den = 1/2 + kTwistScale turn / (2 half), turn = d_z (s_y d_x - s_x d_y) |s|^2,
/// half = s_x^2 + s_y^2 + kTwistCore |s|^2.
template <class Pair>
FORMULA_INLINE auto twist_angle(const Pair& pair) {
  using T = decltype(pair.sum.x);
  const auto &s = pair.sum, &d = pair.apart;
  const T across = named("rr", mul_add(s.x, s.x, s.y * s.y));
  const T square = named("square", mul_add(s.z, s.z, across));
  const T half = named("half_den", max(mul_add(square, T(kTwistCore), across), least_positive(T())));
  const T turn = named("turn", d.z * neg_mul_add(s.x, d.y, s.y * d.x) * square);
  return off_the_middle(kTwistScale, turn, half);
}

/// phi_d, folded: |cos phi_d| : |sin phi_d| = |d_z| |s| : |s_y d_x - s_x d_y|, so that r / den = tan(phi_d / 2) =
/// |sin phi_d| / (1 + |cos phi_d|), without inverse functions. The products are not fused: what is left of one
/// rounded and one exact would be an angle where both terms are 0. For unit directions s and d are at right angles,
/// so the length of both is |d| |s_xy|: a pair with a member azimuth_size() returns that, where those roots are taken
/// anyway. Directions off by e turn phi_d by e / (|d| |s_xy|) more then.
template <class Pair>
FORMULA_INLINE auto folded_azimuth(const Pair& pair) {
  using T = decltype(pair.sum.x);
  const auto &s = pair.sum, &d = pair.apart;
  const T cosine = named("cosine", abs(d.z) * pair.sum_length());
  const T sine = named("sine", abs(s.y * d.x - s.x * d.y));
  const auto size = [&]() FORMULA_ATTRIBUTE {
    if constexpr (requires { pair.azimuth_size(); })
      return pair.azimuth_size();
    else
      return length(cosine, sine);
  };
  const T den = named("den", max(size() + cosine, least_positive(T())));
  return Polar<T>{named("r", min(sine, den)), den};  // squares of tiny numbers vanish
}

/// phi_s: r / den = (1 + s tan(phi / 2)) / 2 of the folded phi_d, s the sign of d_z (s_y d_x - s_x d_y), whose
/// factors both change theirs when the directions are exchanged.
template <class Pair>
FORMULA_INLINE auto sided_azimuth(const Pair& pair) {
  using T = decltype(pair.sum.x);
  const auto &s = pair.sum, &d = pair.apart;
  const auto folded = folded_azimuth(pair);
  const T turn = named("turn", d.z * (s.y * d.x - s.x * d.y));
  const T less = named("less", folded.den - folded.r), more = named("more", folded.den + folded.r);
  return Polar<T>{named("r", if_less(turn, T(0.0), less, more)), named("den", folded.den + folded.den)};
}

/// Calls f(find), find(pair) the polar angle of the projection's kind: of the difference and of all that have
/// no azimuth. Decides once, for loops that must not.
template <class F>
FORMULA_INLINE auto with_angle(Projection::Kind kind, const F& f) {
  using Kind = Projection::Kind;
  switch (kind) {
    case Kind::deviation:
      return f([](const auto& pair) FORMULA_ATTRIBUTE { return deviation_angle(pair); });
    case Kind::twist:
      return f([](const auto& pair) FORMULA_ATTRIBUTE { return twist_angle(pair); });
    case Kind::azimuth:
      return f([](const auto& pair) FORMULA_ATTRIBUTE { return folded_azimuth(pair); });
    case Kind::side:
      return f([](const auto& pair) FORMULA_ATTRIBUTE { return sided_azimuth(pair); });
    case Kind::difference:
    case Kind::affine:
      break;
  }
  return f([](const auto& pair) FORMULA_ATTRIBUTE { return difference_angle(pair); });
}

/// size u, u = t, t = tan(theta / 2) in [0, 1].
template <class T>
FORMULA_INLINE T identity_warp(const T& size, const Polar<T>& polar) {
  return size * polar.r / polar.den;
}
/// size u, u = t (1 + k) / (t + k).
template <class T>
FORMULA_INLINE T rational_warp(const T& size, const T& k, const Polar<T>& polar) {
  return size * (T(1.0) + k) * polar.r / (polar.r + k * polar.den);
}
/// size u, u = t^exponent.
template <class T, class Exponent>
FORMULA_INLINE T power_warp(const T& size, const Exponent& exponent, const Polar<T>& polar) {
  return size * power(named("t", polar.r / polar.den), exponent);
}

/// size u / r: what the components of the projected vector are multiplied by in a disk; 0 where r is. The
/// definition, to_disk() of hemisphere_map.h, keeps the order that models were fitted with: u / t / den.
template <class T>
FORMULA_INLINE T identity_stretch(const T& size, const Polar<T>& polar) {
  return size / polar.den;
}
template <class T>
FORMULA_INLINE T rational_stretch(const T& size, const T& k, const Polar<T>& polar) {
  return size * (T(1.0) + k) / (polar.r + k * polar.den);
}
template <class T, class Exponent>
FORMULA_INLINE T power_stretch(const T& size, const Exponent& exponent, const Polar<T>& polar) {
  return power_warp(size, exponent, polar) / max(polar.r, least_positive(T()));
}
