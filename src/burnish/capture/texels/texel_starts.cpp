// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include <burnish/capture/texels/texel_starts.h>
#include <burnish/math/angles.h>
#include <burnish/math/k_means.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {

namespace {

constexpr double kWhitePercentile = 0.97;
constexpr double kGlossWidths[] = {0.08, 0.2, 0.45};  // alpha of GGX
constexpr int kGlossNodes = 48;
constexpr std::size_t kGroupsPerLobe = 12, kMaxTexelGroups = 96, kMinTexels = 24;

/// Returns the groups that stand out: first the farthest from 0, then always the farthest from the span of the
/// previous ones (successive projections [Araujo2001]). Small groups are skipped, since their texels are odd.
std::vector<std::size_t> corners(const Groups& groups, std::size_t count, std::size_t least_size) {
  Points rest = groups.centres;
  std::vector<std::size_t> found;
  while (found.size() < count) {
    std::size_t best = rest.size;
    double farthest = -1;
    for (std::size_t g = 0; g < rest.size; ++g) {
      const std::vector<double> zero(rest.coordinates);
      const double far = squared_distance(rest[g], zero);
      const bool taken = std::ranges::find(found, g) != found.end();
      if (!taken && groups.sizes[g] >= least_size && far > farthest) {
        farthest = far;
        best = g;
      }
    }
    if (best == rest.size) {
      if (least_size == 0) break;
      least_size = 0;  // odd groups are better than none
      continue;
    }
    found.push_back(best);
    const std::vector<double> along(rest[best].begin(), rest[best].end());
    const double square = std::inner_product(along.begin(), along.end(), along.begin(), 0.0);
    for (std::size_t g = 0; g < rest.size && square > 0; ++g) {
      const double share = std::inner_product(along.begin(), along.end(), rest[g].begin(), 0.0) / square;
      for (std::size_t d = 0; d < rest.coordinates; ++d) rest[g][d] -= share * along[d];
    }
  }
  return found;
}

}  // namespace

double exposure_of(const TexelSamples& samples, const CaptureForm& form) {
  std::vector<float> values;
  for (std::size_t p = 0; p < samples.pictures; ++p) {
    if (form.pictures[p].held_out) continue;
    for (std::size_t t = 0; t < samples.size(); ++t) {
      const std::size_t pixel = p * samples.size() + t;
      if (!is_there(samples.states[pixel])) continue;
      values.insert(values.end(), &samples.values[3 * pixel], &samples.values[3 * pixel] + 3);
    }
  }
  const double white = values.empty() ? 0 : percentile(std::move(values), kWhitePercentile);
  return white > 0 ? 1 / white : 1;
}

std::vector<float> diffuse_normals(const TexelSamples& samples, const CaptureForm& form) {
  constexpr int kPasses = 8;
  constexpr double kRound = 0.02, kMaxSlope = 0.866;  // kRound is a share of the mean value
  std::vector<float> normals(2 * samples.size());
  for_each_chunk(samples.size(), 64, [&](std::size_t, std::size_t begin, std::size_t end) {
    struct Row {
      Vec3 light;
      double value;
    };
    std::vector<Row> rows;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3 point = form.point(samples.texels[t][0], samples.texels[t][1]);
      rows.clear();
      double mean = 0;
      for (std::size_t p = 0; p < samples.pictures; ++p) {
        const std::size_t pixel = p * samples.size() + t;
        if (form.pictures[p].held_out || samples.states[pixel] != PixelState::there) continue;
        const float* const rgb = &samples.values[3 * pixel];
        rows.push_back({samples.seen(form.pictures[p], p, t, point).wi,
                        static_cast<double>(rgb[0] + rgb[1] + rgb[2]) / 3});
        mean += rows.back().value;
      }
      if (rows.size() < 4) continue;
      mean /= static_cast<double>(rows.size());
      // The unknowns are albedo times normal. Least squares are reweighted towards least absolute errors.
      Eigen::Vector3d b(0, 0, mean);
      for (int pass = 0; pass < kPasses; ++pass) {
        Eigen::Matrix3d a = 1e-9 * Eigen::Matrix3d::Identity();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (const Row& row : rows) {
          const Eigen::Vector3d l(row.light.x, row.light.y, row.light.z);
          const double rest = std::abs(row.value - std::max(0.0, b.dot(l)));
          const double weight = pass == 0 ? 1 : 1 / (rest + kRound * mean);
          a += weight * l * l.transpose();
          right += weight * row.value * l;
        }
        b = a.ldlt().solve(right);
      }
      Vec3 n = normalize({b.x(), b.y(), std::max(b.z(), 1e-6 * mean)});
      const double slope = std::hypot(n.x, n.y), within = std::min(1.0, kMaxSlope / std::max(slope, 1e-12));
      normals[2 * t] = static_cast<float>(within * n.x);
      normals[2 * t + 1] = static_cast<float>(within * n.y);
    }
  });
  return normals;
}

FactoredBrdf general_lobes() {
  std::vector<Table> tables;
  std::vector<Lobe> lobes;
  for (std::size_t c = 0; c < 3; ++c) {
    Lobe diffuse{.scale = {0, 0, 0}, .factors = {}};
    diffuse.scale[c] = 1 / kPi;
    lobes.push_back(diffuse);
  }
  for (const double alpha : kGlossWidths) {
    // The table has the shape of GGX's distribution [Walter2007], 1 at the normal.
    Table table{.name = fmt::format("d{}", tables.size()),
                .layout = {.width = kGlossNodes, .warp = {WarpKind::power, 0.5}, .warp_y = {}, .warp_z = {}},
                .channels = 1,
                .values = {}};
    for (int x = 0; x < kGlossNodes; ++x) {
      const double z = node_direction(table.layout, x, 0).z, square = alpha * alpha;
      const double shape = square / (z * z * (square - 1) + 1);
      table.values.push_back(static_cast<float>(shape * shape));
    }
    for (std::size_t c = 0; c < 3; ++c) {
      Lobe glossy{
          .scale = {0, 0, 0},
          .factors = {
              {.table = tables.size(), .projection = kProjectHalf, .projection_y = {}, .projection_z = {}}}};
      glossy.scale[c] = 1 / (4 * kPi * alpha * alpha);
      lobes.push_back(glossy);
    }
    tables.push_back(std::move(table));
  }
  return FactoredBrdf(3, std::move(tables), std::move(lobes), TableFormat::single);
}

std::vector<std::vector<std::size_t>> pure_texels(const TexelSamples& samples, const CaptureForm& form,
                                                  const std::vector<float>& normals, double exposure,
                                                  std::size_t count) {
  const TexelSolver solver(general_lobes(), form, exposure);
  const TexelFits fits = solver.solve(samples, normals, {.passes = 2});

  // The points are the shares of each lobe, so that mixtures lie between their parts.
  Points points{samples.size(), solver.lobes(),
                std::vector<double>(fits.weights.begin(), fits.weights.end())};
  std::vector<double> mean(points.coordinates);
  for (std::size_t i = 0; i < points.size; ++i)
    for (std::size_t d = 0; d < points.coordinates; ++d)
      mean[d] += points[i][d] / static_cast<double>(points.size);
  const double all = std::accumulate(mean.begin(), mean.end(), 0.0);
  for (std::size_t i = 0; i < points.size; ++i) {
    double sum = 0;
    for (std::size_t d = 0; d < points.coordinates; ++d) {
      points[i][d] /= std::sqrt(mean[d] * all) + 1e-9 * all + 1e-30;
      sum += points[i][d];
    }
    for (double& value : points[i]) value /= sum + 1e-30;
  }

  const std::size_t group_count = std::min({count * kGroupsPerLobe, kMaxTexelGroups, points.size});
  const Groups groups = grouped(points, group_count);
  const std::size_t least = std::max<std::size_t>(3, points.size / (8 * group_count));
  std::vector<std::vector<std::size_t>> sets;
  for (const std::size_t g : corners(groups, std::min(count, group_count), least)) {
    // A set is the texels nearest to the group's centre.
    std::vector<std::size_t> order(points.size);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> far(points.size);
    for (std::size_t i = 0; i < points.size; ++i) far[i] = squared_distance(points[i], groups.centres[g]);
    const std::size_t size =
        std::min(points.size, std::max({kMinTexels, groups.sizes[g], points.size / (8 * count)}));
    std::ranges::nth_element(
        order, order.begin() + static_cast<std::ptrdiff_t>(size - 1),
        [&](std::size_t a, std::size_t b) { return std::pair(far[a], a) < std::pair(far[b], b); });
    order.resize(size);
    std::ranges::sort(order);
    sets.push_back(std::move(order));
  }
  while (sets.size() < count) sets.push_back(sets.front());
  return sets;
}

}  // namespace burnish
