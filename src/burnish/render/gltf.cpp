#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/render/frames.h>
#include <burnish/render/mesh_file.h>

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

std::vector<std::byte> from_base64(std::string_view text, const std::string& name, const std::string& place) {
  std::vector<std::byte> bytes;
  unsigned bits = 0, held = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
    if (!upper && !lower && !digit && c != '+' && c != '/')
      throw Error::in_file(name, place + ": base64",
                           fmt::format("byte 0x{:02x}", static_cast<unsigned char>(c)));
    const int value = upper ? c - 'A' : lower ? c - 'a' + 26 : digit ? c - '0' + 52 : c == '+' ? 62 : 63;
    bits = bits << 6 | static_cast<unsigned>(value);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> held & 0xff));
  }
  return bytes;
}

// The elements of an accessor as numbers.
struct Elements {
  std::size_t count = 0, width = 0;
  std::vector<double> values;

  Vec3 vec3(std::size_t i) const noexcept { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }
};

class GltfReader {
 public:
  GltfReader(const FileBytes& file, const std::filesystem::path& folder) : name_(file.name), folder_(folder) {
    std::string_view text = file.text();
    std::uint64_t offset = 0;
    if (text.starts_with("glTF")) {
      offset = 20;
      split_binary(text);
    }
    try {
      root_ = json::parse(text);
    } catch (const json::parse_error& error) {
      throw Error(name_, offset + error.byte, "JSON of glTF", "what is none");
    }
  }

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
    std::string shown = found.substr(0, 60);
    for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
    throw Error::in_file(name_, place + ": " + expected, shown);
  }

  void split_binary(std::string_view& text) {
    const auto word = [&](std::size_t at) {
      if (text.size() < at + 4) throw Error(name_, at, "4 bytes of a binary glTF", "the end");
      std::uint32_t value = 0;
      std::memcpy(&value, text.data() + at, 4);
      return value;
    };
    if (word(4) != 2) throw Error(name_, 4, "version 2", std::to_string(word(4)));
    const std::size_t size = word(12);
    if (word(16) != 0x4e4f534a) throw Error(name_, 16, "a chunk of JSON", fmt::format("0x{:x}", word(16)));
    if (size > text.size() - 20)
      throw Error(name_, 12, fmt::format("at most {} bytes of JSON", text.size() - 20), std::to_string(size));
    const std::string_view rest = text.substr(20 + size);
    if (!rest.empty()) {
      const std::size_t at = 20 + size, length = word(at);
      if (word(at + 4) != 0x004e4942)
        throw Error(name_, at + 4, "a binary chunk", fmt::format("0x{:x}", word(at + 4)));
      if (length > rest.size() - 8)
        throw Error(name_, at, fmt::format("at most {} bytes", rest.size() - 8), std::to_string(length));
      chunk_ = rest.substr(8, length);
    }
    text = text.substr(20, size);
  }

  const json& member(const json& of, const char* key, const std::string& place) const {
    if (!of.is_object() || !of.contains(key)) fail(place, fmt::format("'{}'", key), "none");
    return of[key];
  }
  std::size_t number(const json& value, const std::string& place, std::size_t below) const {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= below)
      fail(place, fmt::format("an integer below {}", below), value.dump());
    return value.get<std::size_t>();
  }
  std::size_t number_or(const json& of, const char* key, std::size_t otherwise, const std::string& place,
                        std::size_t below) const {
    const auto found = of.find(key);
    return found == of.end() ? otherwise : number(*found, place + "." + key, below);
  }
  /// Element i of a list of the root, `what` in errors.
  const json& element(const char* list, std::size_t i) const {
    const json& all = member(root_, list, "the file");
    const std::string place = fmt::format("{}[{}]", list, i);
    if (!all.is_array() || i >= all.size() || !all[i].is_object()) fail(place, "an object", "none");
    return all[i];
  }

  std::vector<std::size_t> roots() const {
    std::vector<std::size_t> found;
    const json& nodes = member(root_, "nodes", "the file");
    if (!nodes.is_array()) fail("nodes", "a list", nodes.dump());
    if (root_.contains("scenes")) {
      const std::size_t scene = number_or(root_, "scene", 0, "the file", SIZE_MAX);
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

  void read_primitive(const json& primitive, const std::string& place, const Matrix& matrix) {
    const json& attributes = member(primitive, "attributes", place);
    if (number_or(primitive, "mode", 4, place, 7) != 4)
      fail(place + ".mode", "4, triangles", primitive["mode"].dump());
    const auto read = [&](const char* key, std::size_t width) -> std::optional<Elements> {
      if (!attributes.is_object() || !attributes.contains(key)) return {};
      const std::string at = place + ".attributes." + key;
      Elements e = elements(number(attributes[key], at, SIZE_MAX), at);
      if (e.width != width) fail(at, fmt::format("{} components", width), std::to_string(e.width));
      return e;
    };
    const auto positions = read("POSITION", 3), normals = read("NORMAL", 3), tangents = read("TANGENT", 4),
               uvs = read("TEXCOORD_0", 2);
    if (!positions) fail(place + ".attributes", "POSITION", "none");
    for (const auto* other : {&normals, &tangents, &uvs})
      if (*other && (*other)->count != positions->count)
        fail(place, fmt::format("{} of every attribute", positions->count), std::to_string((*other)->count));
    std::vector<std::size_t> order;
    if (primitive.contains("indices")) {
      const std::string at = place + ".indices";
      const Elements list = elements(number(primitive["indices"], at, SIZE_MAX), at);
      if (list.width != 1) fail(at, "one component", std::to_string(list.width));
      for (const double v : list.values) {
        if (!(v >= 0) || v >= static_cast<double>(positions->count) || v != std::floor(v))
          fail(at, fmt::format("indices below {}", positions->count), fmt::format("{}", v));
        order.push_back(static_cast<std::size_t>(v));
      }
    } else {
      for (std::size_t i = 0; i < positions->count; ++i) order.push_back(i);
    }
    if (order.size() % 3 != 0) fail(place, "corners by threes", std::to_string(order.size()));
    triangles_ += order.size() / 3;
    if (triangles_ > kMostTriangles) fail(place, fmt::format("at most {} triangles", kMostTriangles), "more");
    if (order.empty()) return;
    const bool mirrored = determinant(matrix) < 0;
    if (mirrored)
      for (std::size_t i = 0; i < order.size(); i += 3) std::swap(order[i + 1], order[i + 2]);
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
    const auto known = std::ranges::find(material_keys_, key);
    const auto index = static_cast<int>(known - material_keys_.begin());
    if (known == material_keys_.end()) {
      material_keys_.push_back(key);
      file_.materials.push_back(name);
    }
    file_.parts.push_back({std::move(mesh), index});
  }

  std::string_view buffer(std::size_t index) {
    const std::string place = fmt::format("buffers[{}]", index);
    const json& entry = element("buffers", index);
    if (buffers_.size() <= index) buffers_.resize(index + 1);
    const std::size_t length = number(member(entry, "byteLength", place), place + ".byteLength", SIZE_MAX);
    std::string_view bytes;
    if (!entry.contains("uri")) {
      if (index != 0 || chunk_.empty()) fail(place, "a uri", "none");
      bytes = chunk_;
    } else {
      if (buffers_[index].empty()) buffers_[index] = load(entry["uri"], place);
      bytes = {reinterpret_cast<const char*>(buffers_[index].data()), buffers_[index].size()};
    }
    if (bytes.size() < length) fail(place, fmt::format("{} bytes", length), std::to_string(bytes.size()));
    return bytes.substr(0, length);
  }
  std::vector<std::byte> load(const json& uri, const std::string& place) const {
    if (!uri.is_string()) fail(place + ".uri", "a string", uri.dump());
    const std::string text = uri.get<std::string>();
    if (text.starts_with("data:")) {
      const std::size_t comma = text.find(";base64,");
      if (comma == text.npos) fail(place + ".uri", "data as base64", text);
      return from_base64(std::string_view(text).substr(comma + 8), name_, place);
    }
    const std::filesystem::path path(text);
    if (path.is_absolute() || text.find("..") != text.npos || text.find(':') != text.npos)
      fail(place + ".uri", "a file beside this one", text);
    return read_file(folder_ / path, std::uint64_t{1} << 31).bytes;
  }

  Elements elements(std::size_t index, const std::string& user) {
    const json& accessor = element("accessors", index);
    const std::string place = fmt::format("{}: accessors[{}]", user, index);
    if (accessor.contains("sparse")) fail(place, "an accessor that is not sparse", "a sparse one");
    const json& type = member(accessor, "type", place);
    constexpr std::string_view kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto known = std::ranges::find(kTypes, type.is_string() ? type.get<std::string>() : "");
    if (known == std::end(kTypes)) fail(place + ".type", "SCALAR or VEC2 to VEC4", type.dump());
    Elements e;
    e.width = static_cast<std::size_t>(known - std::begin(kTypes)) + 1;
    const std::size_t kind = number(member(accessor, "componentType", place), place + ".componentType", 5127);
    const std::size_t bytes = kind == 5121 ? 1 : kind == 5123 ? 2 : kind == 5125 || kind == 5126 ? 4 : 0;
    if (bytes == 0) fail(place + ".componentType", "5121, 5123, 5125 or 5126", std::to_string(kind));
    e.count = number(member(accessor, "count", place), place + ".count", 3 * kMostTriangles + 1);
    const json& view = element(
        "bufferViews", number(member(accessor, "bufferView", place), place + ".bufferView", SIZE_MAX));
    const std::string_view all = buffer(number(member(view, "buffer", place), place + ".buffer", 1000));
    const std::size_t view_start = number_or(view, "byteOffset", 0, place, all.size() + 1);
    const std::size_t view_size =
        number(member(view, "byteLength", place), place + ".byteLength", all.size() - view_start + 1);
    const std::size_t start = number_or(accessor, "byteOffset", 0, place, view_size + 1);
    const std::size_t size = bytes * e.width, step = number_or(view, "byteStride", size, place, 253);
    if (step < size) fail(place + ".byteStride", fmt::format("at least {}", size), std::to_string(step));
    if (e.count > 0 && (view_size - start < size || (view_size - start - size) / step < e.count - 1))
      fail(place, fmt::format("{} bytes of its buffer", (e.count - 1) * step + size),
           std::to_string(view_size - start));
    const bool normalized = accessor.contains("normalized") && accessor["normalized"] == json(true);
    const double scale = normalized && bytes < 4 ? 1.0 / ((1 << 8 * bytes) - 1) : 1;
    e.values.reserve(e.count * e.width);
    for (std::size_t i = 0; i < e.count; ++i)
      for (std::size_t c = 0; c < e.width; ++c) {
        const char* at = all.data() + view_start + start + i * step + c * bytes;
        std::uint32_t integer = 0;
        std::memcpy(&integer, at, bytes);
        float real = 0;
        if (kind == 5126) std::memcpy(&real, at, 4);
        const double value = kind == 5126 ? static_cast<double>(real) : scale * integer;
        if (!(std::abs(value) <= 1e18))
          fail(place, fmt::format("element {} to be finite", i), fmt::format("{}", value));
        e.values.push_back(value);
      }
    return e;
  }

  std::string name_;
  std::filesystem::path folder_;
  json root_;
  std::string_view chunk_;
  std::vector<std::vector<std::byte>> buffers_;
  std::vector<std::size_t> material_keys_;
  MeshFile file_;
  std::size_t triangles_ = 0, visits_ = 0;
};

}  // namespace

MeshFile parse_gltf(const FileBytes& file, const std::filesystem::path& folder) {
  return GltfReader(file, folder).read();
}

}  // namespace burnish
