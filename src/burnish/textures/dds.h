// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/textures/ktx2.h>
#include <burnish/textures/texture.h>

namespace burnish {

/// A DDS file of a texture, 2-D, 3-D or a cube map, with its levels. It has the header of DirectX 10 and the texels of
/// encode_ktx2: R16_FLOAT, R16G16B16A16_FLOAT, R32_FLOAT, R32G32B32A32_FLOAT, R9G9B9E5_SHAREDEXP, R8_UNORM,
/// R8G8B8A8_UNORM. Throws Error for channels other than 1 or 3. Source: [DDS].
std::string encode_dds(const Texture& texture);

/// The same of texels that are stored already; blocks are BC5_UNORM and BC5_SNORM. Throws Error for formats other than
/// bytes and halves.
std::string encode_dds(const StoredTexels& texels);

}  // namespace burnish
