#pragma once

#include <cstddef>
#include <optional>

#include <burnish/factors/byte_count.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/choosing/cost_limit.h>

namespace burnish {

/// How a volume's nodes are shared out among theta_h, theta_d and the azimuth, relative to each other.
struct VolumeForm {
  double half, difference, azimuth;
};

/// Of theta_h. Shaders take a root where other powers take a logarithm.
inline constexpr Warp kHalfRootWarp{WarpKind::power, 0.5};
/// Of hemispheres of half vectors.
inline constexpr Warp kHalfDiskWarp{WarpKind::rational, 0.25};

/// The largest volume of about a form within `nodes`, spaced along theta_h by kHalfRootWarp; narrower than two nodes
/// where they are too few.
TableLayout volume_of(const VolumeForm& form, double nodes);

/// The spec with about this share of the nodes of each volume and disk, in (0, 1].
ModelSpec at_fewer_nodes(ModelSpec spec, double share);

/// A model of hemispheres in the notation of parse_model_spec, and its tables' shares of the texels, in [0, 1) together.
struct ProductForm {
  const char* model;
  double border = 0;      ///< of p(wo) p(wi) or s(wo) s(wi)
  double difference = 0;  ///< of all tables of the difference together
};

/// The form's tables laid out within the limit's bytes, see model_bytes. Hemispheres of half vectors take what the
/// other tables leave. None where the bytes are too few. The limit's fetches do not count.
std::optional<ModelSpec> lay_out(const ProductForm& form, const CostLimit& limit, std::size_t channels);

}  // namespace burnish
