// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>

#include <burnish/capture/texels/normal_steps.h>

namespace burnish {

namespace {

constexpr float kNormalDelta = 0.01f;  // step of finite differences
constexpr double kMaxSlope = 0.95;     // length of a normal's x and y
constexpr double kMaxStep = 0.15;
constexpr double kDamping = 1e-2, kEase = 0.4, kHarden = 8;

}  // namespace

void NormalSteps::run(float* normals, int steps) {
  const TexelRange range = block_.range();
  const std::size_t lobes = block_.lobes();
  const std::span<TexelRow> weights = block_.weights();
  std::vector<float> best_weights(range.count * lobes), best_normals(2 * range.count);
  Sums best, damping;
  best.fill(INFINITY);
  damping.fill(kDamping);
  for (int number = 0; number <= steps; ++number) {
    if (number > 0) {
      step(normals, damping);
      block_.fit_weights(1, TexelBlock::kLastPass);
    }
    // The rule of Levenberg and Marquardt is applied to each texel. A step that lowers the cost is kept and reduces
    // the damping. A step that raises it is taken back and increases the damping.
    const Sums found = block_.costs();
    bool taken_back = false;
    for (std::size_t i = 0; i < range.count; ++i) {
      float* const n = normals + 2 * (range.first + i);
      const std::span<float> kept(&best_weights[i * lobes], lobes);
      if (found[i] < best[i]) {
        best[i] = found[i];
        damping[i] *= kEase;
        for (std::size_t j = 0; j < lobes; ++j) kept[j] = weights[j][i];
        std::copy_n(n, 2, &best_normals[2 * i]);
      } else {
        damping[i] *= kHarden;
        taken_back = true;
        for (std::size_t j = 0; j < lobes; ++j) weights[j][i] = kept[j];
        std::copy_n(&best_normals[2 * i], 2, n);
      }
    }
    if (taken_back) block_.see(normals);
  }
}

/// Takes a damped Gauss-Newton step for every normal. Its unknowns are the normal and the weights; the weights are
/// eliminated.
void NormalSteps::step(float* normals, const Sums& damping) {
  // The model's slopes along x and y are differences to the lobes' values under moved normals.
  for (auto& moved : moved_) moved.resize(block_.model().size());
  block_.see_moved(normals, kNormalDelta, 0, moved_[0]);
  block_.see_moved(normals, 0, kNormalDelta, moved_[1]);
  block_.find_equations(TexelBlock::kLastPass);
  const NormalSums sums = normal_sums();
  for (std::size_t i = 0; i < block_.range().count; ++i) {
    // Two damped equations are left for the normal: its own matrix, minus the part that the weights take up.
    Eigen::Matrix2d a;
    a << sums.xx[i], sums.xy[i], sums.xy[i], sums.yy[i];
    const double damp = damping[i] * a.trace() + 1e-30;
    a -= eliminated(i, sums);
    a.diagonal().array() += damp;
    const Eigen::Vector2d way =
        static_cast<double>(kNormalDelta) * a.ldlt().solve(Eigen::Vector2d(sums.x[i], sums.y[i]));
    if (!way.allFinite()) continue;
    // The normal moves by at most kMaxStep, and its x and y stay within kMaxSlope.
    const double share = std::min(1.0, kMaxStep / std::max(way.norm(), 1e-12));
    float* const n = normals + 2 * (block_.range().first + i);
    const double x = static_cast<double>(n[0]) + share * way.x(),
                 y = static_cast<double>(n[1]) + share * way.y();
    const double within = std::min(1.0, kMaxSlope / std::max(std::hypot(x, y), 1e-12));
    n[0] = static_cast<float>(within * x);
    n[1] = static_cast<float>(within * y);
  }
  block_.see(normals);
}

NormalSteps::NormalSums NormalSteps::normal_sums() const {
  NormalSums sums;
  sums.cross_x.resize(block_.lobes());
  sums.cross_y.resize(block_.lobes());
  for (std::size_t k = 0; k < block_.pictures().size(); ++k)
    for (std::size_t c = 0; c < kCaptureChannels; ++c) add_picture(k, c, sums);
  return sums;
}

void NormalSteps::add_picture(std::size_t k, std::size_t c, NormalSums& sums) const {
  const std::size_t lobes = block_.lobes();
  const std::span<const float> model = block_.model();
  const std::span<const TexelRow> weights = block_.weights();
  const TexelBlock::Terms terms = block_.terms_of(k, c, TexelBlock::kLastPass);
  const std::size_t first = (k * lobes * kCaptureChannels + c) * kTexelLanes,
                    stride = kCaptureChannels * kTexelLanes;
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    // sx and sy are the changes of the model when the normal moves by kNormalDelta along x and along y.
    float sx = 0, sy = 0;
    for (std::size_t j = 0; j < lobes; ++j) {
      const std::size_t at = first + j * stride + i;
      sx += weights[j][i] * (moved_[0][at] - model[at]);
      sy += weights[j][i] * (moved_[1][at] - model[at]);
    }
    // The sums are those of the Gauss-Newton equations for the normal.
    const float omega = terms.omega[i] * block_.trust(k, i), rest = terms.value[i] - terms.model[i];
    sums.xx[i] += static_cast<double>(omega * sx * sx);
    sums.xy[i] += static_cast<double>(omega * sx * sy);
    sums.yy[i] += static_cast<double>(omega * sy * sy);
    sums.x[i] += static_cast<double>(omega * sx * rest);
    sums.y[i] += static_cast<double>(omega * sy * rest);
    // The mixed sums couple the normal with the weights.
    for (std::size_t j = 0; j < lobes; ++j) {
      const float lobe = omega * model[first + j * stride + i];
      sums.cross_x[j][i] += static_cast<double>(lobe * sx);
      sums.cross_y[j][i] += static_cast<double>(lobe * sy);
    }
  }
}

/// Returns the part of a texel's matrix of the normal that the weights take up: those that are not 0.
Eigen::Matrix2d NormalSteps::eliminated(std::size_t i, const NormalSums& sums) const {
  constexpr int kMax = static_cast<int>(kMaxSurfaceLobes);
  constexpr double kAlike = 1e-4;  // lobes may be alike
  // Weights of 0 stay there.
  std::array<std::size_t, kMaxSurfaceLobes> free;
  Eigen::Index count = 0;
  for (std::size_t j = 0; j < block_.lobes(); ++j)
    if (block_.weights()[j][i] > 0) free[static_cast<std::size_t>(count++)] = j;
  // W is the matrix of the free weights, C that of their products with the normal.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMax, kMax> own(count, count);
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::ColMajor, kMax, 2> with(count, 2);
  for (Eigen::Index r = 0; r < count; ++r) {
    const std::size_t j = free[static_cast<std::size_t>(r)];
    for (Eigen::Index q = 0; q <= r; ++q)
      own(r, q) = own(q, r) =
          static_cast<double>(block_.matrix()[j * (j + 1) / 2 + free[static_cast<std::size_t>(q)]][i]);
    with(r, 0) = sums.cross_x[j][i];
    with(r, 1) = sums.cross_y[j][i];
  }
  own.diagonal().array() += kAlike * own.trace() + 1e-30;
  // Eliminating the weights subtracts C^T W^-1 C from the normal's matrix; the rest is the Schur complement.
  return with.transpose() * own.ldlt().solve(with);
}

}  // namespace burnish
