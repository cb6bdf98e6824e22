// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_surface.h>
#include <burnish/export/web.h>
#include <burnish/export/web_module.h>
#include <burnish/shaders/map_packing.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

const std::string& bytes_of(const ExportedFiles& exported, const std::string& name) {
  const auto found = std::ranges::find(exported.files, name, &ExportedFile::name);
  if (found == exported.files.end()) throw Error("no file " + name);
  return found->bytes;
}

TEST(ExportSurface, BringsMapsWithTheirLevelsAndSaysWhereWeightsAre) {
  const SpatialBrdf surface = random_surface(8, 4);
  const ExportedFiles exported = export_surface(
      surface, {.to = {ExportTarget::glsl, ExportTarget::cpp}, .name = "wall", .compressed = false});
  const auto manifest = nlohmann::json::parse(bytes_of(exported, "wall.json"));
  const PackedMaps packed = pack_maps(surface, "burnish_wall_map");
  ASSERT_EQ(manifest["maps"]["textures"].size(), packed.textures.size());
  for (std::size_t i = 0; i < packed.textures.size(); ++i) {
    const auto& entry = manifest["maps"]["textures"][i];
    EXPECT_EQ(entry["sampler"], packed.textures[i].name);
    EXPECT_EQ(entry["levels"], 4);
    // the largest level comes last in the file
    const std::vector<std::byte>& level = packed.textures[i].levels.front();
    const std::string& file = bytes_of(exported, entry["file"]);
    EXPECT_EQ(file.substr(file.size() - level.size()),
              std::string_view(reinterpret_cast<const char*>(level.data()), level.size()));
  }
  ASSERT_EQ(manifest["maps"]["weights"].size(), 3u);
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& entry = manifest["maps"]["weights"][j];
    EXPECT_EQ(entry["places"].size(), surface.maps().weights[j].channels());
    EXPECT_EQ(entry["places"][0][0], packed.weights[j][0].texture);
    EXPECT_EQ(entry["scale"], surface.maps().weights[j].scale());
  }
  EXPECT_THAT(bytes_of(exported, "wall.glsl"), testing::HasSubstr("burnish_wall_map0"));
  EXPECT_EQ(manifest["shaders"].size(), 2u);
}

TEST(ExportSurface, GivesEachMapAsAPicture) {
  const ExportedFiles exported =
      export_surface(random_surface(8, 4), {.to = {ExportTarget::png, ExportTarget::exr}, .name = "wall"});
  for (const char* map : {"weight0", "weight1", "weight2", "normals", "tangents"}) {
    EXPECT_EQ(bytes_of(exported, std::string("wall_") + map + ".png").substr(1, 3), "PNG");
    EXPECT_EQ(bytes_of(exported, std::string("wall_") + map + ".exr").substr(0, 2), "\x76\x2f");
  }
}

TEST(ExportSurface, BringsEverythingIntoModuleAndPage) {
  const SpatialBrdf surface = random_surface(8, 4);
  const ExportedFiles exported =
      export_surface(surface, {.to = {ExportTarget::three, ExportTarget::html}, .name = "wall"});
  const PackedMaps packed = pack_maps(surface, "burnish_wall_map");
  for (const char* file : {"wall.three.js", "wall.html"}) {
    const std::string& text = bytes_of(exported, file);
    EXPECT_THAT(text, testing::HasSubstr("burnish_wall_place burnish_wall_at(float u, float v, float lod)"));
    for (const MapTexture& map : packed.textures)
      for (const std::vector<std::byte>& level : map.levels)
        EXPECT_THAT(text, testing::HasSubstr(base64(level))) << file;
  }
  EXPECT_EQ(web_model(surface, "wall")["framed"], true);
}

TEST(ExportSurface, HasMapsInBlocks) {
  const SpatialBrdf surface = smooth_surface(16);
  ExportOptions options{.to = {ExportTarget::glsl}, .name = "wall", .compressed = false, .blocks = true};
  const ExportedFiles exported = export_surface(surface, options);
  const auto manifest = nlohmann::json::parse(bytes_of(exported, "wall.json"));
  const auto& textures = manifest["maps"]["textures"];
  ASSERT_EQ(textures.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(textures[i]["format"], i == 0 ? "bc5_unorm" : "bc5_snorm");
    EXPECT_EQ(textures[i]["channels"], 2);
    EXPECT_GT(textures[i]["block_rms"], 0.0);
    EXPECT_LT(textures[i]["block_rms"], 0.1);
    const std::string& bytes = bytes_of(exported, textures[i]["file"]);
    EXPECT_EQ(bytes[12], static_cast<char>(i == 0 ? 141 : 142));  // VkFormat
    // level 0 comes last, a byte a texel and channel
    EXPECT_EQ(
        bytes.substr(bytes.size() - 256),
        (std::string(
            reinterpret_cast<const char*>(pack_maps(surface, "m", true).textures[i].levels[0].data()), 256)));
  }
  EXPECT_THAT(exported.losses, testing::IsEmpty());
  EXPECT_THAT(export_surface(smooth_surface(6), options).losses,
              testing::ElementsAre(testing::HasSubstr("no multiples of 4")));
  options.to = {ExportTarget::cpp};
  EXPECT_THROW(export_surface(surface, options), Error);
  options.to = {ExportTarget::html};
  EXPECT_THROW(export_surface(surface, options), Error);
}

TEST(ExportSurface, RefusesWhatHasNoSurfaces) {
  const SpatialBrdf surface = random_surface(4, 4);
  EXPECT_THROW(export_surface(surface, {.to = {ExportTarget::usda}, .name = "wall"}), Error);
  EXPECT_THROW(export_surface(surface, {.to = {ExportTarget::glsl}, .name = "a b"}), Error);
}

TEST(ExportSurface, HasTheNearestMaterialsForGltf) {
  const ExportedFiles exported =
      export_surface(random_surface(8, 4), {.to = {ExportTarget::gltf}, .name = "wall"});
  EXPECT_EQ(bytes_of(exported, "wall.glb").substr(0, 4), "glTF");
  const auto manifest = nlohmann::json::parse(bytes_of(exported, "wall.json"));
  EXPECT_EQ(manifest["gltf"], "wall.glb");
  EXPECT_TRUE(manifest["gltf_material"]["psnr"].is_number());
}

}  // namespace
}  // namespace burnish
