#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>

#include <burnish/render/mesh/frames.h>

namespace burnish {

namespace {

// Numbers equal keys in the order they first come.
template <class Key>
std::vector<std::uint32_t> numbered(std::size_t count, Key key_of) {
  std::map<decltype(key_of(std::size_t{})), std::uint32_t> known;
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers[i] = known.try_emplace(key_of(i), static_cast<std::uint32_t>(known.size())).first->second;
  return numbers;
}

double angle_between(Vec3 a, Vec3 b) noexcept {
  return std::acos(std::clamp(dot(normalize(a), normalize(b)), -1.0, 1.0));
}

// Of a triangle that has no area: none.
Vec3 triangle_normal(const RawMesh& raw, std::size_t first) noexcept {
  const Vec3 n =
      cross(raw.positions[first + 1] - raw.positions[first], raw.positions[first + 2] - raw.positions[first]);
  return length(n) > 0 ? normalize(n) : Vec3{};
}

std::size_t next_corner(std::size_t i) noexcept {
  return i % 3 == 2 ? i - 2 : i + 1;
}
std::size_t last_corner(std::size_t i) noexcept {
  return i % 3 == 0 ? i + 2 : i - 1;
}

std::vector<Vec3> normals_of(const RawMesh& raw, MissingNormals missing) {
  const std::size_t count = raw.positions.size();
  std::vector<Vec3> normals(count);
  std::vector<Vec3> sums;
  std::vector<std::uint32_t> places;
  if (missing == MissingNormals::smooth) {
    places = numbered(count, [&](std::size_t i) {
      return std::array{raw.positions[i].x, raw.positions[i].y, raw.positions[i].z};
    });
    sums.resize(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    normals[i] = triangle_normal(raw, i - i % 3);
    if (missing == MissingNormals::smooth) {
      const Vec3 p = raw.positions[i];
      const double angle =
          angle_between(raw.positions[next_corner(i)] - p, raw.positions[last_corner(i)] - p);
      sums[places[i]] = sums[places[i]] + angle * normals[i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (missing == MissingNormals::smooth) normals[i] = sums[places[i]];
    if (!raw.normals.empty() && length(raw.normals[i]) > 0) normals[i] = raw.normals[i];
    normals[i] = normalize(normals[i]);
  }
  return normals;
}

struct Tangent {
  Vec3 along;
  float side = 1;
};

// What u runs along in a triangle, and whether it is mapped the right way round; none without area in the
// texture.
Tangent triangle_tangent(const RawMesh& raw, std::size_t first) noexcept {
  const auto edge = [&](std::size_t k) { return raw.positions[first + k] - raw.positions[first]; };
  const auto uv = [&](std::size_t k, std::size_t c) { return raw.uvs[first + k][c] - raw.uvs[first][c]; };
  const double area = uv(1, 0) * uv(2, 1) - uv(1, 1) * uv(2, 0);
  const Vec3 along = uv(2, 1) * edge(1) - uv(1, 1) * edge(2);
  if (area == 0 || length(along) == 0) return {};
  return {(area > 0 ? 1 : -1) * normalize(along), area > 0 ? 1.0f : -1.0f};
}

bool corners_coincide(const RawMesh& raw, std::size_t first) noexcept {
  const Vec3 &a = raw.positions[first], &b = raw.positions[first + 1], &c = raw.positions[first + 2];
  return a == b || b == c || c == a;
}

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t of(std::size_t i) noexcept {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) noexcept { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

// [Mikkelsen 2008]
std::vector<Tangent> tangents_of(const RawMesh& raw, const std::vector<Vec3>& normals) {
  const std::size_t count = raw.positions.size();
  const auto welded = numbered(count, [&](std::size_t i) {
    const Vec3 p = raw.positions[i], n = normals[i];
    return std::array{p.x, p.y, p.z, n.x, n.y, n.z, raw.uvs[i][0], raw.uvs[i][1]};
  });
  std::vector<Tangent> faces;
  std::vector<bool> gone;
  for (std::size_t i = 0; i < count; i += 3) {
    gone.push_back(corners_coincide(raw, i));
    faces.push_back(gone.back() ? Tangent{} : triangle_tangent(raw, i));
  }
  const auto face = [&](std::size_t corner) -> const Tangent& { return faces[corner / 3]; };
  const auto good = [&](std::size_t corner) { return face(corner).along != Vec3{}; };
  // Corners of one vertex belong together where their triangles share an edge and the way round; triangles
  // without area in the texture go with both ways, so a corner has two places.
  const auto place = [&](std::size_t corner, float side) { return side > 0 ? corner : count + corner; };
  Groups groups(2 * count);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
  for (std::size_t i = 0; i < count; ++i)
    if (!gone[i / 3]) edges.try_emplace({welded[i], welded[next_corner(i)]}, i);
  for (std::size_t i = 0; i < count; ++i) {
    if (gone[i / 3]) continue;
    const std::size_t j = next_corner(i);
    const auto other = edges.find({welded[j], welded[i]});
    if (other == edges.end()) continue;
    for (const float side : {1.0f, -1.0f}) {
      if (good(i) && face(i).side != side) continue;
      if (good(other->second) && face(other->second).side != side) continue;
      groups.join(place(i, side), place(next_corner(other->second), side));
      groups.join(place(j, side), place(other->second, side));
    }
  }
  std::vector<Vec3> sums(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 n = normals[i];
    const auto flat = [&](Vec3 w) { return w - dot(w, n) * n; };
    const Vec3 along = flat(face(i).along), p = raw.positions[i];
    if (length(along) == 0) continue;
    const double angle =
        angle_between(flat(raw.positions[next_corner(i)] - p), flat(raw.positions[last_corner(i)] - p));
    Vec3& sum = sums[groups.of(place(i, face(i).side))];
    sum = sum + angle * normalize(along);
  }
  // where no neighbour tells, what another triangle has at the same place
  std::vector<std::size_t> beside(count, count);
  for (std::size_t i = 0; i < count; ++i)
    if (good(i)) beside[welded[i]] = std::min(beside[welded[i]], i);
  std::vector<Tangent> tangents(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto sum_at = [&](std::size_t corner, float side) { return sums[groups.of(place(corner, side))]; };
    const std::size_t from = beside[welded[i]];
    if (good(i)) {
      const Vec3 sum = sum_at(i, face(i).side);
      tangents[i] = {length(sum) > 0 ? sum : face(i).along, face(i).side};
    } else if (const Vec3 right = sum_at(i, 1), left = sum_at(i, -1); length(right) + length(left) > 0) {
      tangents[i] = length(right) > 0 ? Tangent{right, 1} : Tangent{left, -1};
    } else if (from < count) {
      tangents[i] = {sum_at(from, face(from).side), face(from).side};
    } else {
      tangents[i] = {tangent_around_y(normals[i]), 1};
    }
  }
  return tangents;
}

}  // namespace

Mesh finish_mesh(const RawMesh& raw, MissingNormals missing) {
  const std::size_t count = raw.positions.size();
  assert(count % 3 == 0);
  const std::vector<Vec3> normals = normals_of(raw, missing);
  std::vector<Tangent> tangents(count);
  if (!raw.tangents.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [x, y, z, side] = raw.tangents[i];
      tangents[i] = {{x, y, z}, side < 0 ? -1.0f : 1.0f};
    }
  } else if (!raw.uvs.empty()) {
    tangents = tangents_of(raw, normals);
  } else {
    for (std::size_t i = 0; i < count; ++i) tangents[i] = {tangent_around_y(normals[i]), 1};
  }
  std::vector<Vertex> corners(count);
  for (std::size_t i = 0; i < count; ++i) {
    corners[i] = {.position = to_floats(raw.positions[i]),
                  .normal = to_floats(normals[i]),
                  .tangent = to_floats(orthogonalized(tangents[i].along, normals[i])),
                  .side = tangents[i].side};
    if (!raw.uvs.empty())
      corners[i].uv = {static_cast<float>(raw.uvs[i][0]), static_cast<float>(raw.uvs[i][1])};
  }
  const auto numbers = numbered(count, [&](std::size_t i) {
    const Vertex& v = corners[i];
    return std::array{v.position[0], v.position[1], v.position[2], v.normal[0], v.normal[1], v.normal[2],
                      v.tangent[0],  v.tangent[1],  v.tangent[2],  v.side,      v.uv[0],     v.uv[1]};
  });
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i)
    if (numbers[i] == mesh.vertices.size()) mesh.vertices.push_back(corners[i]);
  for (std::size_t i = 0; i < count; i += 3)
    mesh.triangles.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return mesh;
}

}  // namespace burnish
