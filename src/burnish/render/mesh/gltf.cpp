// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/render/mesh/frames.h>
#include <burnish/render/mesh/gltf_document.h>
#include <burnish/render/mesh/mesh_file.h>

namespace burnish {

namespace {

using nlohmann::json;

// Column after column, as glTF has it.
using Matrix = std::array<double, 16>;
constexpr Matrix kUnit{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix operator*(const Matrix& a, const Matrix& b) noexcept {
  Matrix c{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
  return c;
}
Vec3 column(const Matrix& m, std::size_t j) noexcept {
  return {m[4 * j], m[4 * j + 1], m[4 * j + 2]};
}
Vec3 transform_direction(const Matrix& m, Vec3 v) noexcept {
  return v.x * column(m, 0) + v.y * column(m, 1) + v.z * column(m, 2);
}
// By the cofactors, which is the inverse's transpose but for the determinant.
Vec3 transform_normal(const Matrix& m, Vec3 v) noexcept {
  const Vec3 x = column(m, 0), y = column(m, 1), z = column(m, 2);
  return v.x * cross(y, z) + v.y * cross(z, x) + v.z * cross(x, y);
}
double determinant(const Matrix& m) noexcept {
  return dot(column(m, 0), cross(column(m, 1), column(m, 2)));
}

class GltfReader {
 public:
  GltfReader(const FileBytes& file, const std::filesystem::path& folder) : document_(file, folder) {}

  MeshFile read() {
    const json& asset = member(root_, "asset", "the file");
    if (const auto version = asset.find("version");
        version == asset.end() || !version->is_string() || !version->get<std::string>().starts_with("2."))
      fail("asset.version", "2.x", version == asset.end() ? "none" : version->dump());
    if (const auto needed = root_.find("extensionsRequired");
        needed != root_.end() && needed->is_array() && !needed->empty())
      fail("extensionsRequired", "none, none are supported", needed->dump());
    for (const std::size_t node : roots()) visit(node, kUnit, 0);
    if (file_.parts.empty()) fail("the scene", "at least one triangle", "none");
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& expected,
                         const std::string& found) const {
    document_.fail(place, expected, found);
  }
  const json& member(const json& of, const char* key, const std::string& place) const {
    return document_.member(of, key, place);
  }
  std::size_t number(const json& value, const std::string& place, std::size_t below) const {
    return document_.number(value, place, below);
  }
  const json& element(const char* list, std::size_t i) const { return document_.element(list, i); }

  std::vector<std::size_t> roots() const {
    // those of the chosen scene; without scenes all that are nobody's child
    std::vector<std::size_t> found;
    const json& nodes = member(root_, "nodes", "the file");
    if (!nodes.is_array()) fail("nodes", "a list", nodes.dump());
    if (root_.contains("scenes")) {
      const std::size_t scene = document_.number_or(root_, "scene", 0, "the file", SIZE_MAX);
      const json& list = element("scenes", scene);
      if (list.contains("nodes") && list["nodes"].is_array())
        for (const json& node : list["nodes"]) found.push_back(number(node, "scenes.nodes", nodes.size()));
      return found;
    }
    std::vector<bool> child(nodes.size());
    for (const json& node : nodes)
      if (node.is_object() && node.contains("children") && node["children"].is_array())
        for (const json& c : node["children"]) child[number(c, "nodes.children", nodes.size())] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!child[i]) found.push_back(i);
    return found;
  }

  template <std::size_t N>
  std::optional<std::array<double, N>> numbers(const json& of, const char* key,
                                               const std::string& place) const {
    const auto found = of.find(key);
    if (found == of.end()) return {};
    std::array<double, N> values{};
    bool fits = found->is_array() && found->size() == N;
    for (std::size_t i = 0; fits && i < N; ++i) {
      fits = (*found)[i].is_number();
      if (fits) values[i] = (*found)[i].template get<double>();
      fits = fits && std::abs(values[i]) <= 1e18;
    }
    if (!fits) fail(place + "." + key, fmt::format("{} numbers of at most 1e18", N), found->dump());
    return values;
  }

  // Given as it is, or as scale, then rotation by a quaternion, then translation.
  Matrix matrix_of(const json& node, const std::string& place) const {
    if (const auto m = numbers<16>(node, "matrix", place)) return *m;
    const auto t = numbers<3>(node, "translation", place).value_or(std::array{0.0, 0.0, 0.0});
    const auto s = numbers<3>(node, "scale", place).value_or(std::array{1.0, 1.0, 1.0});
    const auto [x, y, z, w] = numbers<4>(node, "rotation", place).value_or(std::array{0.0, 0.0, 0.0, 1.0});
    return {s[0] * (1 - 2 * (y * y + z * z)),
            s[0] * 2 * (x * y + z * w),
            s[0] * 2 * (x * z - y * w),
            0,
            s[1] * 2 * (x * y - z * w),
            s[1] * (1 - 2 * (x * x + z * z)),
            s[1] * 2 * (y * z + x * w),
            0,
            s[2] * 2 * (x * z + y * w),
            s[2] * 2 * (y * z - x * w),
            s[2] * (1 - 2 * (x * x + y * y)),
            0,
            t[0],
            t[1],
            t[2],
            1};
  }

  void visit(std::size_t index, const Matrix& above, int depth) {
    const json& node = element("nodes", index);
    const std::string place = fmt::format("nodes[{}]", index);
    if (depth > 64 || ++visits_ > 100'000) fail(place, "a tree of nodes of at most 64 levels", "more");
    const Matrix matrix = above * matrix_of(node, place);
    if (node.contains("mesh")) read_mesh_of(number(node["mesh"], place + ".mesh", SIZE_MAX), matrix);
    if (const auto children = node.find("children"); children != node.end() && children->is_array())
      for (const json& child : *children)
        visit(number(child, place + ".children", SIZE_MAX), matrix, depth + 1);
  }

  void read_mesh_of(std::size_t index, const Matrix& matrix) {
    const std::string place = fmt::format("meshes[{}]", index);
    const json& primitives = member(element("meshes", index), "primitives", place);
    if (!primitives.is_array()) fail(place + ".primitives", "a list", primitives.dump());
    for (std::size_t i = 0; i < primitives.size(); ++i)
      read_primitive(primitives[i], fmt::format("{}.primitives[{}]", place, i), matrix);
  }

  // Elements of a primitive's corners; those that it does not have are empty.
  struct Attributes {
    std::optional<GltfElements> positions, normals, tangents, uvs;
  };

  Attributes attributes_of(const json& primitive, const std::string& place) {
    const json& attributes = member(primitive, "attributes", place);
    const auto read = [&](const char* key, std::size_t width) -> std::optional<GltfElements> {
      if (!attributes.is_object() || !attributes.contains(key)) return {};
      const std::string at = place + ".attributes." + key;
      GltfElements e = document_.elements(number(attributes[key], at, SIZE_MAX), at);
      if (e.width != width) fail(at, fmt::format("{} components", width), std::to_string(e.width));
      return e;
    };
    Attributes found;
    found.positions = read("POSITION", 3);
    found.normals = read("NORMAL", 3);
    found.tangents = read("TANGENT", 4);
    found.uvs = read("TEXCOORD_0", 2);
    if (!found.positions) fail(place + ".attributes", "POSITION", "none");
    const std::size_t count = found.positions->count;
    for (const auto* other : {&found.normals, &found.tangents, &found.uvs})
      if (*other && (*other)->count != count)
        fail(place, fmt::format("{} of every attribute", count), std::to_string((*other)->count));
    return found;
  }

  // The corners by threes: as the indices say, or one after another.
  std::vector<std::size_t> corners_of(const json& primitive, const std::string& place, std::size_t count) {
    std::vector<std::size_t> order;
    if (primitive.contains("indices")) {
      const std::string at = place + ".indices";
      const GltfElements list = document_.elements(number(primitive["indices"], at, SIZE_MAX), at);
      if (list.width != 1) fail(at, "one component", std::to_string(list.width));
      for (const double v : list.values) {
        if (!(v >= 0) || v >= static_cast<double>(count) || v != std::floor(v))
          fail(at, fmt::format("indices below {}", count), fmt::format("{}", v));
        order.push_back(static_cast<std::size_t>(v));
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) order.push_back(i);
    }
    if (order.size() % 3 != 0) fail(place, "corners by threes", std::to_string(order.size()));
    triangles_ += order.size() / 3;
    if (triangles_ > kMaxTriangles) fail(place, fmt::format("at most {} triangles", kMaxTriangles), "more");
    return order;
  }

  void read_primitive(const json& primitive, const std::string& place, const Matrix& matrix) {
    if (document_.number_or(primitive, "mode", 4, place, 7) != 4)
      fail(place + ".mode", "4, triangles", primitive["mode"].dump());
    const auto [positions, normals, tangents, uvs] = attributes_of(primitive, place);
    std::vector<std::size_t> order = corners_of(primitive, place, positions->count);
    if (order.empty()) return;

    // a matrix that mirrors turns triangles inside out: they go the other way round
    const bool mirrored = determinant(matrix) < 0;
    if (mirrored)
      for (std::size_t i = 0; i < order.size(); i += 3) std::swap(order[i + 1], order[i + 2]);

    // every corner in the scene's frame
    RawMesh raw;
    for (const std::size_t i : order) {
      const Vec3 p = transform_direction(matrix, positions->vec3(i)) + column(matrix, 3);
      if (!(length(p) <= 1e18)) fail(place, "places within 1e18 of the origin", fmt::format("{}", length(p)));
      raw.positions.push_back(p);
      if (normals) {
        const Vec3 n = transform_normal(matrix, normals->vec3(i));
        raw.normals.push_back(normalize(mirrored ? -n : n));
      }
      if (uvs) raw.uvs.push_back({uvs->values[2 * i], 1 - uvs->values[2 * i + 1]});  // v upwards
      if (tangents && normals) {
        const double* t = &tangents->values[4 * i];
        const Vec3 along = normalize(transform_direction(matrix, {t[0], t[1], t[2]}));
        raw.tangents.push_back({along.x, along.y, along.z, mirrored ? -t[3] : t[3]});
      }
    }
    add_part(finish_mesh(raw, MissingNormals::flat), primitive, place);
  }

  void add_part(Mesh mesh, const json& primitive, const std::string& place) {
    std::string name;
    std::size_t key = SIZE_MAX;  // of those without material
    if (primitive.contains("material")) {
      key = number(primitive["material"], place + ".material", SIZE_MAX);
      const json& material = element("materials", key);
      if (material.contains("name") && material["name"].is_string())
        name = material["name"].get<std::string>();
    }
    // materials in the order of their first use
    const auto known = std::ranges::find(material_keys_, key);
    const auto index = static_cast<int>(known - material_keys_.begin());
    if (known == material_keys_.end()) {
      material_keys_.push_back(key);
      file_.materials.push_back(name);
    }
    file_.parts.push_back({std::move(mesh), index});
  }

  GltfDocument document_;
  const json& root_ = document_.root();
  std::vector<std::size_t> material_keys_;
  MeshFile file_;
  std::size_t triangles_ = 0, visits_ = 0;
};

}  // namespace

MeshFile parse_gltf(const FileBytes& file, const std::filesystem::path& folder) {
  return GltfReader(file, folder).read();
}

}  // namespace burnish
