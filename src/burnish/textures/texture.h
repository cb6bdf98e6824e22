// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <burnish/factors/table.h>

namespace burnish {

/// The data of a GPU's texture, mostly of one table.
struct Texture {
  TableFormat format = TableFormat::single;
  std::size_t channels = 1;  ///< 1 or 3
  int width = 0, height = 0;
  int depth = 0;  ///< > 0: 3-D
  int faces = 1;  ///< 6: a cube map, +x -x +y -y +z -z as OpenGL and KTX2 have them
  /// Level l: [face or z][y][x][channel], sides halved l times, at least 1.
  std::vector<std::vector<float>> levels;
};

/// The table as it is, texel (x, y) node (x, y), of a volume (x, y, z). With `mips` levels follow down to one texel,
/// each value the mean of the factor over the texel's footprint in the measure of the directions it stands for: solid
/// angle of the hemisphere (line, disk), product of the directions' solid angles (grid, volume). Areas beyond the
/// horizon (corners of a disk's square, outer halves of border texels) have no weight, so borders do not bleed
/// inwards; footprints all beyond it take the plain mean. Throws Error for channels other than 1 or 3.
Texture make_texture(const Table& table, bool mips);

/// A line or disk resampled into a cube map [HomomorphicBrdf, sec. 4]: the centre of a texel has the table's
/// value for its direction; below the horizon that of the horizon at the same azimuth. Read by the projected
/// direction itself, no disk to be found. `mips` as above. Throws Error for a grid or volume, channels other than 1 or
/// 3, or a side outside [2, 2048].
Texture make_cube_map(const Table& table, int side, bool mips);

/// A level's texels as files and GPUs hold them: three channels of halves, floats and bytes have an alpha of 1.
std::string level_bytes(const Texture& texture, const std::vector<float>& level);

/// The direction of a place in a face, x and y in [-1, 1] to the right and downwards as texels run.
Vec3 cube_direction(int face, double x, double y) noexcept;

}  // namespace burnish
