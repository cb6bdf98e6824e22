#pragma once

#include <cstddef>

#include <burnish/factors/model_spec.h>

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

/// FactoredBrdf::bytes of a model of the spec.
std::size_t bytes_of(const ModelSpec& spec, std::size_t texel_bytes, std::size_t channels);

}  // namespace burnish
