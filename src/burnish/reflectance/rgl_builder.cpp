// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/rgl_builder.h>

namespace burnish {
namespace {

constexpr double kFloor = 1e-6;
constexpr double kMaxTheta = radians(89);
constexpr int kSigmaTheta = 64, kSigmaPhi = 33;  // sigma is as smooth as a clamped cosine

double node(int i, int n) noexcept {
  return static_cast<double>(i) / (n - 1);
}
std::size_t index(int i) noexcept {
  return static_cast<std::size_t>(i);
}

/// Returns the mean over the channels; negative where the source is unknown.
double grey(BrdfRef source, Vec3 wi, Vec3 wo, std::vector<double>& f) {  // f: room for the channels
  if (!source.eval(wi, wo, f)) return -1;
  return std::max(0.0, std::accumulate(f.begin(), f.end(), 0.0) / static_cast<double>(f.size()));
}

/// Returns retro-reflection f(w, w) cos theta over the rows and columns of a normal distribution. Gaps take the value
/// beside them.
std::vector<double> retro_reflection(BrdfRef source, int rows, int columns) {
  std::vector<double> result(index(rows * columns));
  for_each_chunk(index(rows), 1, [&](std::size_t row, std::size_t, std::size_t) {
    std::vector<double> f(index(source.channels()));
    double* value = result.data() + row * index(columns);
    for (int i = 0; i < columns; ++i) {
      const double theta = std::min(rgl_theta(node(i, columns)), kMaxTheta);
      const Vec3 w = spherical_direction(theta, rgl_phi(rows > 1 ? node(static_cast<int>(row), rows) : 0.5));
      const double g = grey(source, w, w, f);
      value[i] = g < 0 ? (i > 0 ? value[i - 1] : -1) : g * std::cos(theta);
    }
    for (int i = columns - 2; i >= 0; --i)
      if (value[i] < 0) value[i] = value[i + 1];
  });
  if (std::all_of(result.begin(), result.end(), [](double v) { return v <= 0; }))
    std::fill(result.begin(), result.end(), 1.0);
  return result;
}

/// The normal distribution and its projected area, by power iteration.
struct Microfacets {
  RglGrid ndf, sigma;
};

/// A node of a quadrature over half vectors.
struct HalfNode {
  Vec3 m;
  double weight;
  std::size_t value;  ///< of the normal distribution
};

/// Returns a quadrature over half vectors by trapezoids in (u, v), with `around` azimuths and `columns` polar angles.
std::vector<HalfNode> half_nodes(int around, int columns, bool isotropic) {
  std::vector<HalfNode> nodes;
  for (int j = 0; j < around; ++j)
    for (int i = 0; i < columns; ++i) {
      const double u = node(i, columns), theta = rgl_theta(u);
      const double border = (i == columns - 1 ? 0.5 : 1) * (j == 0 || j == around - 1 ? 0.5 : 1);
      const double area =
          kPi * u * std::sin(theta) * kTwoPi / ((columns - 1.0) * (around - 1.0));  // dm / (du dv)
      nodes.push_back({spherical_direction(theta, rgl_phi(node(j, around))), border * area,
                       index((isotropic ? 0 : j) * columns + i)});
    }
  return nodes;
}

/// Returns D from retro-reflection, f cos = D / (4 sigma), scaled to a projected area of 1.
std::vector<double> distribution_of(const std::vector<double>& retro, int rows, int columns,
                                    const RglGrid& sigma, const std::vector<HalfNode>& nodes) {
  std::vector<double> ndf(retro.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = index(j * columns + i);
      ndf[at] = retro[at] * rgl_lookup(sigma, {node(i, columns), rows > 1 ? node(j, rows) : 0.5});
    }
  // D is kept positive, then divided by its projected area, the integral of D(m) m.z.
  const double least = kFloor * *std::max_element(ndf.begin(), ndf.end());
  for (double& d : ndf) d = std::max(d, least);
  double projected = 0;
  for (const HalfNode& n : nodes) projected += n.weight * ndf[n.value] * n.m.z;
  for (double& d : ndf) d /= projected;
  return ndf;
}

/// Returns sigma(w) = integral of D(m) max(0, m.w), in `rows` rows of azimuth.
std::vector<float> projected_areas(const std::vector<double>& ndf, int rows,
                                   const std::vector<HalfNode>& nodes) {
  std::vector<float> sigma(index(rows * kSigmaTheta));
  for_each_chunk(sigma.size(), 16, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const int i = static_cast<int>(k) % kSigmaTheta, j = static_cast<int>(k) / kSigmaTheta;
      const Vec3 w =
          spherical_direction(rgl_theta(node(i, kSigmaTheta)), rgl_phi(rows > 1 ? node(j, rows) : 0.5));
      double sum = 0;
      for (const HalfNode& n : nodes) sum += n.weight * ndf[n.value] * std::max(0.0, dot(n.m, w));
      sigma[k] = static_cast<float>(sum);
    }
  });
  return sigma;
}

/// Repeats a single row, as grids have two at least.
template <class T>
void repeat_row(std::vector<T>& values) {
  const std::vector<T> row = values;
  values.insert(values.end(), row.begin(), row.end());
}

Microfacets find_microfacets(BrdfRef source, const RglOptions& options) {
  const bool isotropic = source.isotropic();
  const int columns = options.ndf_theta, rows = isotropic ? 1 : options.ndf_phi,
            sigma_rows = isotropic ? 1 : kSigmaPhi;
  const auto retro = retro_reflection(source, rows, columns);
  const std::vector<HalfNode> nodes = half_nodes(isotropic ? 65 : rows, columns, isotropic);

  Microfacets result{{columns, isotropic ? 2 : rows, {}}, {kSigmaTheta, isotropic ? 2 : kSigmaPhi, {}}};
  result.sigma.values.assign(index(result.sigma.height * kSigmaTheta), 1);
  std::vector<double> ndf(retro.size());
  // Power iteration: D depends on sigma by retro-reflection, and sigma on D by projection.
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    ndf = distribution_of(retro, rows, columns, result.sigma, nodes);
    result.sigma.values = projected_areas(ndf, sigma_rows, nodes);
    if (isotropic) repeat_row(result.sigma.values);
  }
  result.ndf.values.assign(ndf.begin(), ndf.end());
  if (isotropic) repeat_row(result.ndf.values);
  return result;
}

/// Adds the density of the visible normals in (u, v), D(m) max(0, m.wi) dm / (du dv) [Dupuy 2018, sec. 4].
void add_visible_normals(const RglGrid& ndf, Vec3 wi, RglGrid& vndf) {
  std::vector<double> slice;
  for (int j = 0; j < vndf.height; ++j)
    for (int i = 0; i < vndf.width; ++i) {
      const Point2 p{node(i, vndf.width), node(j, vndf.height)};
      const double theta = rgl_theta(p.x);
      const Vec3 m = spherical_direction(theta, rgl_phi(p.y));
      slice.push_back(rgl_lookup(ndf, p) * std::max(0.0, dot(m, wi)) * std::sin(theta) * p.x);
    }
  const double sum = std::accumulate(slice.begin(), slice.end(), 0.0);
  for (double value : slice) vndf.values.push_back(static_cast<float>(value / sum));
}

/// Gives every node of a slice that is not valid the mean of its valid neighbours, ring by ring.
void fill_gaps(std::span<float> values, std::vector<std::uint8_t> valid, int side, std::size_t channels) {
  for (bool changed = true; changed;) {
    changed = false;
    const auto before = valid;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const auto at = index(y * side + x);
        if (before[at]) continue;
        int count = 0;
        for (const auto& [nx, ny] : {std::pair(x - 1, y), {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
          const auto neighbour = index(ny * side + nx);
          if (nx < 0 || ny < 0 || nx >= side || ny >= side || !before[neighbour]) continue;
          for (std::size_t c = 0; c < channels; ++c)
            values[at * channels + c] += values[neighbour * channels + c];
          ++count;
        }
        if (count == 0) continue;
        for (std::size_t c = 0; c < channels; ++c) values[at * channels + c] /= static_cast<float>(count);
        valid[at] = 1;
        changed = true;
      }
  }
}

/// Returns the direction of a slice, a little above the horizon.
Vec3 incident(const RglData& data, std::size_t slice) {
  const auto theta = static_cast<double>(data.theta_i[slice % data.theta_i.size()]);
  return spherical_direction(std::min(theta, kMaxTheta),
                             static_cast<double>(data.phi_i[slice / data.theta_i.size()]));
}

void check(BrdfRef source, const RglOptions& o) {
  const auto channels = index(source.channels());
  if (!(o.theta_i_count >= 2 && o.ndf_theta >= 2 && o.ndf_phi >= 2 && o.resolution >= 2 &&
        o.iterations >= 1 && (source.isotropic() || o.phi_i_count >= 3)))
    throw Error("RGL table: expected sizes of at least 2, 3 azimuths and 1 iteration");
  if (o.reduction != 1 && o.reduction != 2 && o.reduction != 4)
    throw Error("RGL table: expected a reduction of 1, 2 or 4, found " + std::to_string(o.reduction));
  if (o.lambda_nm.empty() ? channels != 1 && channels != 3 : channels != o.lambda_nm.size())
    throw Error("RGL table: expected a wavelength for each of " + std::to_string(channels) + " channels");
}

/// Directions, sizes and microfacets; the tables of visible normals.
RglData start_data(BrdfRef source, const RglOptions& options) {
  RglData data;
  data.description = options.description;
  data.lambda_nm = options.lambda_nm;
  data.channels = source.channels();
  const int phis = source.isotropic() ? 1 : options.phi_i_count;
  for (int p = 0; p < phis; ++p)
    data.phi_i.push_back(
        source.isotropic() ? 0 : static_cast<float>(-kPi + kTwoPi / options.reduction * node(p, phis)));
  for (int t = 0; t < options.theta_i_count; ++t)
    data.theta_i.push_back(static_cast<float>(kHalfPi * node(t, options.theta_i_count)));

  auto [ndf, sigma] = find_microfacets(source, options);
  data.ndf = std::move(ndf);
  data.sigma = std::move(sigma);

  data.vndf = {options.ndf_theta, options.ndf_phi, {}};
  for (int slice = 0; slice < phis * options.theta_i_count; ++slice)
    add_visible_normals(data.ndf, incident(data, index(slice)), data.vndf);
  return data;
}

}  // namespace

RglTable make_rgl_table(BrdfRef source, const RglOptions& options) {
  check(source, options);
  RglData data = start_data(source, options);
  const std::size_t slices = data.phi_i.size() * data.theta_i.size();
  const int side = options.resolution;
  const auto channels = index(source.channels()), nodes = index(side * side);
  const ConditionalWarp2 warp(data.vndf.width, data.vndf.height, data.vndf.values);

  // Every slice takes the source's values at the half vectors that the warp makes of evenly spaced nodes.
  data.spectra = {side, side, std::vector<float>(slices * nodes * channels)};
  data.luminance = {side, side, std::vector<float>(slices * nodes)};
  std::vector<std::uint8_t> valid(slices * nodes);
  for_each_chunk(slices, 1, [&](std::size_t slice, std::size_t, std::size_t) {
    const Vec3 wi = incident(data, slice);
    const double sigma_i = rgl_lookup(data.sigma, rgl_square(theta_of(wi), std::atan2(wi.y, wi.x)));
    const SliceMix mix{{static_cast<std::uint32_t>(slice)}, {1}, 1};
    const auto values = std::span(data.spectra.values).subspan(slice * nodes * channels, nodes * channels);
    std::vector<double> f(channels);
    std::vector<std::uint8_t> known(nodes);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const auto at = index(y * side + x);
        const Point2 half = warp.warp({node(x, side), node(y, side)}, mix);
        const Vec3 h = spherical_direction(rgl_theta(half.x), rgl_phi(half.y));
        const Vec3 wo = normalize(2 * dot(wi, h) * h - wi);
        known[at] = wo.z > 0 && source.eval(wi, wo, f);
        if (!known[at]) continue;
        // Stored values are f cos(theta_o) 4 sigma / D, which evaluation divides out.
        const double scale = wo.z * 4 * sigma_i / rgl_lookup(data.ndf, half);
        for (std::size_t c = 0; c < channels; ++c)
          values[at * channels + c] = static_cast<float>(scale * f[c]);
      }

    // The mask of known nodes is kept, gaps are filled, and the luminance is the mean over the channels.
    std::copy(known.begin(), known.end(), valid.begin() + static_cast<std::ptrdiff_t>(slice * nodes));
    fill_gaps(values, std::move(known), side, channels);
    for (std::size_t i = 0; i < nodes; ++i)
      data.luminance.values[slice * nodes + i] =
          std::max(0.0f, std::accumulate(&values[i * channels], &values[i * channels] + channels, 0.0f) /
                             static_cast<float>(channels));
  });

  data.valid.resize((valid.size() + 7) / 8);
  for (std::size_t i = 0; i < valid.size(); ++i)
    data.valid[i / 8] |= static_cast<std::uint8_t>(valid[i] << (7 - i % 8));
  return RglTable(std::move(data));
}

}  // namespace burnish
