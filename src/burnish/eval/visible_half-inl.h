// SPDX-License-Identifier: Apache-2.0
// TabulatedSampler's formulas, each written once. There is no include guard. The file is included in a namespace of
// its own for double, and again in one per instruction set for vectors of floats. So every copy is compiled with that
// set's flags.
//
// `view` has the tables, their sizes and the members of SamplerView that the formulas read, as any type of number.
//
// F is a number or a vector of numbers, I of 32-bit integers. They need + - * (F also /), min, max, of F sqrt, abs,
// copy_sign, less_or_equal and if_true(mask, a, b), to_int (truncating), to_real, and
//   next_around(i, last)  i + 1, but 0 for i = last
//   edge_pair(table, i)   lower = table[i] and table[i + 1] - lower, modulo 65536
//   search(table, start, weight, count, target)  the last of `count` entries, a power of two, for which
//                         sum_s weight[s] table[start[s] + entry] <= target; the first entries are 0
// found by argument. Tables are anything that edge_pair and search take: pointers, or names of arrays.

/// A unit vector of the plane.
template <class F>
struct PlaneAxis {
  F x, y;
};

/// A vector and its length.
template <class F>
struct Arrow {
  F x, y, length;
};

/// Returns (x, y) with its length; it points along +x where both are zero.
template <class F>
SAMPLER_INLINE Arrow<F> arrow(F x, F y) {
  const F right = x + F(1e-15);
  return {right, y, sqrt(right * right + y * y)};
}
/// Returns arrow() over its length.
template <class F>
SAMPLER_INLINE PlaneAxis<F> unit_axis(F x, F y) {
  const Arrow<F> to = arrow(x, y);
  const F inverse = F(1.0) / to.length;
  return {to.x * inverse, to.y * inverse};
}

/// Places on the circle: w = x / (length + |y|) goes from 1 to -1 along the upper half and back along the
/// lower one, with d(w) / d(azimuth) = (1 + w^2) / 2 in size, so that turn() runs counterclockwise from 0 at
/// +x over 2 at -x to 4.
template <class F>
SAMPLER_INLINE F place_on_half_circle(const Arrow<F>& to) {
  return to.x / (to.length + abs(to.y));
}
template <class F>
SAMPLER_INLINE F turn(F w, F y) {
  return F(2.0) - copy_sign(F(1.0) + w, y);
}
/// Returns a vector of place w whose y has the sign of `side`: the inverse of place_on_half_circle, up to length.
template <class F>
SAMPLER_INLINE Arrow<F> on_half_circle(F w, F side) {
  const F square = w * w;
  return {w + w, copy_sign(F(1.0) - square, side), F(1.0) + square};
}

/// largest_visible_half of parameterization/visible_half.h: tan(theta_h) = (length + along) / up there. Only
/// the ratio of along and up counts; up2 is up^2.
template <class F>
SAMPLER_INLINE F largest_half(F along, F up, F up2) {
  const F sum = sqrt(along * along + up2) + abs(along), reach = sqrt(sum * sum + up2);
  const auto behind = less_or_equal(along, F(0.0));
  const F t = if_true(behind, up, sum) / (if_true(behind, sum, up) + reach);
  return t * t;
}

/// VisibleHalfMap along one azimuth: m from 0 to `largest`, where
/// G(m) = a m / (m + K) + b m = m (slope + b m) / (m + K) is total / end.
template <class F>
struct Ray {
  F K, a, b, slope, largest, end, total;

  /// `narrowing` is 1 / |M azimuth|^2, `along` the component of wo along a vector of the azimuth, `up` wo.z
  /// times that vector's length, up2 its square.
  template <class View>
  SAMPLER_INLINE Ray(const View& view, F narrowing, F along, F up, F up2) {
    K = F(view.sharpness) * narrowing;
    a = F(view.share) * (F(1.0) + K);
    b = F(1.0) - F(view.share);
    slope = a + b * K;
    largest = largest_half(along, up, up2);
    end = largest + K;
    total = largest * (slope + b * largest);
  }

  SAMPLER_INLINE F to_unit(F m) const { return m * (slope + b * m) * end / ((m + K) * total); }
  /// Computes the inverse of to_unit: the positive root of b end m^2 + p m - q, without cancellation for either sign
  /// of p.
  SAMPLER_INLINE F from_unit(F v) const {
    const F target = v * total, p = slope * end - target, q = target * (K + K), c = (b + b) * end;
    const F sum = abs(p) + sqrt(p * p + c * q);
    const auto positive = less_or_equal(F(0.0), p);
    return min(if_true(positive, q, sum) / if_true(positive, sum, c), largest);
  }
  /// d(turn) dv per solid angle of wi around it, where `turning` is d(turn) / d(azimuth): the half vector's
  /// solid angle is 2 dm dphi / (1 + m)^2, that of wi 4 wo.h times it [Walter 2007, eq. 14].
  SAMPLER_INLINE F density(F m, F to_half, F turning) const {
    const F near = (m + K) * (m + K), onward = F(1.0) + m;
    return turning * end * (a * K + b * near) * onward * onward / (F(8.0) * total * near * to_half);
  }
};

/// Rings of wo stand evenly along t / (kRingReach - t), t = tan(theta_o / 2): twice as far apart at the
/// normal and half as far at the horizon as they would along t.
inline constexpr double kRingReach = 2;

/// The slices around one wo: their weights and first rows.
template <int kSlices, class F, class I>
struct Mix {
  F weight[kSlices];
  I row[kSlices];
};

/// Finds the slices around wo = (x, y, z): two rings, and on anisotropic tables the azimuths next to wo's.
template <int kSlices, class F, class I, class View>
SAMPLER_INLINE Mix<kSlices, F, I> mix_for(const View& view, F x, F y, F z) {
  // The position among the rings is t / (kRingReach - t) with t = tan(theta_o / 2) = |(x, y)| / (1 + z).
  const Arrow<F> to = arrow(x, y);
  const F short_of = F(kRingReach) * (F(1.0) + z) - to.length;
  const F at = min(to.length / short_of * F(view.theta_scale), F(view.last_ring));
  const I ring = max(min(to_int(at), I(view.thetas - 2)), I(0));
  const F outer = at - to_real(ring), inner = F(1.0) - outer;
  const I inner_ring = ring * I(view.phis * view.rows), outer_ring = inner_ring + I(view.phis * view.rows);
  if constexpr (kSlices == 2) {
    return {{inner, outer}, {inner_ring, outer_ring}};
  } else {
    // The position among the azimuths is a quarter of the turn, times their number.
    const F around = turn(place_on_half_circle(to), y) * F(0.25 * view.phis);
    const I first = max(min(to_int(around), I(view.phis - 1)), I(0));
    const F part = around - to_real(first);
    const I here = first * I(view.rows), next = next_around(first, view.phis - 1) * I(view.rows);
    // wo is between three of the cell's four corners, those of its half: the diagonal corners belong to both halves.
    const F beyond = part - inner;
    const auto far = less_or_equal(F(0.0), beyond);
    return {{min(part, inner), min(outer, F(1.0) - part), abs(beyond)},
            {inner_ring + next, outer_ring + here, if_true(far, outer_ring + next, inner_ring + here)}};
  }
}

/// A cell of a cumulative table with its bounds, summed over the slices with their weights.
template <int kSlices, class F, class I>
struct Interval {
  I index;
  F lower, mass;
  F slice_mass[kSlices];  // weighed
};

// An entry of a table is the cumulative probability at the lower end of a cell, in 1/65536; the first is 0,
// and what follows the last, the next row's first, is 0 for 65536.
template <int kSlices, class F, class I, class Edges>
SAMPLER_INLINE Interval<kSlices, F, I> interval_at(Edges table, const I (&start)[kSlices],
                                                   const F (&weight)[kSlices], I index) {
  Interval<kSlices, F, I> found;
  found.index = index;
  for (int s = 0; s < kSlices; ++s) {
    const auto edge = edge_pair(table, start[s] + index);
    const F lower = weight[s] * to_real(edge.lower), mass = weight[s] * to_real(edge.mass);
    found.slice_mass[s] = mass;
    found.lower = s == 0 ? lower : found.lower + lower;
    found.mass = s == 0 ? mass : found.mass + mass;
  }
  return found;
}

template <int kSlices, class F, class I, class Edges>
SAMPLER_INLINE Interval<kSlices, F, I> find_interval(Edges table, const I (&start)[kSlices],
                                                     const F (&weight)[kSlices], int count, F target) {
  // A target that is no number or below 0 falls into the first cell.
  return interval_at(table, start, weight, max(search(table, start, weight, count, target), I(0)));
}

/// Returns d(turn) / d(azimuth) at w: along the circle of M's images, which M turns by `narrowing` (of Ray).
template <class F>
SAMPLER_INLINE F turning(F w, F narrowing) {
  return F(0.5) * (F(1.0) + w * w) * narrowing;
}

/// A direction to the light and the map's density around it (of Ray).
template <class F>
struct Placed {
  F x, y, z, density;
};

/// Returns the direction at turn and v. For isotropic tables, the turn is from the azimuth of wo to the side that the
/// sign of `side` tells; `plane` is the arrow of wo's x and y.
template <bool kIsotropic, class F, class View>
SAMPLER_INLINE Placed<F> place(const View& view, F wo_x, F wo_y, F wo_z, const Arrow<F>& plane, F turned, F v,
                               F side) {
  // The turn gives the half vector's azimuth; M^-1 maps it back from the stretched circle.
  const F w = abs(turned - F(2.0)) - F(1.0);
  F x, y, length2, length, along,
      narrowing(1.0);  // (x, y): towards the azimuth, from that of wo if isotropic
  if constexpr (kIsotropic) {
    const auto axis = on_half_circle(w, side);
    x = axis.x;
    y = axis.y;
    length = axis.length;
    length2 = length * length;
    along = plane.length * x;
  } else {
    const auto axis = on_half_circle(w, F(2.0) - turned);
    x = F(view.yy) * axis.x - F(view.xy) * axis.y;  // M^-1
    y = F(view.xx) * axis.y - F(view.xy) * axis.x;
    length2 = x * x + y * y;
    length = sqrt(length2);
    narrowing = length2 / (axis.length * axis.length);
    along = wo_x * x + wo_y * y;
  }
  // v gives its polar angle, as m = tan^2(theta_h / 2), along the ray of that azimuth.
  const Ray<F> ray(view, narrowing, along, wo_z * length, wo_z * wo_z * length2);
  const F m = ray.from_unit(v);
  // wi = 2 (wo.h) h - wo is wo reflected about the half vector.
  const F norm = F(1.0) / (F(1.0) + m), cosine = (F(1.0) - m) * norm;
  const F sine = F(2.0) / length * norm * sqrt(m);  // over length
  const F to_half = along * sine + wo_z * cosine, twice = to_half + to_half;
  const F density = ray.density(m, to_half, turning(w, narrowing)), z = twice * cosine - wo_z;
  F across = twice * sine;
  if constexpr (kIsotropic) {
    across = across * (F(1.0) / plane.length);
    return {across * (x * plane.x - y * plane.y) - wo_x, across * (x * plane.y + y * plane.x) - wo_y, z,
            density};
  } else {
    return {across * x - wo_x, across * y - wo_y, z, density};
  }
}

template <class F>
struct Drawn {
  F x, y, z, pdf;
};

inline constexpr double kEdgeUnit = 65536;
/// Returns the number of cells over the half circles' turn and v, per square of an edge's unit.
SAMPLER_INLINE double cells_per_unit(int rows, int columns) {
  return 0.25 / (kEdgeUnit * kEdgeUnit) * rows * columns;
}

template <bool kIsotropic, class F, class I, class View>
SAMPLER_INLINE Drawn<F> draw(const View& view, F wo_x, F wo_y, F wo_z, F u_x, F u_y) {
  // A row is drawn by u_x, a column by u_y; both are found in cumulative tables that are mixed from the slices around
  // wo.
  constexpr int kSlices = kIsotropic ? 2 : 3;
  const Arrow<F> plane = arrow(wo_x, wo_y);
  const Mix<kSlices, F, I> mix = mix_for<kSlices, F, I>(view, wo_x, wo_y, wo_z);
  // A place in a cell is linear between its edges, so that numbers are used up evenly.
  const auto within = [](F target, const Interval<kSlices, F, I>& i) {
    return to_real(i.index) + max(min((target - i.lower) / i.mass, F(1.0)), F(0.0));
  };

  // The row comes first, then the place in it. Isotropic tables hold one side of the plane of wo; u_x < 1/2 is the
  // other.
  const F uniform = kIsotropic ? abs(u_x + u_x - F(1.0)) : u_x;
  const F row_target = uniform * F(kEdgeUnit);
  const auto row = find_interval<kSlices, F, I>(view.row_edges, mix.row, mix.weight, view.rows, row_target);
  const F around = within(row_target, row) * F(view.turn_per_row);

  // The column is drawn in that row. Each slice weighs by the mass that the row has in it.
  I start[kSlices];
  for (int s = 0; s < kSlices; ++s) start[s] = (mix.row[s] + row.index) * I(view.columns);
  const F column_target = u_y * row.mass * F(kEdgeUnit);
  const auto column =
      find_interval<kSlices, F, I>(view.cell_edges, start, row.slice_mass, view.columns, column_target);
  const F v = within(column_target, column) * F(view.per_column);

  // The pdf is the cell's density over turn and v times the map's density per solid angle; 0 below the horizon.
  const Placed<F> wi = place<kIsotropic>(view, wo_x, wo_y, wo_z, plane, around, v, u_x - F(0.5));
  const F cells = F(view.cells);
  return {wi.x, wi.y, wi.z, if_true(less_or_equal(wi.z, F(0.0)), F(0.0), column.mass * cells * wi.density)};
}

template <bool kIsotropic, class F, class I, class View>
SAMPLER_INLINE F density(const View& view, F wi_x, F wi_y, F wi_z, F wo_x, F wo_y, F wo_z) {
  constexpr int kSlices = kIsotropic ? 2 : 3;
  const Mix<kSlices, F, I> mix = mix_for<kSlices, F, I>(view, wo_x, wo_y, wo_z);
  // The half vector gives m = tan^2(theta_h / 2) and its azimuth, or M's image of it, as arrow() does. Lengths of
  // vectors are left in wherever only their ratios count.
  const F x = wi_x + wo_x + F(1e-15), y = wi_y + wo_y, z = wi_z + wo_z;
  const F across = x * x + y * y, norm = sqrt(across), length = sqrt(across + z * z), up = length + z;
  const F m = across / (up * up);
  Arrow<F> image;  // towards the azimuth from wo's, or what M makes of it
  F narrowing(1.0);
  if constexpr (kIsotropic) {
    const Arrow<F> plane = arrow(wo_x, wo_y);
    image = {x * plane.x + y * plane.y, abs(y * plane.x - x * plane.y), norm * plane.length};
  } else {
    image = {F(view.xx) * x + F(view.xy) * y, F(view.xy) * x + F(view.yy) * y, F(0.0)};
    const F stretched = image.x * image.x + image.y * image.y;
    image.length = sqrt(stretched);
    narrowing = across / stretched;
  }
  const F w = place_on_half_circle(image);
  const Ray<F> ray(view, narrowing, wo_x * x + wo_y * y, wo_z * norm, wo_z * wo_z * across);

  // turn and v = to_unit(m) give the cell that holds the half vector.
  const auto cell = [](F unit, int count) { return min(max(to_int(unit), I(0)), I(count - 1)); };
  const I row_index = cell(turn(w, image.y) * F(view.rows / (kIsotropic ? 2.0 : 4.0)), view.rows);
  const I column_index = cell(ray.to_unit(m) * F(view.columns), view.columns);
  const auto row = interval_at<kSlices, F, I>(view.row_edges, mix.row, mix.weight, row_index);
  I start[kSlices];
  for (int s = 0; s < kSlices; ++s) start[s] = (mix.row[s] + row_index) * I(view.columns);
  const auto column = interval_at<kSlices, F, I>(view.cell_edges, start, row.slice_mass, column_index);

  const F cells = F(view.cells);
  // The pdf is the same product as in draw(); wo.h is half the length of wi + wo.
  const F pdf = column.mass * cells * ray.density(m, F(0.5) * length, turning(w, narrowing));
  const F least = min(wi_z, wo_z);
  return if_true(less_or_equal(least, F(0.0)), F(0.0), pdf);
}
