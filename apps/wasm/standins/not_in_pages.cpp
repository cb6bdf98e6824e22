// What the library has and no page asks for: surfaces as OpenEXR, and maps in blocks.
#include <burnish/error.h>
#include <burnish/image/block_compression.h>
#include <burnish/surface/surface_exr.h>

namespace burnish {

SurfaceModel read_surface_exr(const FileBytes& file) {
  throw Error::in_file(file.name, "the .burnish file of a surface, which `burnish convert` makes of it",
                       "its OpenEXR file");
}

std::string format_surface_exr(const SurfaceModel&) {
  throw Error("surface: expected .burnish to write, found OpenEXR");
}

std::string_view to_string(TexelBlocks) noexcept {
  return "none";
}

std::vector<std::byte> encode_bc5(int, int, std::span<const float>, bool) {
  throw Error("blocks: expected maps of single texels in a page, found blocks");
}

std::vector<float> decode_bc5(int, int, std::span<const std::byte>, bool) {
  throw Error("blocks: expected maps of single texels in a page, found blocks");
}

}  // namespace burnish
