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
  static constexpr std::size_t kMaxVectors = 8;    ///< of a plane; longer lines have rows only
  static constexpr std::size_t kMaxSlots = 1024;   ///< different positions in tables
  static constexpr std::size_t kMaxBlock = 128;    ///< directions that go through the steps together
  static constexpr std::size_t kMaxSteps = 64;     ///< of one pair; models of more go the way of batches

  /// A position along an axis of tables, in cells from 0 to `cells`. With (x, y) of length r of the projected
  /// vector, a line's is `size` times its warped tan(theta / 2), size = cells; a disk's two, in slot and
  /// slot + 1, are cells / 2 + (x, y) / r times that, size = cells / 2.
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
    /// difference: with its azimuth; angle: the polar angle alone of what is no affine combination.
    enum class Kind { wi, wo, half, affine, difference, angle };
    Kind kind;
    Projection projection;
    bool radius = false;  // some position needs r
    std::vector<Position> positions;
  };

  /// A lookup, or two of the same table that swapping the directions exchanges. Offsets into `values`.
  struct Lookup {
    int axes = 1;
    bool shared = false, pair = false;                         // shared by the channels
    std::array<std::size_t, 3> at{}, pair_at{};                // slots, one an axis
    std::array<std::uint32_t, 3> steps_at{}, pair_steps_at{};  // lanes of `steps`
    std::size_t width = 0, layer = 0;                          // nodes of a row, and of a volume's layer
    /// Channels apart, each in whole vectors, 1, 2, 4 or 8; 0: none, the table is too long or no line.
    std::size_t planes = 0, plane_vectors = 0;
    /// Three channels and a gap a node, these again for every three channels, next_group floats on: 0 if shared.
    std::size_t rows = 0, row_block = 0, next_group = 0;
  };

  /// For one pair at a time positions are the lanes: what is looked up along an axis, eight together, the last
  /// of them filled up. A lane's position becomes a fraction and a way through the rows.
  enum class Spacing { identity, rational, power, root, given };  // root: a power of 1/2; given: see below
  static constexpr std::size_t kSpacings = 5;
  /// The polar angles that are found together; those of all other projections are found one by one.
  enum class Angle { wi, wo, half, azimuth, difference, deviation };
  struct Steps {
    static constexpr std::size_t kLanes = 8;

    std::size_t used = 0;               // lanes
    std::array<bool, kSpacings> has{};  // of some lane
    std::array<Spacing, kLanes> spacing{};
    alignas(32) std::array<std::array<std::int32_t, kLanes>, kSpacings> is{};  // -1 in lanes of a spacing
    alignas(32) std::array<float, kLanes> size{}, parameter{}, cells{};        // as in Position
    alignas(32) std::array<std::int32_t, kLanes> floats{};  // of the rows, from node to node
    alignas(32) std::array<std::int32_t, kLanes> angle{};   // an Angle, or one of `apart`
    bool has_apart = false;
    alignas(32) std::array<std::int32_t, kLanes> is_apart{};  // -1 in lanes whose angle is
  };
  /// Positions that are found one by one: of disks and of projections that `apart` has no place for.
  struct GivenSteps {
    Source::Kind kind;
    Projection projection;
    Position position;
    Spacing spacing;
    std::uint32_t x, y;  // lanes
  };

  /// One lobe of a volume over theta_h, theta_d, phi_d times a line over theta_h, three channels: what a fit of two
  /// fetches has. The line has the scale in it; without one it is the scale alone. Lanes: theta_d of the volume,
  /// theta_h of the line and of the volume, phi_d.
  struct VolumeAndLine {
    static constexpr std::size_t kLanes = 4;

    alignas(16) std::array<float, kLanes> cells{};
    alignas(16) std::array<std::int32_t, kLanes> root{};    // -1: even along the root of tan(theta / 2)
    alignas(16) std::array<std::int32_t, kLanes> floats{};  // of the rows, from node to node
    /// The offset that `floats` times the bits of 1.5 2^23 + node lacks to the node's first float, modulo 2^32. The
    /// volume's is the sum over its lanes.
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
  /// channels.
  template <class Real>
  using EvalOne = void (*)(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, Real* f);
  EvalOne<float> one_in_floats = nullptr;
  EvalOne<double> one_in_doubles = nullptr;
  /// The same with kRowStride weights a lobe, of one or three channels.
  void (*one_weighted)(const FactoredPlan& plan, const Vec3& wi, const Vec3& wo, const float* weights,
                       float* f) = nullptr;

  std::size_t channels, slots = 0;
  bool needs_sum = false;  // wi + wo
  bool isotropic;
  double rounding_bound = 0;
  std::vector<Source> sources;
  std::vector<Steps> steps;
  std::vector<Projection> apart;  // whose polar angles are found one by one, at most Steps::kLanes
  std::vector<GivenSteps> given;
  std::array<bool, Steps::kLanes> has_angle{};  // an Angle is asked for
  std::vector<Product> products;
  std::optional<VolumeAndLine> volume_and_line;  // the model is one
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
