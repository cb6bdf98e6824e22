// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <burnish/fitting/refinement/lane_gram.h>
#include <burnish/math/parallel.h>

#define HWY_TARGET_INCLUDE "burnish/fitting/refinement/lane_gram.cpp"
#include <burnish/math/highway-inl.h>

#ifndef BURNISH_FITTING_LANE_GRAM
#define BURNISH_FITTING_LANE_GRAM
namespace burnish {
namespace {

// One piece of all rows: two neighbouring nodes a row, with the slopes of the family's lanes.
struct PieceRows {
  const std::uint32_t* node;
  const float* value;
  std::size_t lanes, width;
};

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

// Adds `scale` times the products of two pieces of all rows to a matrix, whose columns are a's nodes and lanes.
// A vector ends with a node. Stored numbers are loaded again soon, and that is fast only in the same vectors.
template <std::size_t width>
void add_outer(const PieceRows& a, const PieceRows& b, std::size_t rows, double scale, double* matrix,
               std::size_t stride) {
  const hn::CappedTag<double, width> d;
  const hn::Rebind<float, decltype(d)> narrow;
  constexpr std::size_t kVectors = 2 * width / hn::MaxLanes(d);
  const std::size_t lanes = a.lanes, a_width = a.width;
  const float *values_a = a.value, *values_b = b.value;
  for (std::size_t r = 0; r < rows; ++r, values_a += 2 * a_width, values_b += 2 * width) {
    // The products are exact: floats are promoted to doubles before they are multiplied and summed.
    hn::Vec<decltype(d)> values[kVectors];
    for (std::size_t k = 0; k < kVectors; ++k)
      values[k] =
          hn::Mul(hn::PromoteTo(d, hn::Load(narrow, values_b + k * hn::MaxLanes(d))), hn::Set(d, scale));
    // The 2 x 2 neighbouring nodes of both pieces form the outer product of their slopes.
    double* into = matrix + a.node[r] * lanes * stride + b.node[r] * width;
    for (std::size_t neighbour = 0; neighbour < 2; ++neighbour)
      for (std::size_t i = 0; i < lanes; ++i, into += stride) {
        const auto factor = hn::Set(d, static_cast<double>(values_a[neighbour * a_width + i]));
        for (std::size_t k = 0; k < kVectors; ++k) {
          double* at = into + k * hn::MaxLanes(d);
          hn::Store(hn::MulAdd(factor, values[k], hn::Load(d, at)), d, at);
        }
      }
  }
}

void add_products(const PieceRows& a, const PieceRows& b, std::size_t rows, double scale, double* matrix,
                  std::size_t stride) {
  const auto add = b.width == 1   ? add_outer<1>
                   : b.width == 2 ? add_outer<2>
                   : b.width == 4 ? add_outer<4>
                                  : add_outer<8>;
  add(a, b, rows, scale, matrix, stride);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(add_products);

// The block of products of two families' values; the columns are the first's.
struct GramBlock {
  std::size_t column, row, stride, start;
};

std::vector<GramBlock> blocks_of(const LaneRows& j) {
  std::vector<GramBlock> blocks;
  std::size_t start = 0;
  for (std::size_t f = 0; f < j.families.size(); ++f)
    for (std::size_t g = f; g < j.families.size(); ++g) {
      // The family of more lanes gives the rows, as vectors run along them.
      const auto [column, row] =
          j.families[f].lanes.size() <= j.families[g].lanes.size() ? std::pair(f, g) : std::pair(g, f);
      // The stride is odd in units of eight, so that columns do not fall on the same cache lines.
      const std::size_t stride = (j.families[row].nodes() * j.families[row].width() + 7) / 8 * 8 | 8;
      blocks.push_back({column, row, stride, start});
      start += stride * j.families[column].unknown.size();
    }
  return blocks;
}

void add_to_triangle(const LaneRows& j, const GramBlock& block, const Eigen::VectorXd& scale,
                     Eigen::MatrixXd& gram) {
  const LaneRows::Family &columns = j.families[block.column], &rows = j.families[block.row];
  const double* products = j.room.data() + block.start;
  const std::size_t lanes = rows.lanes.size(), width = rows.width();
  for (std::size_t c = 0; c < columns.unknown.size(); ++c) {
    const auto u = static_cast<Eigen::Index>(columns.unknown[c]);
    const std::size_t own_row = c / lanes * width + c % lanes;  // own row in a block of a family with itself
    for (std::size_t r = 0; r < rows.unknown.size(); ++r) {
      const auto v = static_cast<Eigen::Index>(rows.unknown[r]);
      double product = products[c * block.stride + r / lanes * width + r % lanes];
      if (block.column == block.row) {
        // Pieces added each product to one triangle or the other, so the two are summed.
        if (v < u) continue;
        product += products[r * block.stride + own_row];
      } else if (u == v) {
        product *= 2;
      }
      // Entry (u, v) of D J^T J D is scale_u scale_v times the product.
      gram(std::max(u, v), std::min(u, v)) += scale[u] * scale[v] * product;
    }
  }
}

// Returns the part of a model's family among the unknowns [first, last); without lanes where nothing lies there.
LaneRows::Family family_within(const LobeLanes& model, const LobeLanes::Family& family, std::size_t first,
                               std::size_t last) {
  LaneRows::Family kept;
  bool copies = false;
  std::size_t nodes = 0;
  for (std::size_t l = 0; l < LobeLanes::kLanes && !(family.one_table && kept.lanes.size() == 1); ++l) {
    if (family.tables[l] == LobeLanes::kNone) continue;
    const LobeLanes::NumberedTable& table = model.tables()[family.tables[l]];
    if (table.number.base < first || table.number.base >= last) continue;
    kept.lanes.push_back(l);
    copies = copies || table.number.copies > 1;
    nodes = table.layout.node_count();
  }
  if (kept.lanes.empty()) return kept;
  // Each value of the family is mapped to its unknown, relative to the first unknown of the matrix.
  for (std::size_t c = 0; c < (copies ? model.channels() : 1); ++c)
    for (std::size_t n = 0; n < nodes; ++n)
      for (const std::size_t l : kept.lanes)
        kept.unknown.push_back(
            static_cast<std::uint32_t>(model.tables()[family.tables[l]].number(n, c) - first));
  kept.copy_nodes = copies ? nodes : 0;
  kept.in_order = kept.lanes.back() + 1 == kept.lanes.size();
  return kept;
}

// Stores the slopes times the weights of both neighbours. Lanes beyond the family's are never read.
template <std::size_t width>
void set_neighbours(const float* slopes, float left, float right, float* values) {
  std::array<float, width> of_lanes;
  std::copy_n(slopes, width, of_lanes.begin());
  for (std::size_t l = 0; l < width; ++l) values[l] = left * of_lanes[l];
  for (std::size_t l = 0; l < width; ++l) values[width + l] = right * of_lanes[l];
}

}  // namespace

void LaneRows::layout(const LobeLanes& model, std::size_t first, std::size_t last, std::size_t row_count) {
  families.clear();
  pieces.clear();
  rows = row_count;
  std::vector<std::size_t> number;  // index of each of the model's families here
  for (const LobeLanes::Family& family : model.families()) {
    Family kept = family_within(model, family, first, last);
    number.push_back(kept.lanes.empty() ? LobeLanes::kNone : families.size());
    if (!kept.lanes.empty()) families.push_back(std::move(kept));
  }

  // A kept family has a piece for each slot of a line, two for a grid's rows, four for a volume's rows and layers.
  constexpr std::size_t kAligned = 2 * LobeLanes::kLanes;  // pieces of odd widths and rows too
  std::size_t start = 0;
  for (std::size_t s = 0; s < model.slots().size(); ++s) {
    const std::size_t family = number[model.slots()[s].family];
    if (family == LobeLanes::kNone) continue;
    for (const bool second_layer : {false, true})
      for (const bool second_row : {false, true}) {
        if (second_row && model.slots()[s].next_row == 0) continue;
        if (second_layer && model.slots()[s].next_layer == 0) continue;
        pieces.push_back({family, s, second_row, second_layer, start});
        start += (rows * 2 * families[family].width() + kAligned - 1) / kAligned * kAligned;
      }
  }
  node.resize(pieces.size() * rows);
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
    const std::size_t lanes = family.lanes.size(), width = family.width();

    // The piece's first node is the lookup's, moved to the second row and layer where the piece is of these.
    const Lookups::Place& place = places[slot.place * LobeLanes::kBlock];
    const std::size_t next =
        ((piece.second_row ? slot.next_row : 0) + (piece.second_layer ? slot.next_layer : 0)) /
        LobeLanes::kLanes;
    node[p * rows + r] = static_cast<std::uint32_t>(channel * family.copy_nodes + place.node + next);

    // The values are root * slope * weight. The weights along y and z are common; x has one for each neighbour.
    const float* slopes = at.factor.data() + piece.slot * LobeLanes::kBlockLanes + i * LobeLanes::kLanes;
    const float row = slot.next_row == 0 ? 1 : piece.second_row ? place.fy : 1 - place.fy;
    const float layer = slot.next_layer == 0 ? 1 : piece.second_layer ? place.fz : 1 - place.fz;
    const float part = root * row * layer;
    const float left = part * (1 - place.fx), right = part * place.fx;
    float* values = value.data() + piece.start + r * 2 * width;
    // Widths that are constants let the compiler use vectors.
    if (family.in_order && width == 4)
      set_neighbours<4>(slopes, left, right, values);
    else if (family.in_order && width == 8)
      set_neighbours<8>(slopes, left, right, values);
    else
      for (std::size_t l = 0; l < lanes; ++l) {
        values[l] = left * slopes[family.lanes[l]];
        values[width + l] = right * slopes[family.lanes[l]];
      }
  }
}

void scaled_gram(LaneRows& j, const Eigen::VectorXd& scale, Eigen::MatrixXd& gram) {
  gram.setZero(scale.size(), scale.size());

  // Every two families get room for the products of all their values.
  const std::vector<GramBlock> blocks = blocks_of(j);
  if (blocks.empty()) return;
  const GramBlock& end = blocks.back();
  j.room.resize(end.start + end.stride * j.families[end.column].unknown.size());

  // Each block sums the products of its pairs of pieces, then adds them where its unknowns stand.
  const auto rows_of = [&](std::size_t p) {
    const LaneRows::Family& family = j.families[j.pieces[p].family];
    return PieceRows{j.node.data() + p * j.rows, j.value.data() + j.pieces[p].start, family.lanes.size(),
                     family.width()};
  };
  for_each_chunk(blocks.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    const GramBlock& block = blocks[k];
    double* matrix = j.room.data() + block.start;
    std::fill_n(matrix, block.stride * j.families[block.column].unknown.size(), 0.0);
    for (std::size_t a = 0; a < j.pieces.size(); ++a)
      for (std::size_t b = 0; b < j.pieces.size(); ++b) {
        if (j.pieces[a].family != block.column || j.pieces[b].family != block.row) continue;
        if (block.column == block.row && b < a) continue;
        // A piece with itself counts half here: add_to_triangle adds each block of a family to its transpose.
        HWY_DYNAMIC_DISPATCH(add_products)
        (rows_of(a), rows_of(b), j.rows, a == b ? 0.5 : 1, matrix, block.stride);
      }
  });
  for (const GramBlock& block : blocks) add_to_triangle(j, block, scale, gram);
}

}  // namespace burnish
#endif
