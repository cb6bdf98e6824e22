// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include <burnish/error.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/render/gl/gl_context.h>

namespace burnish {

/// A context for tests, or the reason for its absence.
struct TestContext {
  std::unique_ptr<GlContext> context;
  std::string reason;

  TestContext() {
    try {
      context = std::make_unique<GlContext>();
    } catch (const Error& error) {
      reason = error.what();
    }
  }
};

/// Returns a table's steepness: the largest ratio of neighbouring texels along an axis, less 1, summed over its axes.
inline double steepness(const Table& table) {
  const std::size_t sizes[] = {static_cast<std::size_t>(table.layout.width),
                               static_cast<std::size_t>(table.layout.height),
                               static_cast<std::size_t>(table.layout.depth)};
  double sum = 0;
  std::size_t step = table.channels;
  for (const std::size_t size : sizes) {
    double ratio = 1;
    for (std::size_t i = 0; i + step < table.values.size(); ++i) {
      if (i / step % size + 1 == size) continue;  // the last texel along this axis
      const auto [least, most] = std::minmax(table.values[i], table.values[i + step]);
      ratio = std::max(ratio, static_cast<double>(most) / least);
    }
    sum += ratio - 1;
    step *= std::max<std::size_t>(size, 1);
  }
  return sum;
}

/// Returns the error of filtered reads relative to f, if a texture unit has 8 bits for a position between two texels.
/// The error is 2^-9 of the steepness of each table that a lobe reads. Mesa's renderers have more bits.
inline double filter_error(const GlContext& context, const FactoredBrdf& brdf) {
  if (context.in_software()) return 0;
  double worst = 0;
  for (const Lobe& lobe : brdf.lobes()) {
    double sum = 0;
    for (const FactorUse& use : lobe.factors) sum += 0x1p-9 * steepness(brdf.tables()[use.table]);
    worst = std::max(worst, sum);
  }
  return worst;
}

}  // namespace burnish
