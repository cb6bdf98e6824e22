// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <burnish/export/gltf_binary.h>
#include <burnish/export/map_pictures.h>
#include <burnish/image/png.h>
#include <burnish/render/mesh/shapes.h>

namespace burnish {

namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsigned = 5125;               // component types of glTF
constexpr int kLinear = 9729, kLinearMipmapLinear = 9987;    // filters
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;  // targets of buffer views

// The binary chunk and what points into it.
class Binary {
 public:
  /// The accessor of `count` elements of `type` from 4-byte numbers.
  template <class T>
  std::size_t add(const std::vector<T>& values, const char* type, std::size_t width, int target) {
    static_assert(sizeof(T) == 4);
    json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", 4 * values.size()}};
    if (target) view["target"] = target;
    views_.push_back(view);
    bytes_.append(reinterpret_cast<const char*>(values.data()), 4 * values.size());
    json accessor{{"bufferView", views_.size() - 1},
                  {"componentType", std::is_same_v<T, float> ? kFloat : kUnsigned},
                  {"count", values.size() / width},
                  {"type", type}};
    std::vector<T> least(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), most = least;
    for (std::size_t i = 0; i < values.size(); ++i) {
      least[i % width] = std::min(least[i % width], values[i]);
      most[i % width] = std::max(most[i % width], values[i]);
    }
    accessor["min"] = least;
    accessor["max"] = most;
    accessors_.push_back(accessor);
    return accessors_.size() - 1;
  }

  /// The texture of a picture, which repeats.
  std::size_t add_texture(const Image8& picture) {
    const std::string png = encode_png(picture);
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", png.size()}});
    bytes_ += png;
    bytes_.append((4 - bytes_.size() % 4) % 4, '\0');  // what follows may be numbers
    images_.push_back({{"bufferView", views_.size() - 1}, {"mimeType", "image/png"}});
    textures_.push_back({{"sampler", 0}, {"source", images_.size() - 1}});
    return textures_.size() - 1;
  }

  const std::string& bytes() const { return bytes_; }
  const json& images() const { return images_; }
  const json& textures() const { return textures_; }
  const json& views() const { return views_; }
  const json& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  json views_ = json::array(), accessors_ = json::array(), images_ = json::array(), textures_ = json::array();
};

json add_mesh(Binary& binary, const Mesh& mesh, bool with_uv) {
  std::vector<float> positions, normals, tangents, uv;
  for (const Vertex& v : mesh.vertices) {
    uv.insert(uv.end(), {v.uv[0], 1 - v.uv[1]});  // there v runs downwards
    positions.insert(positions.end(), v.position.begin(), v.position.end());
    normals.insert(normals.end(), v.normal.begin(), v.normal.end());
    tangents.insert(tangents.end(), v.tangent.begin(), v.tangent.end());
    tangents.push_back(v.side);
  }
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  json primitive{{"attributes",
                  {{"POSITION", binary.add(positions, "VEC3", 3, kArrayBuffer)},
                   {"NORMAL", binary.add(normals, "VEC3", 3, kArrayBuffer)},
                   {"TANGENT", binary.add(tangents, "VEC4", 4, kArrayBuffer)}}},
                 {"indices", binary.add(corners, "SCALAR", 1, kElementBuffer)},
                 {"material", 0}};
  if (with_uv) primitive["attributes"]["TEXCOORD_0"] = binary.add(uv, "VEC2", 2, kArrayBuffer);
  return primitive;
}

json add_sphere(Binary& binary) {
  return add_mesh(binary, make_sphere(64, 32), false);
}

json factored_extension(const FactoredBrdf& brdf, Binary& binary) {
  json tables = json::array(), lobes = json::array();
  for (const Table& table : brdf.tables()) {
    json entry{
        {"name", table.name},
        {"shape", to_string(table.layout.shape)},
        {"width", table.layout.width},
        {"height", table.layout.height},
        {"warp", to_string(table.layout.warp)},
        {"values", binary.add(table.values, table.channels == 1 ? "SCALAR" : "VEC3", table.channels, 0)}};
    const int projections = projection_count(table.layout.shape);
    if (projections > 1) entry["warpY"] = to_string(table.layout.warp_y);
    if (projections > 2)
      entry.update({{"depth", table.layout.depth}, {"warpZ", to_string(table.layout.warp_z)}});
    tables.push_back(entry);
  }
  for (const Lobe& lobe : brdf.lobes()) {
    json factors = json::array();
    for (const FactorUse& use : lobe.factors) {
      factors.push_back({{"table", use.table}, {"projection", to_string(use.projection)}});
      const int projections = projection_count(brdf.table_of(use).layout.shape);
      if (projections > 1) factors.back()["projectionY"] = to_string(use.projection_y);
      if (projections > 2) factors.back()["projectionZ"] = to_string(use.projection_z);
    }
    lobes.push_back({{"scale", lobe.scale}, {"factors", factors}});
  }
  return {{"tables", tables}, {"lobes", lobes}};
}

void put_chunk(std::string& file, const char* type, std::string data, char padding) {
  while (data.size() % 4) data += padding;
  const auto size = static_cast<std::uint32_t>(data.size());
  file.append(reinterpret_cast<const char*>(&size), 4).append(type, 4).append(data);
}

// A scene of a mesh that has the material.
std::string scene_of(const json& primitive, json material, const std::string& name, const Binary& binary) {
  static_assert(std::endian::native == std::endian::little);
  json used = json::array();
  for (const auto& [extension, value] : material["extensions"].items()) used.push_back(extension);
  if (used.empty()) material.erase("extensions");
  material["name"] = name;
  json document{{"asset", {{"version", "2.0"}, {"generator", "burnish"}}},
                {"scene", 0},
                {"scenes", {{{"nodes", {0}}}}},
                {"nodes", {{{"mesh", 0}, {"name", name}}}},
                {"meshes", {{{"primitives", {primitive}}}}},
                {"materials", {material}},
                {"buffers", {{{"byteLength", binary.bytes().size()}}}},
                {"bufferViews", binary.views()},
                {"accessors", binary.accessors()}};
  if (!used.empty()) document["extensionsUsed"] = used;
  if (!binary.textures().empty()) {
    document["samplers"] = {{{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}}};
    document["images"] = binary.images();
    document["textures"] = binary.textures();
  }

  // header, then the document and what it points into
  std::string chunks;
  put_chunk(chunks, "JSON", document.dump(-1, ' ', true, json::error_handler_t::replace), ' ');
  put_chunk(chunks, std::string("BIN\0", 4).c_str(), binary.bytes(), '\0');
  std::string file("glTF\x02\0\0\0", 8);
  const auto size = static_cast<std::uint32_t>(chunks.size() + 12);
  return file.append(reinterpret_cast<const char*>(&size), 4).append(chunks);
}

}  // namespace

std::string gltf_binary(const FactoredBrdf& brdf, json material, const std::string& name) {
  Binary binary;
  const json primitive = add_sphere(binary);
  material["extensions"]["BURNISH_materials_factored"] = factored_extension(brdf, binary);
  return scene_of(primitive, std::move(material), name, binary);
}

std::string gltf_binary(json material, const std::string& name) {
  Binary binary;
  const json primitive = add_sphere(binary);
  return scene_of(primitive, std::move(material), name, binary);
}

std::string gltf_binary(const SpatialBrdf& surface, const TexelMaterials& materials,
                        const std::string& name) {
  // colours, then metal in blue and roughness in green, then normals
  Image8 colors(materials.width, materials.height, 3), rest(materials.width, materials.height, 3);
  colors.pixels = materials.base_color;
  for (std::size_t t = 0; t < materials.metallic.size(); ++t) {
    rest.pixels[3 * t] = 255;  // no occlusion, where a program looks for it
    rest.pixels[3 * t + 1] = materials.roughness[t];
    rest.pixels[3 * t + 2] = materials.metallic[t];
  }
  Binary binary;
  json material{{"pbrMetallicRoughness",
                 {{"baseColorTexture", {{"index", binary.add_texture(colors)}}},
                  {"metallicRoughnessTexture", {{"index", binary.add_texture(rest)}}}}},
                {"extensions", json::object()}};
  if (surface.maps().normals)
    material["normalTexture"] = {
        {"index", binary.add_texture(vector_bytes(map_picture(*surface.maps().normals, true)))}};
  Mesh square = make_plane(1);
  const auto longest = static_cast<float>(std::max(materials.width, materials.height));
  for (Vertex& vertex : square.vertices) {
    vertex.position[0] *= static_cast<float>(materials.width) / longest;
    vertex.position[1] *= static_cast<float>(materials.height) / longest;
  }
  const json primitive = add_mesh(binary, square, true);
  return scene_of(primitive, std::move(material), name, binary);
}

}  // namespace burnish
