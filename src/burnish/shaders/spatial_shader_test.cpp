// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/shaders/spatial_shader.h>
#include <burnish/testing/compilers.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/surfaces.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

// Returns a surface whose weights are grey bytes alone, as fits have them.
SpatialBrdf grey_surface(std::size_t lobes, bool normals) {
  std::string model;
  for (std::size_t j = 0; j < lobes; ++j)
    model += fmt::format("{}{}(theta_h)", j > 0 ? " + " : "", static_cast<char>('a' + j));
  std::vector<std::string> tables;
  for (std::size_t j = 0; j < lobes; ++j) tables.push_back(fmt::format("{}=6", static_cast<char>('a' + j)));
  SurfaceMaps maps;
  for (std::size_t j = 0; j < lobes; ++j)
    maps.weights.push_back(random_map(6, 5, 1, TableFormat::unorm8, 2.0f, j));
  if (normals) maps.normals = random_vectors(6, 5, 0, 0.5, 9);
  return {random_model(model.c_str(), tables, 3, TableFormat::half), std::move(maps)};
}

TEST(SpatialShader, FetchesMapsOnceAPixelAndLobesAsTheUniformModel) {
  for (const std::size_t lobes : {1u, 4u, 8u}) {
    const SpatialBrdf surface = grey_surface(lobes, true);
    for (const ShaderFilter filter : {ShaderFilter::exact, ShaderFilter::hardware}) {
      const SpatialShader shader = generate_shader(surface, {.filter = filter});
      EXPECT_EQ(shader.light_cost.fetches, generate_shader(surface.lobes(), {.filter = filter}).cost.fetches);
      EXPECT_LE(shader.place_cost.fetches, 3);
      EXPECT_EQ(shader.maps.textures.size(), (lobes + 3) / 4 + 1);
    }
  }
}

TEST(MapPacking, KeepsEveryTexelOfEveryLevel) {
  const SpatialBrdf surface = random_surface(9, 7);
  const PackedMaps packed = pack_maps(surface, "m");
  const auto value = [&](const MapComponent& place, std::size_t level, int x, int y, float scale) {
    const MapTexture& texture = packed.textures[place.texture];
    const std::size_t texel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(std::max(texture.width >> level, 1)) +
        static_cast<std::size_t>(x);
    const SurfaceMap one(1, 1, 1, texture.format, texture.format == TableFormat::half ? 1 : scale,
                         std::span<const std::byte>(texture.levels[level])
                             .subspan((4 * texel + place.component) * texel_bytes(texture.format, 1),
                                      texel_bytes(texture.format, 1)));
    return one.texel(0, 0)[0];
  };
  const auto expect_map = [&](const SurfaceMap& map, std::span<const MapComponent> places) {
    for (std::size_t l = 0; l < map.levels(); ++l)
      for (int y = 0; y < map.level_height(l); ++y)
        for (int x = 0; x < map.level_width(l); ++x)
          for (std::size_t c = 0; c < map.channels(); ++c)
            ASSERT_EQ(value(places[c], l, x, y, map.scale()), map.texel(x, y, l)[c]);
  };
  for (std::size_t j = 0; j < packed.weights.size(); ++j)
    expect_map(surface.maps().weights[j], packed.weights[j]);
  expect_map(*surface.maps().normals, *packed.normals);
  expect_map(*surface.maps().tangents, *packed.tangents);
}

TEST(MapPacking, KeepsPairsInBlocks) {
  const SpatialBrdf surface = smooth_surface(64);
  const PackedMaps packed = pack_maps(surface, "m", true);
  ASSERT_EQ(packed.textures.size(), 2u);
  EXPECT_EQ(packed.textures[0].blocks, TexelBlocks::bc5_unorm);
  EXPECT_EQ(packed.textures[1].blocks, TexelBlocks::bc5_snorm);
  const auto expect_near = [&](const SurfaceMap& map, std::span<const MapComponent> places, double most) {
    for (std::size_t c = 0; c < map.channels(); ++c) {
      const MapTexture& texture = packed.textures[places[c].texture];
      ASSERT_EQ(texture.levels.size(), map.levels());
      for (std::size_t l = 0; l < 3; ++l) {
        const int width = map.level_width(l), height = map.level_height(l);
        const std::vector<float> pairs =
            decode_bc5(width, height, texture.levels[l], texture.blocks == TexelBlocks::bc5_snorm);
        double square = 0;
        for (int i = 0; i < width * height; ++i) {
          const auto value = static_cast<double>(map.texel(i % width, i / width, l)[c] / map.scale());
          const double off =
              value - static_cast<double>(pairs[2 * static_cast<std::size_t>(i) + places[c].component]);
          square += off * off / (width * height);
        }
        EXPECT_LT(std::sqrt(square), most * (1 << l)) << l;  // a block spans twice as much each level
      }
    }
  };
  for (std::size_t j = 0; j < packed.weights.size(); ++j)
    expect_near(surface.maps().weights[j], packed.weights[j], 0.02);
  expect_near(*surface.maps().normals, *packed.normals, 0.004);
  EXPECT_THROW(pack_maps(random_surface(4, 4), "m", true), Error);  // the surface has weights of halves
}

// C++ has no textures, so the program samples the maps of the test's places beforehand.
TEST(SpatialShader, CppAgreesWithTheDefinition) {
  if (!has_tool("c++")) GTEST_SKIP() << "no C++ compiler";
  const SpatialBrdf surface = random_surface(9, 7);
  const SpatialShader shader = generate_shader(surface, {.language = ShaderLanguage::cpp, .name = "wall"});
  constexpr int kPlaces = 300;
  const std::size_t maps = shader.maps.textures.size();
  Pcg32 random(8);
  std::vector<float> input;
  std::vector<std::array<double, 3>> expected;
  while (expected.size() < kPlaces) {
    const double u = random.uniform(), v = random.uniform(), lod = 3 * random.uniform();
    const auto direction = [&] {
      return normalize({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()});
    };
    const Vec3 wi = direction(), wo = direction();
    const ShadingFrame frame = surface.frame(u, v, lod);
    if (std::min(std::abs(frame.local(wi).z), std::abs(frame.local(wo).z)) < 1e-4) continue;
    for (const double x : {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}) input.push_back(static_cast<float>(x));
    std::vector<std::array<float, 4>> read(maps);
    for (std::size_t j = 0; j < shader.maps.weights.size(); ++j) {
      const SurfaceMap& map = surface.maps().weights[j];
      for (std::size_t c = 0; c < map.channels(); ++c) {
        const MapComponent& place = shader.maps.weights[j][c];
        read[place.texture][place.component] = map.sample(u, v, lod)[c] / map.scale();
      }
    }
    for (std::size_t c = 0; c < 2; ++c) {
      const MapComponent &n = (*shader.maps.normals)[c], &t = (*shader.maps.tangents)[c];
      read[n.texture][n.component] = surface.maps().normals->sample(u, v, lod)[c];
      read[t.texture][t.component] = surface.maps().tangents->sample(u, v, lod)[c];
    }
    for (const auto& texel : read) input.insert(input.end(), texel.begin(), texel.end());
    surface.eval(u, v, lod, wi, wo, expected.emplace_back());
  }
  const TemporaryFolder folder("spatial_cpp");
  const std::size_t floats = 6 + 4 * maps;
  write(folder.path / "main.cpp",
        shader.text +
            fmt::format(
                "#include <stdio.h>\n"
                "using namespace burnish_shader;\n"
                "struct Texel {{ float x, y, z, w; }};\n"
                "struct Maps {{\n  const float* read;\n"
                "  Texel sample(int i, float, float, float) const {{\n"
                "    const float* m = read + 4 * i;\n    return {{m[0], m[1], m[2], m[3]}};\n  }}\n}};\n"
                "int main() {{\n  float in[{0}];\n  while (fread(in, 4, {0}, stdin) == {0}) {{\n"
                "    const auto place = burnish_wall_at(Maps{{in + 6}}, 0, 0, 0);\n"
                "    const vec3 f = burnish_wall({{in[0], in[1], in[2]}}, {{in[3], in[4], in[5]}}, place);\n"
                "    fwrite(&f, 4, 3, stdout);\n  }}\n  return burnish_wall_lod(1, 0, 0, 0) < 3;\n}}\n",
                floats));
  const std::string binary = (folder.path / "main").string();
  ASSERT_TRUE(
      runs(fmt::format("c++ -std=c++17 -O1 -Wall -Wextra -Wdouble-promotion -Werror {0}.cpp -o {0}", binary),
           folder.path / "log"));
  std::ofstream(folder.path / "in", std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(4 * input.size()));
  ASSERT_TRUE(runs(fmt::format("{0} < {1}/in > {1}/out", binary, folder.path.string()), folder.path / "log"))
      << "log2 of 9 texels is more than 3";
  std::ifstream out(folder.path / "out", std::ios::binary);
  for (const auto& truth : expected) {
    std::array<float, 3> found{};
    ASSERT_TRUE(out.read(reinterpret_cast<char*>(found.data()), sizeof found));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(static_cast<double>(found[c]), truth[c], 2e-4 * truth[c] + 1e-7);
  }
}

// Returns the text of a main function that calls a surface's functions in a language.
std::string surface_main(ShaderLanguage language) {
  const char* const call =
      "burnish_wall({0}(0.0, 0.6, 0.8), {0}(0.0, 0.0, 1.0), place) + burnish_wall_world({0}(0.0, 0.0, 1.0), "
      "{0}(1.0, 0.0, 0.0), {0}(0.0, 0.6, 0.8), {0}(0.0, 0.0, 1.0), place)";
  const auto value = [&](const char* vector) { return fmt::format(fmt::runtime(call), vector); };
  const std::string at = "burnish_wall_at(at.x, at.y, burnish_wall_lod(0.1, 0.0, 0.0, 0.1))";
  switch (language) {
    case ShaderLanguage::hlsl:
    case ShaderLanguage::slang:
      return fmt::format(
          "float4 main(float4 at : SV_Position) : SV_Target {{ burnish_wall_place place = {}; return "
          "float4({}, "
          "1.0); }}\n",
          at, value("float3"));
    case ShaderLanguage::wgsl:
      return fmt::format(
          "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {{ let place = {}; return "
          "vec4f({}, 1.0); }}\n",
          at, value("vec3f"));
    default:
      return fmt::format(
          "out vec4 color;\nvoid main() {{ vec2 at = gl_FragCoord.xy; burnish_wall_place place = {}; color = "
          "vec4({}, 1.0); }}\n",
          at, value("vec3"));
  }
}

class SpatialShaderCompilers : public testing::TestWithParam<Checked> {};

TEST_P(SpatialShaderCompilers, AcceptSurfacesWithEveryFilter) {
  const Checked& checked = GetParam();
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool(checked.tool)) GTEST_SKIP() << "no " << checked.tool;
  const TemporaryFolder folder("spatial_shaders");
  std::string files;
  const std::array<SpatialBrdf, 3> surfaces{random_surface(9, 7), grey_surface(5, true),
                                            grey_surface(2, false)};
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    for (const char* how : {"exact", "hardware"}) {
      const SpatialShader shader = generate_shader(
          surfaces[i],
          {.language = checked.language,
           .filter = how == std::string_view("exact") ? ShaderFilter::exact : ShaderFilter::hardware,
           .name = "wall"});
      const auto file = folder.path / fmt::format("{}_{}.{}", i, how, checked.extension);
      write(file, checked.before + shader.text + surface_main(checked.language));
      files += " " + file.string();
    }
  EXPECT_TRUE(runs(fmt::format(fmt::runtime(checked.command), files), folder.path / "log"));
}

INSTANTIATE_TEST_SUITE_P(Languages, SpatialShaderCompilers, testing::ValuesIn(kChecked),
                         [](const auto& test) {
                           return fmt::format("{}By{}", to_string(test.param.language), test.param.tool);
                         });

TEST(SpatialShader, RefusesWhatItCannotWrite) {
  const SpatialBrdf surface = random_surface(4, 4);
  EXPECT_THROW(generate_shader(surface, {.name = "a b"}), Error);
  EXPECT_THROW(generate_shader(surface, {.textures_are_arguments = true}), Error);
  EXPECT_THROW(generate_shader(surface, {.filter = ShaderFilter::hardware, .half_products = true}), Error);
  EXPECT_THROW(split_shader(surface, {.language = ShaderLanguage::hlsl}), Error);
}

}  // namespace
}  // namespace burnish
