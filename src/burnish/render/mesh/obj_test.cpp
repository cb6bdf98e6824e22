// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/render/mesh/mesh_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

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
