// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/open_options.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/scattered_brdf.h>

namespace burnish {

/// Traps unless the source's values are finite. Values may be negative only where they are raw.
inline void check_values(BrdfRef source) {
  std::vector<double> f(source.channels());
  for (const double theta : {0.0, 0.7, 1.5707})
    for (const double phi : {-kPi, 0.1, 3.0}) {
      const Vec3 wi = spherical_direction(theta, phi), wo = spherical_direction(0.5, 1);
      source.eval(wi, wo, f);
      for (const double value : f)
        if (!std::isfinite(value) || value < 0) __builtin_trap();
      source.unclamped().eval(wi, wo, f);
      for (const double value : f)
        if (!std::isfinite(value)) __builtin_trap();
    }
}

inline void check(const Samples& samples) {
  check_values(ScatteredBrdf(samples));
}

template <Brdf T>
void check(const T& table) {
  check_values(table);
}

/// Checks that any bytes either throw Error or make a source with sound values. Another exception ends the run. The
/// size picks the options, part and band among them.
template <class Parse>
int fuzz(const std::uint8_t* data, std::size_t size, const Parse& parse) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  const FileBytes file{"fuzzed file", {bytes, bytes + size}};
  OpenOptions options;
  options.keep_spectral = size % 2 == 0;
  options.has_cosine = size % 5 == 0;
  options.has_cosine_o = size % 5 == 1;
  options.brf = size % 5 == 2;
  options.back_side = size % 7 == 0;
  options.illuminant = size % 11 == 0 ? "D65" : "E";
  constexpr std::array kBands{"", "", "visible", "Solar", "CIE-XYZ", "CIE-Z"};
  if (size % 3 == 0) options.part = kBsdfParts[size / 3 % kBsdfParts.size()];
  options.band = kBands[size / 12 % kBands.size()];
  options.scale_to_tis = size % 13 == 0;
  try {
    parse(file, options);
  } catch (const Error&) {
  }
  return 0;
}

}  // namespace burnish
