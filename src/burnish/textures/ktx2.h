// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/image/block_compression.h>
#include <burnish/textures/texture.h>

namespace burnish {

/// A KTX2 file of a texture, 2-D, 3-D or a cube map, with its levels. Texels are of the table's format, three
/// channels of halves, floats and bytes with an alpha of 1, because few GPUs have texels of three:
/// R16_SFLOAT, R16G16B16A16_SFLOAT, R32_SFLOAT, R32G32B32A32_SFLOAT, E5B9G9R9_UFLOAT_PACK32, R8_UNORM,
/// R8G8B8A8_UNORM. The largest value is 1 in each, so that bytes need no scale of their own. `compressed`:
/// with Zstandard. Throws Error for channels other than 1 or 3. Source: [KTX2].
std::string encode_ktx2(const Texture& texture, bool compressed);

/// A texture whose texels are stored already: four channels of bytes (R8G8B8A8_UNORM) or halves
/// (R16G16B16A16_SFLOAT), level after level, each [y][x][4]; or blocks of pairs, BC5_UNORM_BLOCK or BC5_SNORM_BLOCK,
/// of maps of either format. Throws Error for other formats.
struct StoredTexels {
  TableFormat format = TableFormat::unorm8;
  TexelBlocks blocks = TexelBlocks::none;
  int width = 0, height = 0;
  std::span<const std::vector<std::byte>> levels;
};
std::string encode_ktx2(const StoredTexels& texels, bool compressed);

/// make_texture(table, false): what generated shaders read (shaders/shader.h).
std::string encode_ktx2(const Table& table, bool compressed);

}  // namespace burnish
