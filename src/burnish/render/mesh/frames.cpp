// SPDX-License-Identifier: Apache-2.0
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

// Returns the normal of a triangle; none if it has no area.
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

  // of a triangle; smooth ones are sums over the corners at a place, weighed by their angles
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

  // the file's own where it has them
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

// Returns the direction of u in a triangle, and whether it is mapped the right way round; none without area in the
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

// Sets that grow together: each is named by its root.
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

// The triangles' tangents, and what their corners belong to. A corner is good where its triangle has a tangent.
struct Faces {
  std::vector<Tangent> tangents;
  std::vector<bool> gone;  // corners coincide

  const Tangent& at(std::size_t corner) const noexcept { return tangents[corner / 3]; }
  bool good(std::size_t corner) const noexcept { return at(corner).along != Vec3{}; }
};

Faces faces_of(const RawMesh& raw) {
  Faces faces;
  for (std::size_t i = 0; i < raw.positions.size(); i += 3) {
    faces.gone.push_back(corners_coincide(raw, i));
    faces.tangents.push_back(faces.gone.back() ? Tangent{} : triangle_tangent(raw, i));
  }
  return faces;
}

// Corners of one vertex belong together where their triangles share an edge and the way round; triangles
// without area in the texture go with both ways, so a corner has two places, the second `count` further.
class CornerGroups {
 public:
  CornerGroups(const Faces& faces, const std::vector<std::uint32_t>& welded)
      : count_(welded.size()), groups_(2 * count_) {
    // a triangle's edge is its neighbour's the other way round
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
    for (std::size_t i = 0; i < count_; ++i)
      if (!faces.gone[i / 3]) edges.try_emplace({welded[i], welded[next_corner(i)]}, i);
    for (std::size_t i = 0; i < count_; ++i) {
      if (faces.gone[i / 3]) continue;
      const std::size_t j = next_corner(i);
      const auto other = edges.find({welded[j], welded[i]});
      if (other == edges.end()) continue;
      for (const float side : {1.0f, -1.0f}) {
        if (faces.good(i) && faces.at(i).side != side) continue;
        if (faces.good(other->second) && faces.at(other->second).side != side) continue;
        groups_.join(place(i, side), place(next_corner(other->second), side));
        groups_.join(place(j, side), place(other->second, side));
      }
    }
  }
  std::size_t of(std::size_t corner, float side) noexcept { return groups_.of(place(corner, side)); }

 private:
  std::size_t place(std::size_t corner, float side) const noexcept {
    return side > 0 ? corner : count_ + corner;
  }

  std::size_t count_;
  Groups groups_;
};

// Sums over each group of its corners' tangents in the plane at their normals, weighed by the corners' angles.
std::vector<Vec3> tangent_sums(const RawMesh& raw, const std::vector<Vec3>& normals, const Faces& faces,
                               CornerGroups& groups) {
  std::vector<Vec3> sums(2 * normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 n = normals[i];
    const auto flat = [&](Vec3 w) { return w - dot(w, n) * n; };
    const Vec3 along = flat(faces.at(i).along), p = raw.positions[i];
    if (length(along) == 0) continue;
    const double angle =
        angle_between(flat(raw.positions[next_corner(i)] - p), flat(raw.positions[last_corner(i)] - p));
    Vec3& sum = sums[groups.of(i, faces.at(i).side)];
    sum = sum + angle * normalize(along);
  }
  return sums;
}

// [Mikkelsen 2008]
std::vector<Tangent> tangents_of(const RawMesh& raw, const std::vector<Vec3>& normals) {
  const std::size_t count = raw.positions.size();
  const auto welded = numbered(count, [&](std::size_t i) {
    const Vec3 p = raw.positions[i], n = normals[i];
    return std::array{p.x, p.y, p.z, n.x, n.y, n.z, raw.uvs[i][0], raw.uvs[i][1]};
  });
  const Faces faces = faces_of(raw);
  CornerGroups groups(faces, welded);
  const std::vector<Vec3> sums = tangent_sums(raw, normals, faces, groups);

  // where no neighbour tells, what another triangle has at the same place
  std::vector<std::size_t> beside(count, count);
  for (std::size_t i = 0; i < count; ++i)
    if (faces.good(i)) beside[welded[i]] = std::min(beside[welded[i]], i);
  std::vector<Tangent> tangents(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto sum_at = [&](std::size_t corner, float side) { return sums[groups.of(corner, side)]; };
    const std::size_t from = beside[welded[i]];
    if (faces.good(i)) {
      const Vec3 sum = sum_at(i, faces.at(i).side);
      tangents[i] = {length(sum) > 0 ? sum : faces.at(i).along, faces.at(i).side};
    } else if (const Vec3 right = sum_at(i, 1), left = sum_at(i, -1); length(right) + length(left) > 0) {
      tangents[i] = length(right) > 0 ? Tangent{right, 1} : Tangent{left, -1};
    } else if (from < count) {
      tangents[i] = {sum_at(from, faces.at(from).side), faces.at(from).side};
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

  // tangents: the file's, of the texture, or around the vertical
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

  // a vertex a corner; those that are equal become one
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
