#include <algorithm>
#include <utility>

#include <burnish/fitting/lane_gram.h>
#include <burnish/math/highway_targets.h>
#include <burnish/math/parallel.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "burnish/fitting/lane_gram.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef BURNISH_FITTING_LANE_GRAM
#define BURNISH_FITTING_LANE_GRAM
namespace burnish {
namespace {

constexpr std::size_t kMostTerms = 2 * LobeLanes::kLanes;  // of a piece

// One piece of all rows.
struct PieceRows {
  const std::uint32_t* place;
  const float* value;
  std::size_t terms, width;
};

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Adds `scale` times the products of two pieces of all rows to a matrix, a's places being the columns.
template <std::size_t most_lanes>
void add_outer(const PieceRows& a, const PieceRows& b, std::size_t rows, double scale, double* matrix,
               std::size_t stride) {
  const hn::CappedTag<double, most_lanes> d;
  const hn::Rebind<float, decltype(d)> narrow;
  for (std::size_t r = 0; r < rows; ++r) {
    double factor[kMostTerms];
    for (std::size_t i = 0; i < a.terms; ++i)
      factor[i] = scale * static_cast<double>(a.value[r * a.width + i]);
    double* into = matrix + a.place[r] * stride + b.place[r];
    for (std::size_t l = 0; l < b.width; l += hn::Lanes(d)) {
      const auto values = hn::PromoteTo(d, hn::LoadU(narrow, b.value + r * b.width + l));
      for (std::size_t i = 0; i < a.terms; ++i) {
        double* at = into + i * stride + l;
        hn::StoreU(hn::MulAdd(hn::Set(d, factor[i]), values, hn::LoadU(d, at)), d, at);
      }
    }
  }
}

void add_products(const PieceRows& a, const PieceRows& b, std::size_t rows, double scale, double* matrix,
                  std::size_t stride) {
  (b.width == 2 ? add_outer<2> : add_outer<8>)(a, b, rows, scale, matrix, stride);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(add_products);

// Products of two families' values, the columns being the first's.
struct GramBlock {
  std::size_t column, row, stride, start;
};

std::vector<GramBlock> blocks_of(const LaneRows& j) {
  std::vector<GramBlock> blocks;
  std::size_t start = 0;
  for (std::size_t f = 0; f < j.families.size(); ++f)
    for (std::size_t g = f; g < j.families.size(); ++g) {
      // vectors run along the family of more lanes
      const auto [column, row] =
          j.families[f].lanes.size() <= j.families[g].lanes.size() ? std::pair(f, g) : std::pair(g, f);
      // beyond the last value, vectors add zeros; columns do not fall on one line of a cache
      const std::size_t stride = (j.families[row].unknown.size() + kMostTerms + 7) / 8 * 8 | 8;
      blocks.push_back({column, row, stride, start});
      start += stride * j.families[column].unknown.size() + kMostTerms;
    }
  return blocks;
}

void add_to_triangle(const LaneRows& j, const GramBlock& block, const Eigen::VectorXd& scale,
                     Eigen::MatrixXd& gram) {
  const std::vector<std::uint32_t>&columns = j.families[block.column].unknown,
        &rows = j.families[block.row].unknown;
  const double* from = j.room.data() + block.start;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto u = static_cast<Eigen::Index>(columns[c]);
    const double* products = from + c * block.stride;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto v = static_cast<Eigen::Index>(rows[r]);
      double product = scale[u] * scale[v] * products[r];
      if (block.column == block.row) {
        if (v < u) continue;
        product += scale[u] * scale[v] * from[r * block.stride + c];
      } else if (u == v) {
        product *= 2;
      }
      gram(std::max(u, v), std::min(u, v)) += product;
    }
  }
}

}  // namespace

void LaneRows::layout(const LobeLanes& model, std::size_t first, std::size_t last, std::size_t row_count) {
  families.clear();
  pieces.clear();
  rows = row_count;
  std::vector<std::size_t> number;  // of the model's families
  for (const LobeLanes::Family& family : model.families()) {
    Family kept;
    bool copies = false;
    std::size_t nodes = 0;
    for (std::size_t l = 0; l < LobeLanes::kLanes && !(family.one_table && kept.lanes.size() == 1); ++l) {
      if (family.tables[l] == LobeLanes::kNone) continue;
      const LobeLanes::Unknowns& table = model.tables()[family.tables[l]];
      if (table.base < first || table.base >= last) continue;
      kept.lanes.push_back(l);
      copies = copies || table.copies > 1;
      nodes = table.layout.node_count();
    }
    number.push_back(kept.lanes.empty() ? LobeLanes::kNone : families.size());
    if (kept.lanes.empty()) continue;
    for (std::size_t c = 0; c < (copies ? model.channels() : 1); ++c)
      for (std::size_t n = 0; n < nodes; ++n)
        for (const std::size_t l : kept.lanes) {
          const LobeLanes::Unknowns& table = model.tables()[family.tables[l]];
          kept.unknown.push_back(
              static_cast<std::uint32_t>(table.base + n * table.stride + (table.copies > 1 ? c : 0) - first));
        }
    kept.copy_size = copies ? nodes * kept.lanes.size() : 0;
    families.push_back(std::move(kept));
  }
  std::size_t start = 0;
  for (std::size_t s = 0; s < model.slots().size(); ++s) {
    const std::size_t family = number[model.slots()[s].family];
    if (family == LobeLanes::kNone) continue;
    for (const bool second_row : {false, true}) {
      if (second_row && model.slots()[s].next_row == 0) continue;
      pieces.push_back({family, s, second_row, start});
      start += rows * width(families[family].lanes.size());
    }
  }
  place.resize(pieces.size() * rows);
  value.resize(start);
}

void LaneRows::set(const LobeLanes& model, std::size_t pair, std::size_t channel, std::size_t r,
                   const LobeLanes::Block& at, float root) {
  const std::size_t i = pair % LobeLanes::kBlock;
  const Lookups::Place* places = model.places(pair / LobeLanes::kBlock) + i;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Piece& piece = pieces[p];
    const LobeLanes::Slot& slot = model.slots()[piece.slot];
    const Family& family = families[piece.family];
    const std::size_t lanes = family.lanes.size();
    const auto [node, fx, fy] = places[slot.place * LobeLanes::kBlock];
    const std::size_t next = piece.second_row ? slot.next_row / LobeLanes::kLanes : 0;
    place[p * rows + r] = static_cast<std::uint32_t>(channel * family.copy_size + (node + next) * lanes);
    const float* slopes = at.factor.data() + piece.slot * LobeLanes::kBlockLanes + i * LobeLanes::kLanes;
    const float part = root * (slot.next_row == 0 ? 1 : piece.second_row ? fy : 1 - fy);
    const float left = part * (1 - fx), right = part * fx;
    float* values = value.data() + piece.start + r * width(lanes);
    for (std::size_t l = 0; l < lanes; ++l) {
      values[l] = left * slopes[family.lanes[l]];
      values[lanes + l] = right * slopes[family.lanes[l]];
    }
    std::fill(values + 2 * lanes, values + width(lanes), 0.0f);
  }
}

void find_gram(LaneRows& j, const Eigen::VectorXd& scale, Eigen::MatrixXd& gram) {
  const std::vector<GramBlock> blocks = blocks_of(j);
  const GramBlock& end = blocks.back();
  j.room.resize(end.start + end.stride * j.families[end.column].unknown.size() + kMostTerms);
  const auto rows_of = [&](std::size_t p) {
    const std::size_t lanes = j.families[j.pieces[p].family].lanes.size();
    return PieceRows{j.place.data() + p * j.rows, j.value.data() + j.pieces[p].start, 2 * lanes,
                     LaneRows::width(lanes)};
  };
  for_each_chunk(blocks.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    const GramBlock& block = blocks[k];
    double* matrix = j.room.data() + block.start;
    std::fill_n(matrix, block.stride * j.families[block.column].unknown.size() + kMostTerms, 0.0);
    for (std::size_t a = 0; a < j.pieces.size(); ++a)
      for (std::size_t b = 0; b < j.pieces.size(); ++b) {
        if (j.pieces[a].family != block.column || j.pieces[b].family != block.row) continue;
        if (block.column == block.row && b < a) continue;
        // a block on the diagonal is added to its transpose
        HWY_DYNAMIC_DISPATCH(add_products)
        (rows_of(a), rows_of(b), j.rows, a == b ? 0.5 : 1, matrix, block.stride);
      }
  });
  gram.setZero(scale.size(), scale.size());
  for (const GramBlock& block : blocks) add_to_triangle(j, block, scale, gram);
}

}  // namespace burnish
#endif
