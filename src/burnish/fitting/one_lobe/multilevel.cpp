#include <algorithm>

#include <burnish/fitting/one_lobe/multilevel.h>

namespace burnish {

namespace {

int halved(int n) {
  return n > 2 ? (n + 1) / 2 : 1;
}

}  // namespace

GridTransfer::GridTransfer(const TableLayout& fine, int coarse_width, int coarse_height) {
  const auto axis = [](int fine_nodes, int nodes) {
    return Axis{fine_nodes, nodes, fine_nodes > 1 ? (nodes - 1.0) / (fine_nodes - 1.0) : 0};
  };
  x_ = axis(fine.width, coarse_width);
  y_ = axis(fine.height, coarse_height);
}

GridTransfer::Corners GridTransfer::corners(int fine_x, double fx, int fine_y, double fy) const noexcept {
  const auto place = [](const Axis& axis, double position, std::size_t node[2], double weight[2]) {
    const double at = position * axis.scale;
    const int low = std::clamp(static_cast<int>(at), 0, std::max(axis.nodes - 2, 0));
    node[0] = static_cast<std::size_t>(low);
    node[1] = static_cast<std::size_t>(std::min(low + 1, axis.nodes - 1));
    weight[1] = at - low;
    weight[0] = 1 - weight[1];
  };
  std::size_t x[2], y[2];
  double wx[2], wy[2];
  place(x_, fine_x + fx, x, wx);
  place(y_, fine_y + fy, y, wy);
  const auto width = static_cast<std::size_t>(x_.nodes);
  return {{y[0] * width + x[0], y[0] * width + x[1], y[1] * width + x[0], y[1] * width + x[1]},
          {wy[0] * wx[0], wy[0] * wx[1], wy[1] * wx[0], wy[1] * wx[1]}};
}

void GridTransfer::restrict_to(const double* fine, double* coarse, std::size_t step) const {
  std::fill_n(coarse, coarse_count() * step, 0.0);
  for (int y = 0; y < y_.fine_nodes; ++y)
    for (int x = 0; x < x_.fine_nodes; ++x, fine += step) {
      const Corners at = corners(x, 0, y, 0);
      for (int k = 0; k < 4; ++k)
        for (std::size_t c = 0; c < step; ++c) coarse[at.node[k] * step + c] += at.weight[k] * fine[c];
    }
}

void GridTransfer::add_interpolated(const double* coarse, double* fine, std::size_t step) const {
  for (int y = 0; y < y_.fine_nodes; ++y)
    for (int x = 0; x < x_.fine_nodes; ++x, fine += step) {
      const Corners at = corners(x, 0, y, 0);
      for (int k = 0; k < 4; ++k)
        for (std::size_t c = 0; c < step; ++c) fine[c] += at.weight[k] * coarse[at.node[k] * step + c];
    }
}

std::vector<GridTransfer> coarser_levels(const TableLayout& layout) {
  std::vector<GridTransfer> levels;
  for (int w = layout.width, h = layout.height; w > 1 || h > 1;) {
    w = halved(w);
    h = halved(h);
    levels.emplace_back(layout, w, h);
  }
  return levels;
}

}  // namespace burnish
