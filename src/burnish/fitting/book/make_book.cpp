// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/book/make_book.h>
#include <burnish/fitting/book/three_channels.h>
#include <burnish/fitting/numerics/eigenvectors.h>
#include <burnish/fitting/refinement/training_set.h>
#include <burnish/math/half.h>

namespace burnish {

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t kAxes = MaterialBook::kAxes, kChannels = MaterialBook::kChannels;

// From coarse to fine: theta_h, theta_d, phi_d.
constexpr std::array<std::array<int, 3>, 8> kSides = {
    {{8, 4, 2}, {12, 5, 3}, {16, 6, 3}, {20, 7, 4}, {24, 8, 4}, {28, 8, 4}, {32, 10, 5}, {40, 12, 6}}};

// Pairs drawn of a material, and how smooth its volume is: what fills nodes that no pair touches.
constexpr std::size_t kPixels = 5000, kDirections = 6000;
constexpr double kSmooth = 1e-6;
constexpr double kRimCosine = 0.05;  // of directions nearer to the horizon, which weigh less
constexpr float kRimWeight = 0.02f;
constexpr double kMinWeight = 1e-4;  // of a node, of the mean of all
constexpr double kRoom = 1.5;        // of stored weights, beyond the library's largest
constexpr double kRidge = 1e-9;      // of the least squares of weights, of the largest diagonal element

// Half of the numbers of a material say how bright it is.
std::array<std::size_t, kAxes> components_of(std::size_t weights) {
  const std::size_t colour = weights / 4;
  return {weights - 2 * colour, colour, colour};
}

std::size_t bytes_of(std::array<int, 3> sides, std::size_t weights) {
  const auto nodes = static_cast<std::size_t>(sides[0] * sides[1] * sides[2]);
  return nodes * (weights + 2 * kAxes) + sizeof(float) * (3 * weights + kAxes);
}

/// Rounded components of one axis, and what solves for weights.
struct Basis {
  BookAxis axis;
  MatrixXd components;  // [node][component], decoded
};

MatrixXd decoded(const BookAxis& axis) {
  const auto nodes = static_cast<Eigen::Index>(axis.mean.size());
  MatrixXd components(nodes, static_cast<Eigen::Index>(axis.component_count()));
  for (Eigen::Index k = 0; k < components.cols(); ++k)
    for (Eigen::Index n = 0; n < nodes; ++n)
      components(n, k) = static_cast<double>(axis.scales[static_cast<std::size_t>(k)]) *
                         axis.components[static_cast<std::size_t>(k * nodes + n)];
  return components;
}

// [node][material], less the mean.
MatrixXd deviations(const BookAxis& axis, std::size_t u, const std::vector<BookMaterial>& materials) {
  const auto nodes = static_cast<Eigen::Index>(axis.mean.size());
  MatrixXd data(nodes, static_cast<Eigen::Index>(materials.size()));
  for (std::size_t m = 0; m < materials.size(); ++m)
    for (Eigen::Index n = 0; n < nodes; ++n)
      data(n, static_cast<Eigen::Index>(m)) =
          materials[m].logs[u * axis.mean.size() + static_cast<std::size_t>(n)] -
          static_cast<double>(axis.mean[static_cast<std::size_t>(n)]);
  return data;
}

// The first eigenvectors of data data^T, largest first, the sign of the largest entry positive: of the smaller of both
// Gram matrices.
MatrixXd principal_directions(const MatrixXd& data, Eigen::Index count) {
  const bool by_node = data.rows() <= data.cols();
  const MatrixXd gram = by_node ? MatrixXd(data * data.transpose()) : MatrixXd(data.transpose() * data);
  MatrixXd found = leading_eigenvectors(gram, count);
  if (!by_node) found = data * found;
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::Index largest = 0;
    found.col(k).cwiseAbs().maxCoeff(&largest);
    const double length = found.col(k).norm();
    found.col(k) *= (found(largest, k) < 0 ? -1 : 1) / (length > 0 ? length : 1);
  }
  return found;
}

// Weights by least squares, each node as heavy as given; [component][material].
MatrixXd weights_of(const MatrixXd& components, const VectorXd& node_weights, const MatrixXd& data) {
  const MatrixXd weighted = node_weights.asDiagonal() * components;
  MatrixXd normal = components.transpose() * weighted;
  normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff();
  return normal.ldlt().solve(weighted.transpose() * data);
}

BookAxis make_axis(std::size_t u, const std::vector<BookMaterial>& materials, const VectorXd& node_weights,
                   std::size_t count) {
  const auto nodes = static_cast<std::size_t>(node_weights.size());
  BookAxis axis;
  axis.mean.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    double sum = 0;
    for (const BookMaterial& material : materials) sum += material.logs[u * nodes + n];
    axis.mean[n] = Imath::half(static_cast<float>(sum / static_cast<double>(materials.size())));
  }

  // principal components where heavy nodes count more, rounded
  const MatrixXd data = deviations(axis, u, materials);
  const VectorXd root = node_weights.cwiseSqrt();
  const MatrixXd found = root.cwiseInverse().asDiagonal() *
                         principal_directions(root.asDiagonal() * data, static_cast<Eigen::Index>(count));
  for (Eigen::Index k = 0; k < found.cols(); ++k) {
    const double largest = std::max(found.col(k).cwiseAbs().maxCoeff(), 1e-6);
    axis.scales.push_back(static_cast<float>(largest / 127));
    for (Eigen::Index n = 0; n < found.rows(); ++n)
      axis.components.push_back(static_cast<std::int8_t>(std::lround(127 * found(n, k) / largest)));
  }

  // how the library's weights spread, and what is left
  const MatrixXd components = decoded(axis), weights = weights_of(components, node_weights, data);
  const auto number = static_cast<double>(materials.size());
  for (Eigen::Index k = 0; k < weights.rows(); ++k) {
    axis.deviations.push_back(
        static_cast<float>(std::max(std::sqrt(weights.row(k).squaredNorm() / number), 1e-6)));
    axis.steps.push_back(
        static_cast<float>(std::max(kRoom * weights.row(k).cwiseAbs().maxCoeff() / 127, 1e-6)));
  }
  const MatrixXd left = root.asDiagonal() * (data - components * weights);
  axis.residual =
      static_cast<float>(std::max(std::sqrt(left.squaredNorm() / (number * node_weights.sum())), 1e-3));
  return axis;
}

// Each node's share in what is drawn of all materials.
VectorXd node_weights(const std::vector<BookMaterial>& materials, std::size_t nodes) {
  VectorXd sum = VectorXd::Zero(static_cast<Eigen::Index>(nodes));
  for (const BookMaterial& material : materials)
    sum += Eigen::Map<const VectorXd>(material.weights.data(), sum.size());
  return sum.cwiseMax(kMinWeight * sum.mean());
}

std::array<int, 3> sides_of(const TableLayout& layout) {
  return {layout.width, layout.height, layout.depth};
}

// Each material's weights, in steps.
std::vector<MaterialBook::Material> stored(const std::array<BookAxis, kAxes>& axes,
                                           const std::vector<BookMaterial>& materials,
                                           const VectorXd& heavy) {
  std::vector<MaterialBook::Material> all;
  for (const BookMaterial& material : materials) all.push_back({.name = material.name, .weights = {}});
  for (std::size_t u = 0; u < kAxes; ++u) {
    const MatrixXd weights = weights_of(decoded(axes[u]), heavy, deviations(axes[u], u, materials));
    for (Eigen::Index m = 0; m < weights.cols(); ++m)
      for (Eigen::Index k = 0; k < weights.rows(); ++k) {
        const double in_steps =
            weights(k, m) / static_cast<double>(axes[u].steps[static_cast<std::size_t>(k)]);
        all[static_cast<std::size_t>(m)].weights.push_back(
            static_cast<std::int8_t>(std::lround(std::clamp(in_steps, -127.0, 127.0))));
      }
  }
  return all;
}

bool at_rim(const DirectionPair& pair) {
  return std::min(pair.wi.z, pair.wo.z) <= kRimCosine;
}

// Adds the squared second differences along each axis, as smoothness of the unit cube.
void add_smoothness(const TableLayout& layout, MatrixXd& normal) {
  const std::array<Eigen::Index, 3> sides = {layout.width, layout.height, layout.depth},
                                    strides = {1, layout.width, layout.width * layout.height};
  constexpr std::array kSecondDifference = {1.0, -2.0, 1.0};
  for (std::size_t axis = 0; axis < sides.size(); ++axis) {
    const double share =
        kSmooth * std::pow(static_cast<double>(sides[axis] - 1), 4) / static_cast<double>(normal.rows());
    for (Eigen::Index n = 0; n < normal.rows(); ++n) {
      if (n / strides[axis] % sides[axis] + 2 >= sides[axis]) continue;
      for (Eigen::Index a = 0; a < 3; ++a)
        for (Eigen::Index b = 0; b < 3; ++b)
          normal(n + a * strides[axis], n + b * strides[axis]) +=
              share * kSecondDifference[static_cast<std::size_t>(a)] *
              kSecondDifference[static_cast<std::size_t>(b)];
    }
  }
}

struct FittedLogs {
  MatrixXd logs;                // ln(f + floor), [node][channel]
  std::vector<double> weights;  // of the nodes
};

// By least squares of the set's logarithms, pixels together as heavy as all other pairs. Nodes that no pair is near end
// with the values that were seen.
FittedLogs fitted_logs(const TableLayout& layout, const TrainingSet& set) {
  const auto nodes = static_cast<Eigen::Index>(layout.node_count());
  MatrixXd normal = MatrixXd::Zero(nodes, nodes), right = MatrixXd::Zero(nodes, kChannels);
  std::vector<double> weights(layout.node_count());
  double pixels = 0, others = 0;
  for (std::size_t i = 0; i < set.size(); ++i)
    (i < set.picture_count ? pixels : others) += static_cast<double>(set.weights[i]);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double share = static_cast<double>(set.weights[i]) / (i < set.picture_count ? pixels : others);
    const auto corners = book_nodes(layout, set.pairs[i]);
    for (const auto& [node, weight] : corners) {
      weights[node] += share * weight;
      for (const auto& [other, other_weight] : corners)
        normal(static_cast<Eigen::Index>(node), static_cast<Eigen::Index>(other)) +=
            share * weight * other_weight;
      for (std::size_t c = 0; c < kChannels; ++c)
        right(static_cast<Eigen::Index>(node), static_cast<Eigen::Index>(c)) +=
            share * weight *
            std::log(static_cast<double>(set.values[i * kChannels + c]) + MaterialBook::kFloor);
    }
  }
  add_smoothness(layout, normal);
  normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff();

  float most = 0;
  for (std::size_t i = 0; i < set.values.size(); ++i)
    if (!at_rim(set.pairs[i / kChannels])) most = std::max(most, set.values[i]);
  return {Eigen::LLT<MatrixXd>(std::move(normal))
              .solve(right)
              .cwiseMax(std::log(MaterialBook::kFloor))
              .cwiseMin(std::log(2 * static_cast<double>(most) + MaterialBook::kFloor)),
          std::move(weights)};
}

void check_materials(const std::vector<BookMaterial>& materials, std::size_t nodes) {
  for (const BookMaterial& material : materials)
    if (material.logs.size() != kAxes * nodes || material.weights.size() != nodes)
      throw Error(fmt::format("book: expected materials at {} nodes, found {} at {}", nodes, material.name,
                              material.weights.size()));
}

}  // namespace

std::array<int, 3> book_sides(const BookOptions& options) {
  for (auto sides = kSides.rbegin(); sides != kSides.rend(); ++sides)
    if (bytes_of(*sides, options.bytes_a_material) <= options.bytes) return *sides;
  throw Error(fmt::format("book: expected at least {} shared bytes with {} bytes a material, found {}",
                          bytes_of(kSides.front(), options.bytes_a_material), options.bytes_a_material,
                          options.bytes));
}

BookMaterial book_material(const Source& source, const std::string& name, std::array<int, 3> sides,
                           std::uint64_t seed) {
  const BrdfRef ref = source.ref();
  if (!ref.isotropic() || !book_takes(ref.channels()))
    throw Error::in_file(
        source.name, "an isotropic material of one channel or three",
        fmt::format("{} one of {}", ref.isotropic() ? "an isotropic" : "an anisotropic", ref.channels()));
  const SymmetrizedBrdf reciprocal(ref);
  TrainingOptions drawn{.pictures = kPixels, .directions = kDirections};
  drawn.seed = seed;
  TrainingSet set = in_three_channels(source.samples() ? training_set_of(*source.samples(), true)
                                                       : draw_training_set(reciprocal, drawn));
  // pairs are half crowded at theta_h = 0, and shall weigh so: highlights are where materials differ
  for (std::size_t i = set.picture_count; i < set.size(); ++i)
    set.weights[i] = at_rim(set.pairs[i]) ? kRimWeight : 1;
  const TableLayout layout = book_layout(sides);
  const std::size_t nodes = layout.node_count();
  auto [logs, weights] = fitted_logs(layout, set);
  BookMaterial material{
      .name = name, .logs = std::vector<double>(kAxes * nodes), .weights = std::move(weights)};
  for (std::size_t u = 0; u < kAxes; ++u)
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t c = 0; c < kChannels; ++c)
        material.logs[u * nodes + n] +=
            kBookAxes[u][c] * logs(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(c));
  return material;
}

MaterialBook make_book(std::array<int, 3> sides, const std::vector<BookMaterial>& materials,
                       const BookOptions& options) {
  constexpr std::size_t kMinMaterials = 3;
  if (materials.size() < kMinMaterials)
    throw Error(
        fmt::format("book: expected at least {} materials, found {}", kMinMaterials, materials.size()));
  const std::size_t nodes = book_layout(sides).node_count();
  check_materials(materials, nodes);
  const VectorXd heavy = node_weights(materials, nodes);
  const auto counts = components_of(options.bytes_a_material);
  std::array<BookAxis, kAxes> axes;
  for (std::size_t u = 0; u < kAxes; ++u)
    axes[u] = make_axis(u, materials, heavy,
                        std::min({counts[u], materials.size() - 1, nodes, MaterialBook::kMaxComponents}));
  auto all = stored(axes, materials, heavy);
  return {sides, std::move(axes), std::move(all)};
}

MaterialBook with_materials(const MaterialBook& book, const std::vector<BookMaterial>& materials) {
  check_materials(materials, book.node_count());
  std::vector<MaterialBook::Material> all;
  for (const BookMaterial& material : materials)  // each by itself: the same whatever others are listed
    all.push_back(stored(book.axes(), {material}, node_weights({material}, book.node_count())).front());
  return {sides_of(book.layout()), book.axes(), std::move(all)};
}

}  // namespace burnish
