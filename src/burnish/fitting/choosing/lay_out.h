// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <burnish/factors/byte_count.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/choosing/cost_limit.h>

namespace burnish {

/// The relative numbers of a volume's nodes along theta_h, theta_d and the azimuth.
struct VolumeForm {
  double half, difference, azimuth;
};

/// The spacing along theta_h. Shaders compute a root here; other powers need a logarithm.
inline constexpr Warp kHalfRootWarp{WarpKind::power, 0.5};
/// The spacing of hemispheres of half vectors.
inline constexpr Warp kHalfDiskWarp{WarpKind::rational, 0.25};

/// Returns the largest volume of about a form within `nodes`, spaced along theta_h by kHalfRootWarp. If the nodes are
/// too few, it is narrower than two nodes.
TableLayout volume_of(const VolumeForm& form, double nodes);

/// Returns the spec with about this share of the nodes of each volume and disk, in (0, 1].
ModelSpec at_fewer_nodes(ModelSpec spec, double share);

/// A model of hemispheres in the notation of parse_model_spec, with its tables' shares of the texels. Their sum is in
/// [0, 1).
struct ProductForm {
  const char* model;
  double border = 0;      ///< share of p(wo) p(wi) or s(wo) s(wi)
  double difference = 0;  ///< share of all tables of the difference together
};

/// Lays out the form's tables within the limit's bytes, see model_bytes. Hemispheres of half vectors take what the
/// other tables leave. None if the bytes are too few. The limit's fetches do not count.
std::optional<ModelSpec> lay_out(const ProductForm& form, const CostLimit& limit, std::size_t channels);

}  // namespace burnish
