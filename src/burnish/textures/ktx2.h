#pragma once

#include <string>

#include <burnish/textures/texture.h>

namespace burnish {

/// A KTX2 file of a texture, 2-D, 3-D or a cube map, with its levels. Texels are of the table's format, three
/// channels of halves, floats and bytes with an alpha of 1, because few GPUs have texels of three:
/// R16_SFLOAT, R16G16B16A16_SFLOAT, R32_SFLOAT, R32G32B32A32_SFLOAT, E5B9G9R9_UFLOAT_PACK32, R8_UNORM,
/// R8G8B8A8_UNORM. The largest value is 1 in each, so that bytes need no scale of their own. `compressed`:
/// with Zstandard. Throws Error for channels other than 1 or 3. Source: [KTX2].
std::string encode_ktx2(const Texture& texture, bool compressed);

/// make_texture(table, false): what generated shaders read (shaders/shader.h).
std::string encode_ktx2(const Table& table, bool compressed);

}  // namespace burnish
