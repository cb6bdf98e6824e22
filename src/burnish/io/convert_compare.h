// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <burnish/reflectance/brdf.h>
#include <burnish/source.h>

namespace burnish {

/// The number of pairs at which a conversion is compared with its source.
inline constexpr std::size_t kComparedPairs = 2000;

/// The luminance of an RGB source, the value of a grey one.
struct Luminance {
  BrdfRef source;

  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return source.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

/// Returns the figure `relative` over `count` drawn pairs where both BRDFs are known; nothing if there are none.
std::optional<double> relative_difference(BrdfRef a, BrdfRef b, std::size_t count);

/// Returns true if the channels differ at any of the drawn pairs.
bool has_colour(BrdfRef brdf);

/// Returns the name that the source has in its file, or its file's name without folders.
std::string sample_name(const Source& source);

}  // namespace burnish
