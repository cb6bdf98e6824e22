// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <burnish/capture/texels/texel_block.h>

namespace burnish {

/// Finds the normals of a block's texels, together with their weights, by damped Gauss-Newton steps.
class NormalSteps {
 public:
  explicit NormalSteps(TexelBlock& block) : block_(block) {}

  /// Takes `steps` steps from the present normals and weights. `normals` has x and y of all samples' texels,
  /// [texel][2]. A step that raises a texel's cost is taken back.
  void run(float* normals, int steps);

 private:
  using Sums = std::array<double, kTexelLanes>;
  /// Sums for a texel's normal: the matrix, the right side, and the products with the weights, by differences of
  /// kNormalDelta.
  struct NormalSums {
    Sums xx{}, xy{}, yy{}, x{}, y{};
    std::vector<Sums> cross_x, cross_y;  // [lobe]
  };

  void step(float* normals, const Sums& damping);
  NormalSums normal_sums() const;
  void add_picture(std::size_t picture, std::size_t channel, NormalSums& sums) const;
  Eigen::Matrix2d eliminated(std::size_t i, const NormalSums& sums) const;

  TexelBlock& block_;
  std::array<std::vector<float>, 2> moved_;  // values of the lobes under normals moved along x and y
};

}  // namespace burnish
