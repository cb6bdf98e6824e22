#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/eval/factored_eval.h>

// Compiled without contraction to fused multiply-adds (CMakeLists.txt): a fused a * x + b * y differs from
// b * y + a * x, and swapping the directions would change the last bit.

namespace burnish {

namespace {

constexpr std::size_t kMostBlock = 64;  // directions that go through the steps together
constexpr std::size_t kCells = 4096;    // cells of a block, 32 KB

enum class SourceKind { wi, wo, half, difference_angle, deviation_angle, difference, affine };

// A position in tables: u = r a / (r b + den c), or (r / den)^power where power is not 0, times `cells`.
// Of a disk two, in slot and slot + 1: u's components along x and y.
struct Coordinate {
  bool disk;
  float a, b, c, power, cells;
  std::size_t slot;
};

// A projection as an unnormalized (x, y) of length r, and den with r / den = tan(theta / 2).
struct Source {
  SourceKind kind;
  Projection projection;
  std::vector<Coordinate> coordinates;
};

// A lookup, or two of the same table that swapping the directions exchanges.
struct Use {
  std::size_t table;   // in Plan::values
  std::size_t stride;  // between nodes; 1: shared by the channels
  std::size_t width;   // nodes along x; 0: a line
  std::size_t x, y;    // slots
  bool pair;
  std::size_t pair_x, pair_y;
};

struct LobeUses {
  std::size_t scale, first, last;  // in Plan::scales, Plan::uses
};

struct Directions {
  const float *wi_x, *wi_y, *wi_z, *wo_x, *wo_y, *wo_z;
};

struct Cell {
  std::int32_t node;
  float fraction;
};

Cell find_cell(float u, float cells) noexcept {
  // in this form not-a-number, of directions below the horizon, becomes 0
  const float below_one = u < 1 ? u : 1;
  const float position = (u > 0 ? below_one : 0) * cells;
  const float first = std::min(static_cast<float>(static_cast<std::int32_t>(position)), cells - 1);
  return {static_cast<std::int32_t>(first), position - first};
}

float stretch(float t, float power) noexcept {
  return power == 0.5f ? std::sqrt(t) : std::pow(t, power);
}

// Directions of one block; kMost is its capacity, so that a single direction costs no loops.
template <std::size_t kMost>
struct Block {
  std::array<float, kMost> sum_x, sum_y, sum_z, sum_length;  // wi + wo
  std::array<float, kMost> x, y, r, den;                     // of the source at hand
  std::array<std::int32_t, kCells> node;                     // [slot][direction]
  std::array<float, kCells> fraction;

  void add_directions(const Directions& in, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      sum_x[i] = in.wi_x[i] + in.wo_x[i];
      sum_y[i] = in.wi_y[i] + in.wo_y[i];
      sum_z[i] = in.wi_z[i] + in.wo_z[i];
      sum_length[i] = std::sqrt(sum_x[i] * sum_x[i] + sum_y[i] * sum_y[i] + sum_z[i] * sum_z[i]);
    }
  }

  void project_unit(const float* from_x, const float* from_y, const float* from_z,
                    std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = from_x[i];
      y[i] = from_y[i];
      r[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
      den[i] = 1 + from_z[i];
    }
  }

  void project_half(std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = sum_x[i];
      y[i] = sum_y[i];
      r[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
      den[i] = sum_length[i] + sum_z[i];
    }
  }

  // cos theta_d = |wi + wo| / 2, sin theta_d = |wi - wo| / 2
  void project_difference_angle(const Directions& in, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = in.wi_x[i] - in.wo_x[i], dy = in.wi_y[i] - in.wo_y[i], dz = in.wi_z[i] - in.wo_z[i];
      r[i] = std::sqrt(dx * dx + dy * dy + dz * dz);
      den[i] = 2 + sum_length[i];
    }
  }

  // the same of the mirrored light
  void project_deviation_angle(const Directions& in, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      const float dz = in.wi_z[i] - in.wo_z[i];
      r[i] = std::sqrt(sum_x[i] * sum_x[i] + sum_y[i] * sum_y[i] + dz * dz);
      const float dx = in.wi_x[i] - in.wo_x[i], dy = in.wi_y[i] - in.wo_y[i];
      den[i] = 2 + std::sqrt(dx * dx + dy * dy + sum_z[i] * sum_z[i]);
    }
  }

  // 2 d: wi - wo along the axes of the frame of h [Rusinkiewicz 1998]; of wi + wo they have no part
  void project_difference(const Directions& in, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = in.wi_x[i] - in.wo_x[i], dy = in.wi_y[i] - in.wo_y[i], dz = in.wi_z[i] - in.wo_z[i];
      const float across = std::sqrt(sum_x[i] * sum_x[i] + sum_y[i] * sum_y[i]);
      const float cos_phi = across > 0 ? sum_x[i] / across : 1, sin_phi = across > 0 ? sum_y[i] / across : 0;
      const float along = cos_phi * dx + sin_phi * dy;
      x[i] = sum_length[i] > 0 ? (sum_z[i] * along - across * dz) / sum_length[i] : along;
      y[i] = cos_phi * dy - sin_phi * dx;
      const float square = x[i] * x[i] + y[i] * y[i];
      r[i] = std::sqrt(square);
      den[i] = std::sqrt(square + sum_length[i] * sum_length[i]) + sum_length[i];
    }
  }

  void project_affine(const Projection& p, const Directions& in, std::size_t count) noexcept {
    const auto wi = static_cast<float>(p.wi), wo = static_cast<float>(p.wo), n = static_cast<float>(p.n),
               m = static_cast<float>(p.mirror);
    const bool equal = wi == wo;  // then rounded once, like Projection's reference
    for (std::size_t i = 0; i < count; ++i) {
      const auto combine = [&](float u, float v) { return equal ? wi * (u + v) : wi * u + wo * v; };
      x[i] = combine(in.wi_x[i], in.wo_x[i]) - m * in.wi_x[i];
      y[i] = combine(in.wi_y[i], in.wo_y[i]) - m * in.wi_y[i];
      const float up = combine(in.wi_z[i], in.wo_z[i]) + m * in.wi_z[i] + n;
      const float z = up > 0 ? up : 0;
      const float square = x[i] * x[i] + y[i] * y[i];
      r[i] = std::sqrt(square);
      den[i] = std::max(std::sqrt(square + z * z) + z, std::numeric_limits<float>::min());
    }
  }

  void find_cells(const Coordinate& k, std::size_t stride, std::size_t count) noexcept {
    std::int32_t* const node_x = node.data() + k.slot * stride;
    float* const fraction_x = fraction.data() + k.slot * stride;
    const auto set = [&](std::size_t at, float u) {
      const Cell cell = find_cell(u, k.cells);
      node_x[at] = cell.node;
      fraction_x[at] = cell.fraction;
    };
    const auto set_disk = [&](std::size_t i, float scale) {
      set(i, 0.5f + 0.5f * (x[i] * scale));
      set(stride + i, 0.5f + 0.5f * (y[i] * scale));
    };
    if (k.power != 0 && k.disk)
      for (std::size_t i = 0; i < count; ++i)
        set_disk(i, r[i] > 0 ? stretch(r[i] / den[i], k.power) / r[i] : 0);
    else if (k.power != 0)
      for (std::size_t i = 0; i < count; ++i) set(i, stretch(r[i] / den[i], k.power));
    else if (k.disk)
      for (std::size_t i = 0; i < count; ++i) set_disk(i, k.a / (k.b * r[i] + k.c * den[i]));
    else
      for (std::size_t i = 0; i < count; ++i) set(i, k.a * r[i] / (k.b * r[i] + k.c * den[i]));
  }
};

// Channels looked up together; four are a vector of g++ and clang.
template <std::size_t kLanes>
struct LaneVector {
  using type = float;
};
template <>
struct LaneVector<4> {
  typedef float type __attribute__((vector_size(16)));
};
template <std::size_t kLanes>
using Lanes = typename LaneVector<kLanes>::type;

template <class T>
T load(const float* from) noexcept {
  T v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

template <class T>
T mix(T low, T high, float fraction) noexcept {
  return low + fraction * (high - low);
}

float lane(float v, std::size_t) noexcept {
  return v;
}
float lane(Lanes<4> v, std::size_t c) noexcept {
  return v[c];
}

// The (bi)linear interpolation of Table for one direction.
template <class T, bool kLine>
T lookup(const float* table, std::size_t step, std::size_t width, Cell x, Cell y) noexcept {
  const auto node_x = static_cast<std::size_t>(x.node);
  if constexpr (kLine) {
    const float* const node = table + node_x * step;
    return mix(load<T>(node), load<T>(node + step), x.fraction);
  } else {
    const float* const node = table + (static_cast<std::size_t>(y.node) * width + node_x) * step;
    const float* const above = node + width * step;
    return mix(mix(load<T>(node), load<T>(node + step), x.fraction),
               mix(load<T>(above), load<T>(above + step), x.fraction), y.fraction);
  }
}

// product[i] *= the use's lookups, a pair's with each other first.
template <std::size_t kLanes, bool kShared, bool kLine, bool kPair, std::size_t kMost>
void multiply(const Use& use, const float* table, const Block<kMost>& block, std::size_t stride,
              std::size_t count, Lanes<kLanes>* product) noexcept {
  const auto value = [&](std::size_t x, std::size_t y, std::size_t i) {
    return lookup<Lanes<kShared ? 1 : kLanes>, kLine>(
        table, kShared ? 1 : use.stride, use.width,
        {block.node[x * stride + i], block.fraction[x * stride + i]},
        {block.node[y * stride + i], block.fraction[y * stride + i]});
  };
  for (std::size_t i = 0; i < count; ++i)
    product[i] *= kPair ? value(use.x, use.y, i) * value(use.pair_x, use.pair_y, i) : value(use.x, use.y, i);
}

template <std::size_t kLanes, std::size_t kMost>
void multiply(const Use& use, const float* table, const Block<kMost>& block, std::size_t stride,
              std::size_t count, Lanes<kLanes>* product) noexcept {
  const auto with = [&]<bool kShared, bool kLine>() {
    use.pair ? multiply<kLanes, kShared, kLine, true>(use, table, block, stride, count, product)
             : multiply<kLanes, kShared, kLine, false>(use, table, block, stride, count, product);
  };
  const bool shared = kLanes == 1 || use.stride == 1;
  if (use.width == 0)
    shared ? with.template operator()<true, true>() : with.template operator()<false, true>();
  else
    shared ? with.template operator()<true, false>() : with.template operator()<false, false>();
}

// Largest ratio of entries that one lookup mixes.
double steepest_ratio(const Table& table) noexcept {
  const auto channels = static_cast<std::size_t>(table.channels);
  const auto width = static_cast<std::size_t>(table.layout.width),
             height = static_cast<std::size_t>(table.layout.height);
  const std::size_t row = table.layout.shape == TableShape::line ? 0 : width * channels;
  double ratio = 1;
  for (std::size_t y = 0; y + (row ? 1 : 0) < height; ++y)
    for (std::size_t x = 0; x + 1 < width; ++x)
      for (std::size_t c = 0; c < channels; ++c) {
        const float* v = table.values.data() + (y * width + x) * channels + c;
        const auto [least, most] = std::minmax({v[0], v[channels], v[row], v[row + channels]});
        ratio = std::max(ratio, static_cast<double>(most) / least);
      }
  return ratio;
}

double lookup_bound(const Table& table) noexcept {
  const double ratio = steepest_ratio(table);
  const int axes = table.layout.shape == TableShape::line ? 1 : 2;
  const int cells = std::max(table.layout.width, table.layout.height) - 1;
  return 0x1p-24 * (8 * ratio + 16 * axes * cells * (ratio - 1));
}

}  // namespace

struct FactoredEvaluator::Plan {
  std::size_t channels = 0, lanes = 0;  // lanes: channels looked up together, 1 or 4
  std::size_t slots = 0;
  bool needs_sum = false;
  double rounding_bound = 0;
  std::vector<Source> sources;
  std::vector<LobeUses> lobes;
  std::vector<Use> uses;
  std::vector<float> scales, values;  // channels padded to whole groups of lanes

  std::size_t padded_channels() const noexcept { return (channels + lanes - 1) / lanes * lanes; }

  explicit Plan(const FactoredBrdf& brdf)
      : channels(static_cast<std::size_t>(brdf.channels())), lanes(channels == 1 ? 1 : 4) {
    std::vector<std::size_t> first_value;
    for (const Table& table : brdf.tables()) {
      first_value.push_back(values.size());
      const auto stored = static_cast<std::size_t>(table.channels);
      for (std::size_t i = 0; i < table.values.size(); i += stored) {
        values.insert(values.end(), table.values.data() + i, table.values.data() + i + stored);
        if (stored > 1) values.resize(values.size() + padded_channels() - stored);
      }
    }
    for (std::size_t j = 0; j < brdf.lobes().size(); ++j) {
      const std::span<const FactorUse> factors = brdf.ordered_factors(j);
      const std::size_t paired = 2 * brdf.pair_count(j);
      const LobeUses lobe{scales.size(), uses.size(), uses.size() + factors.size() - paired / 2};
      for (const double s : brdf.lobes()[j].scale) scales.push_back(static_cast<float>(s));
      scales.resize(lobe.scale + padded_channels());
      double bound = 0x1p-24 * static_cast<double>(brdf.lobes().size());
      for (std::size_t k = 0; k < factors.size(); ++k) {
        const Table& table = brdf.tables()[static_cast<std::size_t>(factors[k].table)];
        bound += lookup_bound(table);
        const auto [x, y] = slots_of(table.layout, factors[k]);
        if (k < paired && k % 2 == 1) {
          uses.back().pair = true;
          uses.back().pair_x = x;
          uses.back().pair_y = y;
          continue;
        }
        const bool line = table.layout.shape == TableShape::line;
        uses.push_back({.table = first_value[static_cast<std::size_t>(factors[k].table)],
                        .stride = table.channels == 1 ? 1 : padded_channels(),
                        .width = line ? 0 : static_cast<std::size_t>(table.layout.width),
                        .x = x,
                        .y = y,
                        .pair = false,
                        .pair_x = 0,
                        .pair_y = 0});
      }
      lobes.push_back(lobe);
      rounding_bound = std::max(rounding_bound, bound);
    }
    if (slots > kCells)
      throw Error(fmt::format("evaluator: expected at most {} positions in tables, found {}", kCells, slots));
  }

  std::array<std::size_t, 2> slots_of(const TableLayout& layout, const FactorUse& use) {
    const bool disk = layout.shape == TableShape::disk;
    const std::size_t x = slot_of(use.projection, layout.warp, layout.width, disk);
    if (disk) return {x, x + 1};
    if (layout.shape == TableShape::line) return {x, x};
    return {x, slot_of(use.projection_y, layout.warp_y, layout.height, false)};
  }

  // The slot of a position, the same for the same position.
  std::size_t slot_of(const Projection& projection, Warp warp, int nodes, bool disk) {
    Coordinate k{.disk = disk,
                 .a = 1,
                 .b = 0,
                 .c = 1,
                 .power = 0,
                 .cells = static_cast<float>(nodes - 1),
                 .slot = slots};
    const auto parameter = static_cast<float>(warp.parameter);
    if (warp.kind == WarpKind::power) k.power = parameter;
    if (warp.kind == WarpKind::rational) {  // t (1 + k) / (t + k) with t = r / den
      k.a = 1 + parameter;
      k.b = 1;
      k.c = parameter;
    }
    const auto position = [](const Coordinate& c) {
      return std::array{c.disk ? 1.0f : 0.0f, c.a, c.b, c.c, c.power, c.cells};
    };
    std::vector<Coordinate>& known = source_of(projection, disk).coordinates;
    for (const Coordinate& other : known)
      if (position(other) == position(k)) return other.slot;
    known.push_back(k);
    slots += disk ? 2 : 1;
    return k.slot;
  }

  Source& source_of(const Projection& projection, bool azimuth) {
    const SourceKind kind = projection == kProjectWi                      ? SourceKind::wi
                            : projection == kProjectWo                    ? SourceKind::wo
                            : projection == kProjectHalf                  ? SourceKind::half
                            : projection.kind == Projection::Kind::affine ? SourceKind::affine
                            : projection == kProjectDeviation             ? SourceKind::deviation_angle
                            : azimuth                                     ? SourceKind::difference
                                                                          : SourceKind::difference_angle;
    needs_sum |= kind != SourceKind::wi && kind != SourceKind::wo && kind != SourceKind::affine;
    for (Source& source : sources)
      if (source.kind == kind && source.projection == projection) return source;
    return sources.emplace_back(Source{kind, projection, {}});
  }

  template <std::size_t kMost>
  void find_cells(const Directions& in, Block<kMost>& block, std::size_t stride,
                  std::size_t count) const noexcept {
    if (needs_sum) block.add_directions(in, count);
    for (const Source& source : sources) {
      switch (source.kind) {
        case SourceKind::wi:
          block.project_unit(in.wi_x, in.wi_y, in.wi_z, count);
          break;
        case SourceKind::wo:
          block.project_unit(in.wo_x, in.wo_y, in.wo_z, count);
          break;
        case SourceKind::half:
          block.project_half(count);
          break;
        case SourceKind::difference_angle:
          block.project_difference_angle(in, count);
          break;
        case SourceKind::deviation_angle:
          block.project_deviation_angle(in, count);
          break;
        case SourceKind::difference:
          block.project_difference(in, count);
          break;
        case SourceKind::affine:
          block.project_affine(source.projection, in, count);
          break;
      }
      for (const Coordinate& coordinate : source.coordinates) block.find_cells(coordinate, stride, count);
    }
  }

  // Values of up to kMost directions; channel c of direction i at f[c * plane + i].
  template <std::size_t kLanes, std::size_t kMost>
  void eval(const Directions& in, std::size_t block_count, std::size_t block_stride, float* f,
            std::size_t plane) const noexcept {
    const std::size_t count = kMost == 1 ? 1 : block_count, stride = kMost == 1 ? 1 : block_stride;
    Block<kMost> block;
    find_cells(in, block, stride, count);
    Lanes<kLanes> product[kMost], sum[kMost];
    for (std::size_t group = 0; group < channels; group += kLanes) {
      std::fill_n(sum, count, Lanes<kLanes>{});
      for (const LobeUses& lobe : lobes) {
        std::fill_n(product, count, load<Lanes<kLanes>>(scales.data() + lobe.scale + group));
        // [HomomorphicBrdf, eq. 4]
        for (std::size_t k = lobe.first; k < lobe.last; ++k)
          multiply<kLanes>(uses[k], values.data() + uses[k].table + (uses[k].stride == 1 ? 0 : group), block,
                           stride, count, product);
        for (std::size_t i = 0; i < count; ++i) sum[i] += product[i];
      }
      for (std::size_t c = 0; c < std::min(kLanes, channels - group); ++c)
        for (std::size_t i = 0; i < count; ++i)
          f[(group + c) * plane + i] = in.wi_z[i] > 0 && in.wo_z[i] > 0 ? lane(sum[i], c) : 0;
    }
  }
};

FactoredEvaluator::FactoredEvaluator(const FactoredBrdf& brdf) : plan_(std::make_shared<Plan>(brdf)) {}

int FactoredEvaluator::channels() const noexcept {
  return static_cast<int>(plan_->channels);
}

double FactoredEvaluator::rounding_bound() const noexcept {
  return plan_->rounding_bound;
}

void FactoredEvaluator::eval(const DirectionSpans& d, std::span<float> f) const noexcept {
  const std::size_t count = d.size();
  assert(d.wi_y.size() == count && d.wi_z.size() == count && d.wo_x.size() == count &&
         d.wo_y.size() == count && d.wo_z.size() == count && f.size() == count * plan_->channels);
  const std::size_t stride = std::min(kMostBlock, kCells / std::max<std::size_t>(plan_->slots, 1));
  for (std::size_t i = 0; i < count; i += stride) {
    const Directions in{d.wi_x.data() + i, d.wi_y.data() + i, d.wi_z.data() + i,
                        d.wo_x.data() + i, d.wo_y.data() + i, d.wo_z.data() + i};
    const std::size_t part = std::min(stride, count - i);
    plan_->lanes == 1 ? plan_->eval<1, kMostBlock>(in, part, stride, f.data() + i, count)
                      : plan_->eval<4, kMostBlock>(in, part, stride, f.data() + i, count);
  }
}

void FactoredEvaluator::eval(Vec3 wi, Vec3 wo, std::span<float> f) const noexcept {
  assert(f.size() == plan_->channels);
  const std::array<float, 6> w{static_cast<float>(wi.x), static_cast<float>(wi.y), static_cast<float>(wi.z),
                               static_cast<float>(wo.x), static_cast<float>(wo.y), static_cast<float>(wo.z)};
  const Directions in{&w[0], &w[1], &w[2], &w[3], &w[4], &w[5]};
  plan_->lanes == 1 ? plan_->eval<1, 1>(in, 1, 1, f.data(), 1) : plan_->eval<4, 1>(in, 1, 1, f.data(), 1);
}

}  // namespace burnish
