#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/render/mesh/frames.h>
#include <burnish/render/mesh/mesh_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

std::string obj_error(std::string_view text) {
  return error_of([&] { parse_obj(memory_file(text)); });
}

constexpr const char* kQuad =
    "# a square in the x-y plane\r\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 "
    "0\n";

TEST(ObjReader, ReadsPolygonsMaterialsAndIndicesFromTheEnd) {
  const MeshFile file =
      parse_obj(memory_file(std::string(kQuad) +
                            "vn 0 0 2\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl blue\nf -4//-1 "
                            "-3//-1 -2//-1\nusemtl red\nf 1 2 3\n"));
  EXPECT_THAT(file.materials, testing::ElementsAre("red", "blue"));
  ASSERT_EQ(file.parts.size(), 2u);
  EXPECT_EQ(file.parts[0].mesh.triangles.size(), 3u);
  EXPECT_EQ(file.parts[0].material, 0);
  EXPECT_EQ(file.parts[1].mesh.triangles.size(), 1u);
  EXPECT_EQ(file.parts[1].mesh.vertices.size(), 3u);
  for (const MeshPart& part : file.parts)
    for (const Vertex& v : part.mesh.vertices) EXPECT_EQ(v.normal, (std::array{0.0f, 0.0f, 1.0f}));
}

TEST(ObjReader, NamesTheLineOfWhatItDoesNotUnderstand) {
  const std::string quad = kQuad;
  EXPECT_THAT(obj_error(quad + "f 1 2 9\n"),
              AllOf(HasSubstr("line 10"), HasSubstr("4 before it"), HasSubstr("'9'")));
  EXPECT_THAT(obj_error(quad + "f 1 2 0\n"), HasSubstr("line 10"));
  EXPECT_THAT(obj_error(quad + "f 1/1 2/2 3/x\n"), HasSubstr("'3/x'"));
  EXPECT_THAT(obj_error(quad + "f 1//1 2//1 3//1\n"), HasSubstr("0 before it"));
  EXPECT_THAT(obj_error(quad + "f 1/1/1/1 2 3\n"), HasSubstr("place/coordinate/normal"));
  EXPECT_THAT(obj_error(quad + "f 1 2\n"), HasSubstr("three corners"));
  EXPECT_THAT(obj_error("v 1 2\n"), AllOf(HasSubstr("line 1"), HasSubstr("the end of the line")));
  EXPECT_THAT(obj_error("v 1 nan 2\n"), HasSubstr("'nan'"));
  EXPECT_THAT(obj_error("v 1 1e300 2\n"), HasSubstr("'1e300'"));
  EXPECT_THAT(obj_error(quad), HasSubstr("at least one face"));
}

// A unit square, its coordinates turned.
RawMesh square(double turn) {
  RawMesh raw;
  for (const int k : {0, 1, 2, 0, 2, 3}) {
    const double x = k == 1 || k == 2, y = k >= 2;
    raw.positions.push_back({x, y, 0});
    raw.uvs.push_back({std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x});
  }
  return raw;
}

TEST(FinishMesh, TangentsFollowTheTextureAndKeepItsWayRound) {
  for (const double turn : {0.0, 0.7, 2.0, -1.1}) {
    RawMesh raw = square(turn);
    for (const Vertex& v : finish_mesh(raw, MissingNormals::flat).vertices) {
      EXPECT_NEAR(dot(to_vec3(v.tangent), {std::cos(turn), std::sin(turn), 0}), 1, 1e-6);
      EXPECT_EQ(v.side, 1);
    }
    for (auto& uv : raw.uvs) uv[0] = -uv[0];
    for (const Vertex& v : finish_mesh(raw, MissingNormals::flat).vertices) {
      EXPECT_NEAR(dot(to_vec3(v.tangent), {std::cos(turn), std::sin(turn), 0}), -1, 1e-6);
      EXPECT_EQ(v.side, -1);
    }
  }
}

TEST(FinishMesh, SplitsVerticesWhereTheTextureIsMirrored) {
  // two triangles beside each other along x = 1, the second with u running back
  RawMesh raw;
  raw.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  raw.uvs = {{0, 0}, {1, 0}, {1, 1}, {1, 0}, {0, 0}, {1, 1}};
  const Mesh mesh = finish_mesh(raw, MissingNormals::flat);
  EXPECT_EQ(mesh.vertices.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.vertices[mesh.triangles[0][i]].side, 1);
    EXPECT_EQ(mesh.vertices[mesh.triangles[1][i]].side, -1);
  }
  for (auto& uv : raw.uvs) uv[0] = 0.5;  // no area in the texture: any frame will do
  for (const Vertex& v : finish_mesh(raw, MissingNormals::flat).vertices)
    EXPECT_NEAR(length(to_vec3(v.tangent)), 1, 1e-6);
}

// [Mikkelsen 2008]
TEST(FinishMesh, WeighsTrianglesByTheirAngles) {
  // around the origin triangles of 90, 45 and 45 degrees; u runs along x in the first, along x + y in the
  // others
  RawMesh raw;
  const Vec3 rim[] = {{1, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}};
  const std::array<double, 2> uv[] = {{1, 0}, {0, 1}, {-1, 2}, {-2, 1}};
  for (std::size_t k = 0; k < 3; ++k) {
    raw.positions.insert(raw.positions.end(), {{0, 0, 0}, rim[k], rim[k + 1]});
    raw.uvs.insert(raw.uvs.end(), {{0, 0}, uv[k], uv[k + 1]});
  }
  const Mesh mesh = finish_mesh(raw, MissingNormals::flat);
  EXPECT_EQ(mesh.vertices.size(), 5u);
  const double middle = 3.141592653589793 / 8;
  EXPECT_NEAR(
      dot(to_vec3(mesh.vertices[mesh.triangles[0][0]].tangent), {std::cos(middle), std::sin(middle), 0}), 1,
      1e-6);
}

TEST(FinishMesh, TrianglesWithoutTexturePassTangentsOn) {
  // a fan around the origin whose second triangle has no area in the texture; the last one has no area at all
  RawMesh raw;
  const Vec3 rim[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0.5, 0}, {-1, 0.5, 0}};
  const std::array<double, 2> uv[] = {{1, 0}, {1, 1}, {1, 1}, {0.3, 1.5}, {0.5, 1.5}};
  for (std::size_t k = 0; k < 4; ++k) {
    raw.positions.insert(raw.positions.end(), {{0, 0, 0}, rim[k], rim[k + 1]});
    raw.uvs.insert(raw.uvs.end(), {{0, 0}, uv[k], uv[k + 1]});
  }
  raw.normals.assign(raw.positions.size(), {0, 0, 1});
  const Mesh mesh = finish_mesh(raw, MissingNormals::flat);
  for (std::size_t k = 1; k < 4; ++k) EXPECT_EQ(mesh.triangles[k][0], mesh.triangles[0][0]) << k;
}

TEST(FinishMesh, SmoothNormalsOfACubePointAlongItsDiagonals) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text +=
        "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " + std::to_string(i >> 2) + "\n";
  text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const MeshFile file = parse_obj(memory_file(text));
  EXPECT_EQ(file.parts[0].mesh.vertices.size(), 8u);
  for (const Vertex& v : file.parts[0].mesh.vertices) {
    const Vec3 outwards = normalize(to_vec3(v.position) - Vec3{0.5, 0.5, 0.5});
    EXPECT_NEAR(dot(to_vec3(v.normal), outwards), 1, 1e-6);
    EXPECT_NEAR(dot(to_vec3(v.tangent), tangent_around_y(outwards)), 1, 1e-6);
  }
}

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
    word(2), word(28 + text.size() + buffer.size()), word(text.size()), word(0x4e4f534a);
    bytes += text;
    word(buffer.size()), word(0x004e4942);
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

TEST(ReadMesh, RefusesWhatIsNoMesh) {
  const TemporaryFolder folder("mesh");
  write(folder.path / "x.obj", std::string("\x7f"
                                           "ELF\0\0\0",
                                           7));
  EXPECT_THAT(error_of([&] { read_mesh(folder.path / "x.obj"); }), HasSubstr("OBJ or glTF"));
  EXPECT_THAT(error_of([&] { read_mesh(folder.path / "none.obj"); }), HasSubstr("none.obj"));
}

}  // namespace
}  // namespace burnish
