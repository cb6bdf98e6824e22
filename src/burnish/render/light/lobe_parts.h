// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// A lobe cut in two for light from all around: `outside` has its scale and the factors that depend on the
/// view alone, `inside` the others.
struct LobeParts {
  FactoredBrdf outside, inside;
};
LobeParts parts_of(const FactoredBrdf& brdf, const Lobe& lobe);

/// Parts, each of one lobe, of one model as the lobes of one that has their tables.
FactoredBrdf joined(std::span<const FactoredBrdf> parts);

/// f_r in three channels.
using Channels = std::array<double, 3>;
Channels eval_channels(const FactoredBrdf& brdf, Vec3 wi, Vec3 wo) noexcept;

}  // namespace burnish
