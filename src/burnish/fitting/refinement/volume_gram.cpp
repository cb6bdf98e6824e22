#include <algorithm>
#include <array>
#include <utility>

#include <burnish/fitting/refinement/volume_gram.h>

namespace burnish {

namespace {

constexpr std::size_t kProducts = 27;  // three along each axis
constexpr std::size_t kCornerPairs = 36;

// Corners a >= b of a cell, bits x, y, z, and which product of weights they have.
struct CornerPair {
  std::uint8_t a, b, product;
};

constexpr std::array<CornerPair, kCornerPairs> corner_pairs() {
  std::array<CornerPair, kCornerPairs> pairs{};
  std::size_t k = 0;
  for (std::uint8_t a = 0; a < 8; ++a)
    for (std::uint8_t b = 0; b <= a; ++b) {
      // along an axis: both first, one of each, both second
      const auto along = [&](int bit) { return (a >> bit & 1) + (b >> bit & 1); };
      pairs[k++] = {a, b, static_cast<std::uint8_t>((along(2) * 3 + along(1)) * 3 + along(0))};
    }
  return pairs;
}
constexpr std::array<CornerPair, kCornerPairs> kPairs = corner_pairs();

struct Products {
  float value[3];
};

Products products(float f) {
  const float g = 1 - f;
  return {{g * g, f * g, f * f}};
}

const Projection& projection_of(const FactorUse& use, int axis) {
  return axis == 0 ? use.projection : axis == 1 ? use.projection_y : use.projection_z;
}

}  // namespace

std::optional<VolumeGram> VolumeGram::of(std::span<const LobeLanes::NumberedTable> tables,
                                         const Lookups& lookups) {
  if (lookups.lobes.size() != 1 || lookups.lobes.front().size() != tables.size() || tables.size() > 2)
    return {};
  VolumeGram gram;
  const FactorUse *volume = nullptr, *line = nullptr;
  for (std::size_t k = 0; k < lookups.lookups.size(); ++k) {
    const FactorUse& use = lookups.lookups[k];
    const auto& [number, layout] = tables[static_cast<std::size_t>(use.table)];
    if (number.copies != 1) return {};
    const Part part{k, layout.node_count(), static_cast<std::uint32_t>(number.base)};
    if (layout.shape == TableShape::volume && !volume) {
      volume = &use;
      gram.volume_ = part;
      const std::size_t width = static_cast<std::size_t>(layout.width),
                        height = static_cast<std::size_t>(layout.height);
      const std::size_t steps[] = {1, width, width * height},
                        sides[] = {width, height, static_cast<std::size_t>(layout.depth)};
      std::ranges::copy(steps, gram.steps_);
      std::ranges::copy(sides, gram.sides_);
    } else if (layout.shape == TableShape::line && !line) {
      line = &use;
      gram.line_ = part;
    } else {
      return {};
    }
  }
  if (!volume) return {};
  if (line) {
    int axis = 0;
    while (axis < 3 && projection_of(*volume, axis) != line->projection) ++axis;
    if (axis == 3) return {};
    gram.along_step_ = gram.steps_[axis];
    gram.along_nodes_ = gram.sides_[axis];
    gram.find_reach(lookups);
  }
  gram.size_ = gram.volume_.nodes + gram.line_.nodes;
  gram.cells_.resize(gram.volume_.nodes * kProducts);
  gram.across_.resize(gram.volume_.nodes * gram.reach_);
  gram.ends_.resize(3 * gram.line_.nodes);
  return gram;
}

void VolumeGram::find_reach(const Lookups& lookups) {
  // of the cells along the axis, and so of the layers at their ends
  constexpr std::size_t kBlock = Lookups::kBlock;
  std::vector<std::uint32_t> last(along_nodes_, 0);
  first_.assign(along_nodes_, static_cast<std::uint32_t>(line_.nodes));
  for (std::size_t i = 0; i < lookups.pairs; ++i) {
    const Lookups::Place* block =
        lookups.places.data() + i / kBlock * lookups.place_count * kBlock + i % kBlock;
    const std::size_t at = block[lookups.place_of[volume_.lookup] * kBlock].node / along_step_ % along_nodes_;
    const std::uint32_t node = block[lookups.place_of[line_.lookup] * kBlock].node;
    for (const std::size_t layer : {at, at + 1}) {
      first_[layer] = std::min(first_[layer], node);
      last[layer] = std::max(last[layer], node + 1);
    }
  }
  for (std::size_t k = 0; k < along_nodes_; ++k)
    if (last[k] > 0) reach_ = std::max<std::size_t>(reach_, last[k] - first_[k] + 1);
  for (std::uint32_t& first : first_)
    first = std::min(first, static_cast<std::uint32_t>(line_.nodes - reach_));
}

void VolumeGram::set_zero() {
  std::ranges::fill(cells_, 0.0f);
  std::ranges::fill(across_, 0.0f);
  std::ranges::fill(ends_, 0.0);
}

void VolumeGram::add(const Lookups::Place& in_volume, const Lookups::Place& in_line, float volume_slope,
                     float line_slope, float curvature) noexcept {
  // two corners of the volume
  const Products x = products(in_volume.fx), y = products(in_volume.fy), z = products(in_volume.fz);
  float plane[9];
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) plane[3 * j + i] = y.value[j] * x.value[i];
  float* cell = cells_.data() + in_volume.node * kProducts;
  const float twice = curvature * volume_slope * volume_slope;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 9; ++j) cell[9 * k + j] += twice * z.value[k] * plane[j];
  if (!has_line()) return;

  // a corner and an end of the line's interval
  const float once = curvature * volume_slope * line_slope, end = once * in_line.fx, start = once - end;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t node = in_volume.node + (k & 1) + (k & 2 ? steps_[1] : 0) + (k & 4 ? steps_[2] : 0);
    const float weight = (k & 1 ? in_volume.fx : 1 - in_volume.fx) *
                         (k & 2 ? in_volume.fy : 1 - in_volume.fy) *
                         (k & 4 ? in_volume.fz : 1 - in_volume.fz);
    float* to = across_.data() + node * reach_ + (in_line.node - first_[node / along_step_ % along_nodes_]);
    to[0] += weight * start;
    to[1] += weight * end;
  }

  // two ends
  const Products l = products(in_line.fx);
  for (std::size_t k = 0; k < 3; ++k)
    ends_[3 * in_line.node + k] += static_cast<double>(curvature * line_slope * line_slope * l.value[k]);
}

template <class Visit>
void VolumeGram::for_each_entry(Visit visit) const {
  // corners of cells
  for (std::size_t z = 0; z + 1 < sides_[2]; ++z)
    for (std::size_t y = 0; y + 1 < sides_[1]; ++y)
      for (std::size_t x = 0; x + 1 < sides_[0]; ++x) {
        const std::size_t first = z * steps_[2] + y * steps_[1] + x;
        const auto corner = [&](unsigned k) {
          return first + (k & 1) + (k & 2 ? steps_[1] : 0) + (k & 4 ? steps_[2] : 0);
        };
        for (const CornerPair& pair : kPairs)
          visit(volume_.base + corner(pair.a), volume_.base + corner(pair.b),
                static_cast<double>(cells_[first * kProducts + pair.product]));
      }
  if (!has_line()) return;
  // volume and line
  for (std::size_t n = 0; n < volume_.nodes; ++n)
    for (std::size_t k = 0; k < reach_; ++k)
      visit(volume_.base + n, line_.base + first_[n / along_step_ % along_nodes_] + k,
            static_cast<double>(across_[n * reach_ + k]));
  // neighbours on the line
  for (std::size_t n = 0; n + 1 < line_.nodes; ++n) {
    const std::size_t at = line_.base + n;
    visit(at, at, ends_[3 * n]);
    visit(at + 1, at, ends_[3 * n + 1]);
    visit(at + 1, at + 1, ends_[3 * n + 2]);
  }
}

void VolumeGram::set_constant(std::vector<Eigen::Triplet<double>> entries) {
  // places for all, then where each is
  const auto lower = [](std::size_t a, std::size_t b) {
    return std::pair(static_cast<int>(std::max(a, b)), static_cast<int>(std::min(a, b)));
  };
  for_each_entry([&](std::size_t a, std::size_t b, double) {
    const auto [row, column] = lower(a, b);
    entries.emplace_back(row, column, 0);
  });
  const auto size = static_cast<int>(size_);
  matrix_.resize(size, size);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  constant_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
  slots_.clear();
  for_each_entry([&](std::size_t a, std::size_t b, double) {
    const auto [row, column] = lower(a, b);
    const int *columns = matrix_.innerIndexPtr(), *starts = matrix_.outerIndexPtr();
    slots_.push_back(static_cast<std::uint32_t>(
        std::lower_bound(columns + starts[row], columns + starts[row + 1], column) - columns));
  });
}

void VolumeGram::by_logarithms(const Eigen::VectorXd& lambda) {
  std::ranges::copy(constant_, matrix_.valuePtr());
  std::size_t k = 0;
  for_each_entry([&](std::size_t a, std::size_t b, double value) {
    matrix_.valuePtr()[slots_[k++]] +=
        value * lambda[static_cast<Eigen::Index>(a)] * lambda[static_cast<Eigen::Index>(b)];
  });
}

}  // namespace burnish
