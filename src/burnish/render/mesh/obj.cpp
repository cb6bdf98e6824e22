// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/mesh/frames.h>
#include <burnish/render/mesh/mesh_file.h>

namespace burnish {

namespace {

struct Corner {
  std::size_t position = 0;
  std::optional<std::size_t> uv, normal;
};

class ObjReader {
 public:
  explicit ObjReader(const FileBytes& file) : name_(file.name), rest_(file.text()) {}

  MeshFile read() {
    while (next_line()) {
      const std::string_view keyword = word();
      if (keyword == "v")
        positions_.push_back(vector(3));
      else if (keyword == "vn")
        normals_.push_back(vector(3));
      else if (keyword == "vt")
        uvs_.push_back(vector(1));
      else if (keyword == "f")
        face();
      else if (keyword == "usemtl")
        material_ = material_of(std::string(word()));
    }
    if (triangles_ == 0) throw Error::in_file(name_, "at least one face", "none");

    // a part a material that has triangles
    MeshFile file{.parts = {}, .materials = names_};
    for (std::size_t i = 0; i < raws_.size(); ++i) {
      RawMesh& raw = raws_[i];
      if (!has_uvs_[i]) raw.uvs.clear();
      if (raw.positions.empty()) continue;
      file.parts.push_back({finish_mesh(raw, MissingNormals::smooth), static_cast<int>(i)});
    }
    return file;
  }

 private:
  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_ = end == rest_.npos ? std::string_view{} : rest_.substr(end + 1);
    ++number_;
    line_ = line_.substr(0, line_.find('#'));
    return true;
  }
  std::string_view word() noexcept {
    const std::size_t begin = line_.find_first_not_of(" \t\r");
    if (begin == line_.npos) return line_ = {};
    const std::size_t end = std::min(line_.find_first_of(" \t\r", begin), line_.size());
    const std::string_view found = line_.substr(begin, end - begin);
    line_ = line_.substr(end);
    return found;
  }
  [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
    std::string shown = "'" + std::string(found.substr(0, 40)) + "'";
    for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
    throw Error::in_line(name_, number_, expected, found.empty() ? "the end of the line" : shown);
  }
  // Three numbers, of which the first `needed` must be there.
  Vec3 vector(int needed) {
    double values[3] = {};
    for (int i = 0; i < 3; ++i) {
      const std::string_view text = word();
      if (text.empty() && i >= needed) break;
      const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), values[i]);
      if (code != std::errc{} || end != text.data() + text.size() || !(std::abs(values[i]) <= 1e18))
        fail("a number of at most 1e18", text);
    }
    return {values[0], values[1], values[2]};
  }
  // An index, from 1 or from the end, of what there are `count` of.
  std::size_t index(std::string_view text, std::string_view whole, std::size_t count) const {
    long long value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code == std::errc{} && end == text.data() + text.size()) {
      const auto size = static_cast<long long>(count);
      if (value >= 1 && value <= size) return static_cast<std::size_t>(value - 1);
      if (value <= -1 && value >= -size) return static_cast<std::size_t>(size + value);
    }
    fail(fmt::format("an index of one of the {} before it", count), whole);
  }
  Corner corner(std::string_view whole) const {
    std::string_view part[3];
    std::size_t parts = 0;
    for (std::string_view rest = whole;;) {
      if (parts == 3) fail("place/coordinate/normal", whole);
      const std::size_t slash = rest.find('/');
      part[parts++] = rest.substr(0, slash);
      if (slash == rest.npos) break;
      rest = rest.substr(slash + 1);
    }
    Corner found{.position = index(part[0], whole, positions_.size()), .uv = {}, .normal = {}};
    if (!part[1].empty()) found.uv = index(part[1], whole, uvs_.size());
    if (!part[2].empty()) found.normal = index(part[2], whole, normals_.size());
    return found;
  }
  void face() {
    std::vector<Corner> corners;
    for (std::string_view text = word(); !text.empty(); text = word()) corners.push_back(corner(text));
    if (corners.size() < 3) fail("at least three corners", fmt::format("{}", corners.size()));
    if (!material_) material_ = material_of("");
    // a fan about the first corner
    for (std::size_t k = 2; k < corners.size(); ++k)
      for (const std::size_t i : {std::size_t{0}, k - 1, k}) append(corners[i]);
    triangles_ += corners.size() - 2;
    if (triangles_ > kMaxTriangles) fail(fmt::format("at most {} triangles", kMaxTriangles), "more of them");
  }
  void append(const Corner& c) {
    RawMesh& raw = raws_[*material_];
    raw.positions.push_back(positions_[c.position]);
    raw.normals.push_back(c.normal ? normals_[*c.normal] : Vec3{});
    raw.uvs.push_back(c.uv ? std::array{uvs_[*c.uv].x, uvs_[*c.uv].y} : std::array{0.0, 0.0});
    has_uvs_[*material_] = has_uvs_[*material_] || c.uv.has_value();
  }
  std::size_t material_of(std::string name) {
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (names_[i] == name) return i;
    names_.push_back(std::move(name));
    raws_.emplace_back();
    has_uvs_.push_back(false);
    return names_.size() - 1;
  }

  std::string name_;
  std::string_view rest_, line_;
  std::uint64_t number_ = 0;
  std::vector<Vec3> positions_, normals_, uvs_;
  std::vector<std::string> names_;
  std::vector<RawMesh> raws_;  // one a name
  std::vector<bool> has_uvs_;
  std::optional<std::size_t> material_;
  std::size_t triangles_ = 0;
};

}  // namespace

MeshFile parse_obj(const FileBytes& file) {
  return ObjReader(file).read();
}

MeshFile read_mesh(const std::filesystem::path& path) {
  const FileBytes file = read_file(path, std::uint64_t{1} << 31);
  const std::string_view text = file.text();
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (text.starts_with("glTF") || (first != text.npos && text[first] == '{'))
    return parse_gltf(file, path.parent_path());
  if (text.substr(0, 4096).find('\0') != text.npos)
    throw Error::in_file(file.name, "a mesh as OBJ or glTF", "some other binary file");
  return parse_obj(file);
}

}  // namespace burnish
