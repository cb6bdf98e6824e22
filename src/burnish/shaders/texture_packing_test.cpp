// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/shaders/texture_packing.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

/// Texel (x, y, z) of a texture.
float texel_at(const ShaderTexture& texture, int x, int y, int z, std::size_t channel) {
  return texture.values.at(
      static_cast<std::size_t>((z * texture.height + y) * texture.width + x) * texture.channels + channel);
}

void expect_nodes(const ShaderTexture& texture, const PlacedTable& placed, const Table& table) {
  const TableLayout& layout = table.layout;
  std::size_t at = 0;
  for (int z = 0; z < layout.depth; ++z)
    for (int y = 0; y < layout.height; ++y)
      for (int x = 0; x < layout.width; ++x)
        for (std::size_t c = 0; c < table.channels; ++c, ++at)
          EXPECT_EQ(texel_at(texture, placed.first[0] + x, placed.first[1] + y, placed.first[2] + z, c),
                    std::ldexp(table.values[at], placed.exponent))
              << table.name;
}

TEST(TexturePacking, HoldsEveryTableOnceInTwoTexturesAtMost) {
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    const std::vector<ShaderTexture> textures = pack_tables(brdf, "m");
    EXPECT_LE(textures.size(), 2u);
    std::vector<int> found(brdf.tables().size());
    for (const ShaderTexture& texture : textures)
      for (const PlacedTable& placed : texture.tables) {
        const Table& table = brdf.tables()[placed.table];
        ++found[placed.table];
        EXPECT_EQ(texture.depth > 0, table.layout.shape == TableShape::volume) << model.name;
        expect_nodes(texture, placed, table);
        if (table.layout.shape == TableShape::line) {
          EXPECT_TRUE(std::has_single_bit(static_cast<unsigned>(texture.height))) << model.name;
        }
      }
    EXPECT_EQ(found, std::vector<int>(brdf.tables().size(), 1)) << model.name;
  }
}

TEST(TexturePacking, VolumesStandBehindLayersOfSomethingElse) {
  const FactoredBrdf brdf = smooth_model(model_case("Volumes"));
  const LayersBefore before{.name = "light", .width = 20, .height = 3, .depth = 4, .channels = 3};
  for (const ShaderTexture& texture : pack_tables(brdf, "m", &before)) {
    if (texture.depth == 0) continue;
    EXPECT_EQ(texture.name, "light");
    EXPECT_GE(texture.width, 20);
    int first = texture.depth;
    for (const PlacedTable& placed : texture.tables) {
      first = std::min(first, placed.first[2]);
      expect_nodes(texture, placed, brdf.tables()[placed.table]);
    }
    // a layer of the volumes' own edge, before it one that keeps the others' out, and these
    EXPECT_EQ(first, before.depth + 2);
    for (int z = 0; z < before.depth; ++z)
      for (int y = 0; y < texture.height; ++y)
        for (int x = 0; x < texture.width; ++x)
          for (std::size_t c = 0; c < texture.channels; ++c) EXPECT_EQ(texel_at(texture, x, y, z, c), 0);
  }
}

TEST(TexturePacking, ApartIsEveryTableAsItIs) {
  const FactoredBrdf brdf = smooth_model(model_case("Volumes"));
  const std::vector<ShaderTexture> textures = tables_apart(brdf, "m");
  ASSERT_EQ(textures.size(), brdf.tables().size());
  for (std::size_t t = 0; t < textures.size(); ++t) {
    EXPECT_EQ(textures[t].values, brdf.tables()[t].values);
    EXPECT_EQ(textures[t].height, brdf.tables()[t].layout.rows());
    EXPECT_EQ(textures[t].format, brdf.tables()[t].format);
  }
}

}  // namespace
}  // namespace burnish
