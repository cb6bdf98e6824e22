// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/factors/table.h>
#include <burnish/image/image.h>

namespace burnish {

/// Smallest share of a table's largest value that factor_image shows brighter than black.
inline constexpr double kShownFactor = 0x1p-14;

/// A factor as a picture: brightness 1 + log2(lambda) / 14, so that every doubling is the same step and
/// kShownFactor is black. A line becomes a horizontal band, a disk or grid a square or rectangle, nodes
/// enlarged to about 256 pixels; the first three channels are red, green and blue, a single one grey.
Image8 factor_image(const Table& table);

}  // namespace burnish
