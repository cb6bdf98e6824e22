// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

RglTable small_rgl(BrdfRef source) {
  RglOptions options;
  options.theta_i_count = 5;
  options.phi_i_count = 5;
  options.ndf_theta = 64;
  options.ndf_phi = 32;
  options.resolution = 12;
  return make_rgl_table(source, options);
}

/// Largest relative difference between the values of nodes whose group is theirs alone, both cosines above
/// 0.05, and what the table evaluates to there.
double worst_difference(const MeasuredNodes& nodes, BrdfRef table) {
  std::vector<int> members(nodes.group_count());
  for (const std::uint32_t group : nodes.groups) ++members[group];
  std::vector<double> f(table.channels());
  double worst = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [wi, wo] = nodes.samples.pairs[i];
    if (members[nodes.groups[i]] > 2 || std::min(wi.z, wo.z) < 0.05) continue;
    EXPECT_TRUE(table.eval(wi, wo, f));
    for (std::size_t c = 0; c < f.size(); ++c)
      worst = std::max(worst, std::abs(f[c] / nodes.samples.at(i)[c] - 1));
  }
  return worst;
}

TEST(MeasuredNodes, OfAnRglTableAreWhatItEvaluatesToThere) {
  const fixtures::Glossy source{.a = 20, .b = 20};
  const RglTable table = small_rgl(source);
  EXPECT_LT(worst_difference(measured_nodes(table), table), 2e-3);
}

TEST(MeasuredNodes, OfAnAnisotropicRglTableAreWhatItEvaluatesToThere) {
  const fixtures::Glossy source{.a = 20, .b = 5};
  const RglTable table = small_rgl(source);
  EXPECT_LT(worst_difference(measured_nodes(table), table), 2e-3);
}

TEST(MeasuredNodes, OfAnRglTableKeepNegativeValues) {
  RglData data = small_rgl(fixtures::Lambert{}).data();
  for (float& value : data.spectra.values) value = -value;
  const MeasuredNodes nodes = measured_nodes(RglTable(data));
  ASSERT_GT(nodes.size(), 0u);
  for (const double value : nodes.samples.values) EXPECT_LT(value, 0);
}

TEST(MeasuredNodes, OfAnRglTableLeaveOutWhatWasFilledInUnlessThatIsNearlyAll) {
  RglData data = small_rgl(fixtures::Lambert{}).data();
  data.valid.assign((data.theta_i.size() * 144 + 7) / 8, 0xff);
  const std::size_t all = measured_nodes(RglTable(data)).size();
  EXPECT_GT(all, 300u);
  data.valid[0] = 0x7f;  // node 0: light and half vector along the normal
  EXPECT_EQ(measured_nodes(RglTable(data)).size(), all - 1);
  data.valid.assign(data.valid.size(), 0);
  EXPECT_EQ(measured_nodes(RglTable(data)).size(), all);
}

TEST(MeasuredNodes, AHalfOfAnRglTableHasBothMirrorTwinsOrNone) {
  const MeasuredNodes nodes = measured_nodes(small_rgl(fixtures::Glossy{}));
  // twins by their directions
  std::map<std::tuple<long, long, long>, std::set<int>> halves;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [wi, wo] = nodes.samples.pairs[i];
    if (wi.z > 0.999 || angle_between(half_vector(wi, wo), {0, 0, 1}) < 1e-3 || std::abs(wo.y) < 1e-3)
      continue;
    halves[{std::lround(wi.x * 1e3), std::lround(wo.x * 1e3), std::lround(std::abs(wo.y) * 1e3)}].insert(
        nodes.half[i]);
  }
  ASSERT_GT(halves.size(), 100u);
  for (const auto& [place, seen] : halves) EXPECT_EQ(seen.size(), 1u);
  // and neither half is much the larger
  const std::size_t first = nodes_of(nodes, {NodePart::Kind::half, 0}).size();
  EXPECT_NEAR(static_cast<double>(first) / static_cast<double>(nodes.size()), 0.5, 0.05);
  EXPECT_EQ(first + nodes_without(nodes, {NodePart::Kind::half, 0}).size(), nodes.size());
}

TEST(MeasuredNodes, OfATableOfHalfAnglesAreItsValidCells) {
  HalfDiffTable table = tabulate_half_diff(fixtures::Lambert{}, 8, 6, 8, true);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < table.entry_count(); ++i) valid += !std::isnan(table.values[3 * i]);
  const MeasuredNodes nodes = measured_nodes(table);
  EXPECT_EQ(nodes.size(), valid);
  EXPECT_LT(valid, table.entry_count());
  // a full circle of eight azimuths holds each value four times: reflected, exchanged and both
  EXPECT_EQ(nodes.group_count() * 4, valid);
}

TEST(MeasuredNodes, PairsThatAreOneMeasurementAreOneGroup) {
  Samples samples{.channels = 1, .isotropic = true};
  const Vec3 a = spherical_direction(0.3, 0.2), b = spherical_direction(0.9, 1.5);
  const auto mirrored = [](Vec3 w) { return Vec3{w.x, -w.y, w.z}; };
  samples.pairs = {{a, b}, {b, a}, {mirrored(a), mirrored(b)}, {a, mirrored(b)}};
  samples.values = {1, 1, 1, 2};
  const MeasuredNodes isotropic = measured_nodes(samples);
  const std::uint32_t same = isotropic.groups[0];
  ASSERT_LT(same, 2u);
  EXPECT_EQ(isotropic.groups, (std::vector<std::uint32_t>{same, same, same, 1 - same}));
  EXPECT_EQ(isotropic.incidence, (std::vector<std::uint32_t>{0, 1, 0, 0}));
  EXPECT_NEAR(isotropic.theta_i[1], 0.9, 1e-4);
  samples.isotropic = false;
  const MeasuredNodes anisotropic = measured_nodes(samples);
  EXPECT_EQ(anisotropic.group_count(), 3u);
  EXPECT_EQ(anisotropic.groups[0], anisotropic.groups[1]);

  // in another order each pair is of the same group
  std::ranges::reverse(samples.pairs);
  std::vector<std::uint32_t> reversed = measured_nodes(samples).groups;
  std::ranges::reverse(reversed);
  EXPECT_EQ(reversed, anisotropic.groups);
}

TEST(MeasuredNodes, OfPatchesWeighWhatTheyCoverOfBothHemispheres) {
  const PatchBasis basis = klems_full_basis();
  PatchTable table{basis, basis, std::vector<float>(145 * 145, 0.5f)};
  const MeasuredNodes nodes = measured_nodes(table);
  ASSERT_EQ(nodes.size(), 145u * 145u);
  EXPECT_EQ(nodes.theta_i.size(), basis.rings.size());
  double total = 0;
  for (const double weight : nodes.weights) total += weight;
  EXPECT_NEAR(total / static_cast<double>(nodes.size()), 1, 1e-9);
  // both at the normal, both of the outermost ring
  const double ratio = basis.projected_solid_angle(0) / basis.projected_solid_angle(144);
  EXPECT_NEAR(nodes.weights.front() / nodes.weights.back(), ratio * ratio, 1e-9);
}

TEST(MeasuredNodes, AreAsManyAsAreCounted) {
  const auto expect_counted = [](const auto& source) {
    const NodeCount count = count_nodes(source);
    const MeasuredNodes nodes = measured_nodes(source);
    ASSERT_GT(nodes.size(), 0u);
    EXPECT_EQ(count.nodes, nodes.size());
    EXPECT_EQ(count.incidences, nodes.theta_i.size());
    EXPECT_EQ(nodes.weights.size(), nodes.size());
    EXPECT_EQ(nodes.groups.size(), nodes.size());
    EXPECT_EQ(nodes.half.size(), nodes.size());
    EXPECT_EQ(nodes.incidence.size(), nodes.size());
  };
  const fixtures::Glossy source{.a = 20, .b = 5};
  expect_counted(small_rgl(source));
  expect_counted(tabulate_half_diff(fixtures::Lambert{}, 6, 5, 8, true));
  const PatchBasis basis = klems_full_basis();
  expect_counted(PatchTable{basis, basis, std::vector<float>(145 * 145, 0.5f)});
  expect_counted(tabulate_tree(fixtures::Glossy{.count = 1}, 3, 0.1));
  AngleTable angles;  // on the horizon too
  angles.axes = {make_axis({0}), make_axis({0.2, 0.9, kHalfPi}), make_axis({0.1, 0.7, kHalfPi}),
                 make_axis(cell_centres(8, kTwoPi), kTwoPi)};
  expect_counted(tabulate_angles(source, angles));
  Samples samples = measure(source, {.count = 50});
  samples.pairs[3].wo.z = 0;
  samples.pairs[7].wi.z = -0.5;
  expect_counted(samples);
}

TEST(MeasuredNodes, APartKeepsWhatTheNumbersMean) {
  const MeasuredNodes nodes = measured_nodes(small_rgl(fixtures::Glossy{}));
  const MeasuredNodes part = nodes_of(nodes, parse_node_part("theta_i=2"));
  ASSERT_GT(part.size(), 50u);
  for (std::size_t i = 0; i < part.size(); ++i) {
    EXPECT_EQ(part.incidence[i], 2u);
    EXPECT_NEAR(theta_of(part.samples.pairs[i].wi), nodes.theta_i[2], 1e-4);
  }
  EXPECT_EQ(nodes_without(nodes, parse_node_part("theta_i=2")).size() + part.size(), nodes.size());
  EXPECT_THROW(nodes_of(nodes, parse_node_part("theta_i=5")), Error);
  for (const char* wrong : {"", "half", "half=2", "theta_i=", "theta_i=1x", "phi=1"})
    EXPECT_THROW(parse_node_part(wrong), Error) << wrong;
}

}  // namespace
}  // namespace burnish
