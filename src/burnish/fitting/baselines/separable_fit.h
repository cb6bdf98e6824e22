// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/fitting/baselines/pair_grid.h>

namespace burnish {

/// The ways to split a resampled BRDF into tables.
enum class Decomposition {
  svd,  ///< singular values, terms of both signs: least mean square [Kautz 1999]
  nd,   ///< normalized decomposition, one positive term in one pass [Kautz 1999]
  nmf,  ///< nonnegative factors, weighted towards dark values [Lawrence 2004]
};

std::string_view to_string(Decomposition method) noexcept;

/// Which tables the channels share.
enum class Coupling { none, u, v };

/// Decomposes one grid into `terms` terms (nd: 1) and rounds them to half floats. `terms` is cut to what the
/// matrix has.
SeparableBrdf decompose(const PairGrid& grid, Decomposition method, Coupling coupling, std::size_t terms);

struct SeparableOptions {
  std::size_t budget = 2640;  ///< bytes
  std::uint64_t seed = 1;
  int image_size = 64;                                 ///< of the lit spheres that layouts are compared by
  std::function<void(double fraction)> progress = {};  ///< called with rising shares of the work
};

struct SeparableFit {
  SeparableBrdf brdf;
  std::size_t tried = 0;  ///< layouts compared
};

/// The decomposition of at most `budget` bytes that makes the best pictures (psnr of small lit
/// spheres), found by hill climbing over how the coordinates are split between u and v, sizes, terms and
/// shared channels. Isotropic sources are split as θ_h | (θ_d, φ_d), (θ_h, θ_d) | φ_d, θ_d | (θ_h, φ_d),
/// φ_d folded to a quarter circle or, where they are not their own mirror image, to half a circle;
/// anisotropic ones, on disks of h and d, as h | d and (h, θ_d) | φ_d. The source should be reciprocal: the
/// result is. Deterministic. Throws Error if no layout fits the budget or the source knows nothing.
SeparableFit fit_separable(BrdfRef source, Decomposition method, const SeparableOptions& options);

}  // namespace burnish
