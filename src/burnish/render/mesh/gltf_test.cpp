// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/render/mesh/mesh_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// One triangle with everything, indexed by bytes; the second node mirrors it.
struct Gltf {
  std::string buffer;
  json root;

  Gltf() {
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, uvs[] = {0, 1, 1, 1, 0, 0};
    buffer.append(reinterpret_cast<const char*>(positions), sizeof positions);
    buffer.append(reinterpret_cast<const char*>(uvs), sizeof uvs);
    buffer += std::string("\0\1\2", 3);
    root = {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes",
             {{{"children", {1}}, {"mesh", 0}, {"translation", {0, 0, 5}}},
              {{"mesh", 0}, {"scale", {-2, 1, 1}}}}},
            {"meshes",
             {{{"primitives",
                {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"material", 0}}}}}}},
            {"materials", {{{"name", "paint"}}}},
            {"buffers", {{{"byteLength", buffer.size()}}}},
            {"bufferViews",
             {{{"buffer", 0}, {"byteLength", 36}},
              {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 24}},
              {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 3}}}},
            {"accessors",
             {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
              {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}},
              {{"bufferView", 2}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}}}}};
  }
  std::string binary() const {
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    const auto word = [&](std::size_t value) {
      const auto w = static_cast<std::uint32_t>(value);
      bytes.append(reinterpret_cast<const char*>(&w), 4);
    };
    for (const std::size_t value :
         {std::size_t{2}, 28 + text.size() + buffer.size(), text.size(), std::size_t{0x4e4f534a}})
      word(value);
    bytes += text;
    word(buffer.size());
    word(0x004e4942);
    return bytes + buffer;
  }
  std::string error() const {
    return error_of([&] { parse_gltf(memory_file(binary()), ""); });
  }
};

TEST(GltfReader, PlacesNodesAndKeepsMirroredTrianglesOutwards) {
  const Gltf gltf;
  const MeshFile file = parse_gltf(memory_file(gltf.binary()), "");
  ASSERT_EQ(file.parts.size(), 2u);
  EXPECT_THAT(file.materials, testing::ElementsAre("paint"));
  for (const MeshPart& part : file.parts) {
    ASSERT_EQ(part.mesh.triangles.size(), 1u);
    const auto& t = part.mesh.triangles[0];
    const auto at = [&](std::size_t k) { return to_vec3(part.mesh.vertices[t[k]].position); };
    EXPECT_GT(cross(at(1) - at(0), at(2) - at(0)).z, 0);
    for (const Vertex& v : part.mesh.vertices) {
      EXPECT_EQ(v.position[2], 5);
      EXPECT_EQ(v.normal[2], 1);
    }
  }
  EXPECT_EQ(file.parts[0].mesh.vertices[0].side, 1) << "v counts downwards in glTF";
}

TEST(GltfReader, ReadsBuffersFromDataUrisAndFilesBesideIt) {
  Gltf gltf;
  const Mesh expected = parse_gltf(memory_file(gltf.binary()), "").parts[0].mesh;
  const TemporaryFolder folder("gltf");
  write(folder.path / "a b.bin", gltf.buffer);
  gltf.root["buffers"][0]["uri"] = "a b.bin";
  write(folder.path / "m.gltf", gltf.root.dump());
  EXPECT_EQ(read_mesh(folder.path / "m.gltf").parts[0].mesh.vertices, expected.vertices);
  gltf.root["buffers"] = {{{"byteLength", 4}, {"uri", "data:application/octet-stream;base64,AAAAAA=="}}};
  gltf.root["accessors"][2]["count"] = 0;
  EXPECT_THAT(error_of([&] { parse_gltf(memory_file(gltf.root.dump()), ""); }), HasSubstr("expected"));
}

TEST(GltfReader, NamesThePlaceOfWhatIsBroken) {
  const auto with = [](const char* pointer, json value) {
    Gltf gltf;
    gltf.root[json::json_pointer(pointer)] = std::move(value);
    return gltf.error();
  };
  EXPECT_THAT(with("/asset/version", "1.0"), HasSubstr("asset.version"));
  EXPECT_THAT(with("/extensionsRequired", {"KHR_draco_mesh_compression"}), HasSubstr("draco"));
  EXPECT_THAT(with("/accessors/0/count", 4), HasSubstr("accessors[0]"));
  EXPECT_THAT(with("/accessors/0/count", 4'000'000'000u), HasSubstr("count"));
  EXPECT_THAT(with("/accessors/2/type", "VEC3"), HasSubstr("indices"));
  EXPECT_THAT(with("/accessors/0/sparse", json::object()), HasSubstr("sparse"));
  EXPECT_THAT(with("/bufferViews/0/byteOffset", 1e9), HasSubstr("byteOffset"));
  EXPECT_THAT(with("/bufferViews/1/byteLength", 23), HasSubstr("accessors[1]"));
  EXPECT_THAT(with("/bufferViews/0/byteStride", 4), HasSubstr("byteStride"));
  EXPECT_THAT(with("/buffers/0/byteLength", 64), HasSubstr("buffers[0]"));
  EXPECT_THAT(with("/buffers/0/uri", "../secret"), HasSubstr("beside"));
  EXPECT_THAT(with("/buffers/0/uri", "data:x;base64,AA!A"), HasSubstr("base64"));
  EXPECT_THAT(with("/nodes/1/children", {0}), HasSubstr("levels"));
  EXPECT_THAT(with("/nodes/0/translation", {0, 1}), HasSubstr("translation"));
  EXPECT_THAT(with("/nodes/0/mesh", 7), HasSubstr("meshes[7]"));
  EXPECT_THAT(with("/meshes/0/primitives/0/mode", 1), HasSubstr("mode"));
  EXPECT_THAT(with("/scenes/0/nodes", {0, -1}), HasSubstr("scenes"));
  Gltf gltf;
  gltf.buffer[60] = 3;
  EXPECT_THAT(gltf.error(), HasSubstr("indices below 3"));
  gltf.buffer[60] = 0;
  gltf.buffer[3] = gltf.buffer[2] = '\x7f';
  gltf.buffer[2] = '\xc0';
  EXPECT_THAT(gltf.error(), HasSubstr("finite"));
}

TEST(GltfReader, EveryTruncatedFileThrows) {
  const std::string whole = Gltf().binary();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(parse_gltf(memory_file(std::string_view(whole).substr(0, size)), ""), Error) << size;
}

TEST(GltfReader, ChangedBytesThrowOneClearErrorOrGiveAMesh) {
  const std::string whole = Gltf().binary();
  Pcg32 random(3);
  for (int i = 0; i < 3000; ++i) {
    std::string changed = whole;
    changed[static_cast<std::size_t>(random.uniform() * static_cast<double>(whole.size()))] =
        static_cast<char>(random.uniform() * 256);
    const std::string message = error_of([&] { parse_gltf(memory_file(changed), ""); });
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    if (message.empty()) continue;
    EXPECT_THAT(message, AllOf(HasSubstr("test.file"), HasSubstr("expected")));
  }
}

}  // namespace
}  // namespace burnish
