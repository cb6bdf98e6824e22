// The formulas of DirectionTable, each written once. No include guard: included in a namespace of its own for
// double and again in one per instruction set for vectors of floats, so that every copy is compiled with that
// set's flags.
//
// F is a number or a vector of numbers, I of 32-bit integers. They need + - * (F also /), min, max, of F
// sqrt, abs, less_or_equal and if_true(mask, a, b), to_int (truncating), to_real, and
//   next_around(i, last)  i + 1, but 0 for i = last
//   edge_pair(table, i)   lower = table[i] and upper = table[i + 1], 65536 where that is 0
//   search(table, start, weight, count, target)  the last of `count` entries, a power of two, for which
//                         sum_s weight[s] table[start[s] + entry] <= target; the first entries are 0
// found by argument.

template <class F>
struct Axis {
  F x, y;
};

/// (x, y) / |(x, y)|, and (1, 0) where both are zero.
template <class F>
SAMPLER_INLINE Axis<F> unit_axis(F x, F y) {
  const F right = x + F(1e-15), inverse = F(1.0) / sqrt(right * right + y * y);
  return {right * inverse, y * inverse};
}

/// Places on the circle: w = x / (1 + |y|) of a unit vector goes from 1 to -1 along the upper half and back
/// along the lower one, with d(w) / d(azimuth) = (1 + w^2) / 2 in size, so that turn() runs counterclockwise
/// from 0 at +x over 2 at -x to 4.
template <class F>
SAMPLER_INLINE F place_on_half_circle(F x, F y) {
  return x / (F(1.0) + abs(y));
}
template <class F>
SAMPLER_INLINE F turn(F w, F y) {
  return if_true(less_or_equal(F(0.0), y), F(1.0) - w, F(3.0) + w);
}
/// The unit vector of the upper half at w.
template <class F>
SAMPLER_INLINE Axis<F> on_half_circle(F w) {
  const F square = w * w, inverse = F(1.0) / (F(1.0) + square);
  return {(w + w) * inverse, (F(1.0) - square) * inverse};
}

/// largest_visible_half of parameterization/visible_half.h: tan(theta_h) = (length + along) / up there.
template <class F>
SAMPLER_INLINE F largest_half(F along, F up) {
  const F sum = sqrt(along * along + up * up) + abs(along), reach = sqrt(sum * sum + up * up);
  const auto behind = less_or_equal(along, F(0.0));
  const F t = if_true(behind, up, sum) / (if_true(behind, sum, up) + reach);
  return t * t;
}

/// VisibleHalfMap along one azimuth: m from 0 to `largest`, where G(m) = a m / (m + K) + b m is
/// total / end.
template <class F>
struct Ray {
  F K, a, b, largest, end, total;

  /// `stretch` is |M azimuth|^2, `along` the component of wo along the azimuth, `up` wo.z.
  template <class View>
  SAMPLER_INLINE Ray(const View& view, F stretch, F along, F up) {
    K = F(view.sharpness) / stretch;
    a = F(view.share) * (F(1.0) + K);
    b = F(1.0 - view.share);
    largest = largest_half(along, up);
    end = largest + K;
    total = largest * (a + b * end);
  }

  SAMPLER_INLINE F to_unit(F m) const { return m * (a + b * (m + K)) * end / ((m + K) * total); }
  /// Inverse of to_unit: the positive root of b end m^2 + p m - q, without cancellation for either sign of p.
  SAMPLER_INLINE F from_unit(F v) const {
    const F target = v * total, p = (a + b * K) * end - target, q = F(2.0) * target * K, c = F(2.0) * b * end;
    const F sum = abs(p) + sqrt(p * p + c * q);
    const auto positive = less_or_equal(F(0.0), p);
    return min(if_true(positive, q, sum) / if_true(positive, sum, c), largest);
  }
  /// d(turn) dv per solid angle of wi around it, where `turning` is d(turn) / d(azimuth): the half vector's
  /// solid angle is 2 dm dphi / (1 + m)^2, that of wi 4 wo.h times it [Walter 2007, eq. 14].
  SAMPLER_INLINE F density(F m, F to_half, F turning) const {
    const F near = (m + K) * (m + K), onward = F(1.0) + m;
    return turning * end * (a * K + b * near) * onward * onward / (F(8.0) * to_half * total * near);
  }
};

/// The tables around one wo: slices and their weights.
template <int kSlices, class F, class I>
struct Mix {
  F weight[kSlices];
  I slice[kSlices];
};

/// For wo = (x, y, z) with azimuth `plane`.
template <int kSlices, class F, class I, class View>
SAMPLER_INLINE Mix<kSlices, F, I> mix_for(const View& view, F x, F y, F z, Axis<F> plane) {
  const F t = (x * plane.x + y * plane.y) / (F(1.0) + z);
  const F at = min(t * F(view.theta_scale), F(view.thetas - 1.0));
  const I ring = max(min(to_int(at), I(view.thetas - 2)), I(0));
  const F outer = at - to_real(ring);
  if constexpr (kSlices == 2) {
    return {{F(1.0) - outer, outer}, {ring, ring + I(1)}};
  } else {
    const F around = turn(place_on_half_circle(plane.x, plane.y), plane.y) * F(0.25 * view.phis);
    const I first = max(min(to_int(around), I(view.phis - 1)), I(0));
    const F part = around - to_real(first);
    const I next = next_around(first, view.phis - 1);
    // between three of the four corners of the cell: those of its half
    const auto far = less_or_equal(F(1.0), outer + part);
    const F corner = if_true(far, outer + part - F(1.0), F(1.0) - outer - part);
    const F along_ring = if_true(far, F(1.0) - outer, part), along_turn = if_true(far, F(1.0) - part, outer);
    const I inner_ring = ring * I(view.phis), outer_ring = inner_ring + I(view.phis);
    const I a = inner_ring + first, d = outer_ring + next;
    return {{corner, along_ring, along_turn}, {if_true(far, d, a), inner_ring + next, outer_ring + first}};
  }
}

/// Cell of a cumulative table and its bounds, of every slice weighed.
template <int kSlices, class F, class I>
struct Interval {
  I index;
  F lower, mass;
  F slice_mass[kSlices];  // weighed
};

// An entry of a table is the cumulative probability at the lower end of a cell, in 1/65536; the first is 0,
// and what follows the last, the next row's first, reads as 0 for 65536.
template <int kSlices, class F, class I>
SAMPLER_INLINE Interval<kSlices, F, I> interval_at(const std::uint16_t* table, const I (&start)[kSlices],
                                                   const F (&weight)[kSlices], I index) {
  Interval<kSlices, F, I> found{index, F(0.0), F(0.0), {}};
  for (int s = 0; s < kSlices; ++s) {
    const auto edge = edge_pair(table, start[s] + index);
    const F lower = to_real(edge.lower);
    found.slice_mass[s] = weight[s] * to_real(edge.upper - edge.lower);
    found.lower = found.lower + weight[s] * lower;
    found.mass = found.mass + found.slice_mass[s];
  }
  return found;
}

template <int kSlices, class F, class I>
SAMPLER_INLINE Interval<kSlices, F, I> find_interval(const std::uint16_t* table, const I (&start)[kSlices],
                                                     const F (&weight)[kSlices], int count, F target) {
  // what is no number, or below 0, falls into the first cell
  return interval_at(table, start, weight, max(search(table, start, weight, count, target), I(0)));
}

/// d(turn) / d(azimuth) at w: along the circle of M's images, which M turns by 1 / stretch.
template <class F>
SAMPLER_INLINE F turning(F w, F stretch) {
  return (F(1.0) + w * w) / (stretch + stretch);
}

/// A direction to the light and the map's density around it (of Ray).
template <class F>
struct Placed {
  F x, y, z, density;
};

/// The direction at turn and v. Of isotropic tables the turn is that from the azimuth `plane` of wo, to the
/// side `side` (-1 or 1).
template <bool kIsotropic, class F, class View>
SAMPLER_INLINE Placed<F> place(const View& view, F wo_x, F wo_y, F wo_z, Axis<F> plane, F turned, F v,
                               F side) {
  F h_x, h_y, stretch(1.0), w;
  if constexpr (kIsotropic) {
    w = F(1.0) - turned;
    const Axis<F> axis = on_half_circle(w);
    const F across = side * axis.y;
    h_x = axis.x * plane.x - across * plane.y;
    h_y = axis.x * plane.y + across * plane.x;
  } else {
    w = abs(turned - F(2.0)) - F(1.0);
    const Axis<F> axis = on_half_circle(w);
    const F up = if_true(less_or_equal(turned, F(2.0)), axis.y, F(0.0) - axis.y);
    const F x = F(view.yy) * axis.x - F(view.xy) * up, y = F(view.xx) * up - F(view.xy) * axis.x;  // M^-1
    stretch = F(1.0) / (x * x + y * y);
    const F scale = sqrt(stretch);
    h_x = x * scale;
    h_y = y * scale;
  }
  const F along = wo_x * h_x + wo_y * h_y;
  const Ray<F> ray(view, stretch, along, wo_z);
  const F m = ray.from_unit(v);
  const F norm = F(1.0) / (F(1.0) + m), sine = F(2.0) * sqrt(m) * norm, cosine = (F(1.0) - m) * norm;
  const F to_half = along * sine + wo_z * cosine, twice = to_half + to_half;
  return {twice * sine * h_x - wo_x, twice * sine * h_y - wo_y, twice * cosine - wo_z,
          ray.density(m, to_half, turning(w, stretch))};
}

template <class F>
struct Drawn {
  F x, y, z, pdf;
};

inline constexpr double kEdgeUnit = 65536;

template <bool kIsotropic, class F, class I, class View>
SAMPLER_INLINE Drawn<F> draw(const View& view, F wo_x, F wo_y, F wo_z, F u_x, F u_y) {
  constexpr int kSlices = kIsotropic ? 2 : 3;
  const Axis<F> plane = unit_axis(wo_x, wo_y);
  const Mix<kSlices, F, I> mix = mix_for<kSlices, F, I>(view, wo_x, wo_y, wo_z, plane);
  const auto within = [](F target, const Interval<kSlices, F, I>& i) {
    return to_real(i.index) + max(min((target - i.lower) / i.mass, F(1.0)), F(0.0));
  };

  const F uniform = kIsotropic ? abs(u_x + u_x - F(1.0)) : u_x;
  I start[kSlices];
  for (int s = 0; s < kSlices; ++s) start[s] = mix.slice[s] * I(view.rows);
  const F row_target = uniform * F(kEdgeUnit);
  const auto row = find_interval<kSlices, F, I>(view.row_edges, start, mix.weight, view.rows, row_target);
  const F around = within(row_target, row) * F((kIsotropic ? 2.0 : 4.0) / view.rows);

  for (int s = 0; s < kSlices; ++s) start[s] = (start[s] + row.index) * I(view.columns);
  const F column_target = u_y * row.mass * F(kEdgeUnit);
  const auto column =
      find_interval<kSlices, F, I>(view.cell_edges, start, row.slice_mass, view.columns, column_target);
  const F v = within(column_target, column) * F(1.0 / view.columns);

  const F side = if_true(less_or_equal(F(0.5), u_x), F(1.0), F(-1.0));
  const Placed<F> wi = place<kIsotropic>(view, wo_x, wo_y, wo_z, plane, around, v, side);
  const F cells = F(0.25 / (kEdgeUnit * kEdgeUnit) * view.rows * view.columns);
  return {wi.x, wi.y, wi.z, if_true(less_or_equal(wi.z, F(0.0)), F(0.0), column.mass * cells * wi.density)};
}

template <bool kIsotropic, class F, class I, class View>
SAMPLER_INLINE F density(const View& view, F wi_x, F wi_y, F wi_z, F wo_x, F wo_y, F wo_z) {
  constexpr int kSlices = kIsotropic ? 2 : 3;
  const Axis<F> plane = unit_axis(wo_x, wo_y);
  const Mix<kSlices, F, I> mix = mix_for<kSlices, F, I>(view, wo_x, wo_y, wo_z, plane);
  const F x = wi_x + wo_x, y = wi_y + wo_y, z = wi_z + wo_z;
  const F across = x * x + y * y, length = sqrt(across + z * z), up = length + z;
  const F m = across / (up * up);
  const Axis<F> h = unit_axis(x, y);
  Axis<F> image;  // the azimuth from wo's, or what M makes of it
  F stretch(1.0);
  if constexpr (kIsotropic) {
    image = {h.x * plane.x + h.y * plane.y, abs(h.y * plane.x - h.x * plane.y)};
  } else {
    image = {F(view.xx) * h.x + F(view.xy) * h.y, F(view.xy) * h.x + F(view.yy) * h.y};
    stretch = image.x * image.x + image.y * image.y;
    image = unit_axis(image.x, image.y);
  }
  const F w = place_on_half_circle(image.x, image.y);
  const Ray<F> ray(view, stretch, wo_x * h.x + wo_y * h.y, wo_z);

  const auto cell = [](F unit, int count) { return min(max(to_int(unit), I(0)), I(count - 1)); };
  const I row_index = cell(turn(w, image.y) * F(view.rows / (kIsotropic ? 2.0 : 4.0)), view.rows);
  const I column_index = cell(ray.to_unit(m) * F(view.columns), view.columns);
  I start[kSlices];
  for (int s = 0; s < kSlices; ++s) start[s] = mix.slice[s] * I(view.rows);
  const auto row = interval_at<kSlices, F, I>(view.row_edges, start, mix.weight, row_index);
  for (int s = 0; s < kSlices; ++s) start[s] = (start[s] + row_index) * I(view.columns);
  const auto column = interval_at<kSlices, F, I>(view.cell_edges, start, row.slice_mass, column_index);

  const F cells = F(0.25 / (kEdgeUnit * kEdgeUnit) * view.rows * view.columns);
  const F pdf = column.mass * cells * ray.density(m, F(0.5) * length, turning(w, stretch));
  const F least = min(wi_z, wo_z);
  return if_true(less_or_equal(least, F(0.0)), F(0.0), pdf);
}
