// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// The plan that the kernels of FactoredEvaluator carry out: a FactoredBrdf in floats, with everything shared found
/// beforehand, and with tables laid out for lookups by vectors.
struct FactoredPlan {
  static constexpr std::size_t kTogether = 3;      ///< channels that go through the lookups together
  static constexpr std::size_t kRowStride = 4;     ///< floats a node in a table's rows
  static constexpr std::size_t kPlaneVector = 16;  ///< floats of the vectors that hold planes
  static constexpr std::size_t kMaxVectors = 8;    ///< vectors of a plane; longer lines have rows only
  static constexpr std::size_t kMaxSlots = 1024;   ///< different positions in tables
  static constexpr std::size_t kMaxBlock = 128;    ///< directions that go through the steps together
  static constexpr std::size_t kMaxSteps = 64;     ///< steps of one pair; larger models use batches

  /// A position along an axis of tables, in cells from 0 to `cells`. (x, y) are those of the projected vector, and r
  /// is their length. A line's position is `size` times its warped tan(theta / 2), size = cells. A disk has two
  /// positions, in slot and slot + 1: cells / 2 + (x, y) / r times that, size = cells / 2.
  struct Position {
    bool disk;
    WarpKind warp;
    float parameter, size, cells;
    std::size_t slot;
    bool shares_power =
        false;  // with the position before: a line's, of the same power of the same tan(theta / 2)

    bool same_place(const Position& other) const noexcept;
  };

  /// An unnormalized projection and the positions that depend on it.
  struct Source {
    /// difference: with its azimuth; angle: only the polar angle, of a projection that is no affine combination.
    enum class Kind { wi, wo, half, affine, difference, angle };
    Kind kind;
    Projection projection;
    bool radius = false;  // some position needs r
    std::vector<Position> positions;
  };

  /// A lookup, or two lookups of one table that are exchanged when the directions are. Offsets are into `values`.
  struct Lookup {
    int axes = 1;
    bool shared = false, pair = false;                         // shared by the channels
    std::array<std::size_t, 3> at{}, pair_at{};                // slots, one an axis
    std::array<std::uint32_t, 3> steps_at{}, pair_steps_at{};  // lanes of `steps`
    std::size_t width = 0, layer = 0;                          // nodes of a row, and of a volume's layer
    /// Offset of the channels one by one, each in whole vectors, 1, 2, 4 or 8; 0: none, the table is too long or no
    /// line.
    std::size_t planes = 0, plane_vectors = 0;
    /// Offset of rows with three channels and a gap a node. The next three channels follow next_group floats later; 0
    /// if shared.
    std::size_t rows = 0, row_block = 0, next_group = 0;
  };

  /// Steps for one pair at a time, whose lanes are positions along axes, eight together; unused lanes are filled up.
  /// Each lane's position becomes a fraction and an offset in the rows.
  enum class Spacing { identity, rational, power, root, given };  // root: a power of 1/2; given: see below
  static constexpr std::size_t kSpacings = 5;
  /// The polar angles that are computed together; those of all other projections are computed one by one.
  enum class Angle { wi, wo, half, azimuth, difference, deviation };
  struct Steps {
    static constexpr std::size_t kLanes = 8;

    std::size_t used = 0;               // lanes
    std::array<bool, kSpacings> has{};  // spacings of the lanes
    std::array<Spacing, kLanes> spacing{};
    alignas(32) std::array<std::array<std::int32_t, kLanes>, kSpacings> is{};  // -1 in lanes of a spacing
    alignas(32) std::array<float, kLanes> size{}, parameter{}, cells{};        // see Position
    alignas(32) std::array<std::int32_t, kLanes> floats{};  // floats of the rows, from node to node
    alignas(32) std::array<std::int32_t, kLanes> angle{};   // an Angle, or one of `apart`
    bool has_apart = false;
    alignas(32) std::array<std::int32_t, kLanes> is_apart{};  // -1 in lanes whose angle is
  };
  /// Positions that are computed one by one: those of disks, and of projections for which `apart` has no room.
  struct GivenSteps {
    Source::Kind kind;
    Projection projection;
    Position position;
    Spacing spacing;
    std::uint32_t x, y;  // lanes
  };

  /// One lobe of a volume over theta_h, theta_d, phi_d times a line over theta_h, with three channels: the form of
  /// fits with two fetches. The line contains the scale; without a line there is only the scale. The lanes are
  /// theta_d of the volume, theta_h of the line and of the volume, and phi_d.
  struct VolumeAndLine {
    static constexpr std::size_t kLanes = 4;

    alignas(16) std::array<float, kLanes> cells{};
    alignas(16) std::array<std::int32_t, kLanes> root{};    // -1: even along the root of tan(theta / 2)
    alignas(16) std::array<std::int32_t, kLanes> floats{};  // floats of the rows, from node to node
    /// The number that is added to `floats` times the bits of 1.5 2^23 + node to give the node's first float, modulo
    /// 2^32. The volume's first float is the sum over its lanes.
    alignas(16) std::array<std::int32_t, kLanes> start{};
    std::size_t above = 0, layer = 0;  // floats to the next row and layer of the volume
  };

  struct Product {
    std::size_t first, last;   // in `lookups`
    std::vector<float> scale;  // a channel, filled up to whole groups and one more
  };

  /// Throws Error for more than kMaxSlots slots.
  explicit FactoredPlan(const FactoredBrdf& brdf);

  /// The function that evaluates one pair, for the instruction set that was chosen when the plan was made. f has the
  /// plan's channels.
  template <class Real>
  using EvalOne = void (*)(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, Real* f);
  EvalOne<float> one_in_floats = nullptr;
  EvalOne<double> one_in_doubles = nullptr;
  /// Evaluates one pair with kRowStride weights a lobe, for one or three channels.
  void (*one_weighted)(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, const float* weights,
                       float* f) = nullptr;

  std::size_t channels, slots = 0;
  bool needs_sum = false;  // wi + wo
  bool isotropic;
  double rounding_bound = 0;
  std::vector<Source> sources;
  std::vector<Steps> steps;
  std::vector<Projection> apart;  // their polar angles are computed one by one, at most Steps::kLanes
  std::vector<GivenSteps> given;
  std::array<bool, Steps::kLanes> has_angle{};  // true if an Angle is needed
  std::vector<Product> products;
  std::optional<VolumeAndLine> volume_and_line;  // set if the model is one
  std::vector<Lookup> lookups;
  std::vector<float> values;

 private:
  std::optional<VolumeAndLine> find_volume_and_line(const FactoredBrdf& brdf);
  Lookup add_table(const Table& table);
  std::array<std::size_t, 3> slots_of(const TableLayout& layout, const FactorUse& use);
  std::size_t slot_of(const Projection& projection, Warp warp, int nodes, bool disk);
  std::array<std::uint32_t, 3> steps_of(const TableLayout& layout, const FactorUse& use);
  std::uint32_t lane_of(Spacing spacing, const Position& position, std::size_t stride, std::size_t angle,
                        bool is_apart);
  std::uint32_t steps_along(const Projection& projection, Warp warp, int nodes, std::size_t stride);
  std::array<std::uint32_t, 2> steps_across(const TableLayout& layout, const FactorUse& use);
  Source& source_of(const Projection& projection, bool azimuth);
};

}  // namespace burnish
