// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>
#include <burnish/io/tensor_tree_xml.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(TensorTreeXml, ReadsBracesAndWritesThemBack) {
  EXPECT_TRUE(looks_like_tensor_tree(seeds::kTensorTree));
  EXPECT_FALSE(looks_like_tensor_tree(seeds::kKlems));
  const TensorTreeFile file = parse_tensor_tree(memory_file(seeds::kTensorTree), {});
  EXPECT_EQ(file.table.rank, 3);
  EXPECT_EQ(file.table.values.size(), 8u + 3 + 8 + 3);
  EXPECT_EQ(file.findings.negative_count, 1u);
  EXPECT_EQ(file.findings.sample_count,
            8u + 1 + 8 + 1);  // the half of axis 0 that stands for nothing is not counted
  const TensorTreeFile again = parse_tensor_tree(memory_file(format_tensor_tree(file.table, "a<b&c")), {});
  EXPECT_EQ(again.table.values, file.table.values);
  EXPECT_EQ(again.table.links, file.table.links);
  EXPECT_EQ(again.findings.description, "a<b&c");
  EXPECT_THAT(again.findings.conventions.front(),
              HasSubstr("'Reflection Back', the only reflection there is"));
}

TEST(TensorTreeXml, ReadsRankFour) {
  const TensorTreeFile file = parse_tensor_tree(memory_file(seeds::kTensorTree4), {});
  EXPECT_EQ(file.table.rank, 4);
  EXPECT_EQ(parse_tensor_tree(memory_file(format_tensor_tree(file.table, "again")), {}).table.values,
            file.table.values);
}

TEST(TensorTreeXml, SaysWhatIsWrong) {
  const auto error = [](std::string_view from, std::string_view to) {
    std::string text = seeds::kTensorTree;
    text.replace(text.find(from), from.size(), to);
    return error_of([&] { parse_tensor_tree(memory_file(text), {}); });
  };
  EXPECT_THAT(error("{ 1 2", "{ 1"), HasSubstr("2^(3 k) values between braces, found 7"));
  EXPECT_THAT(error("{0} }<", "{0} <"), HasSubstr("'}' in ScatteringData"));
  EXPECT_THAT(error("{0} }<", "{0} } 1<"), HasSubstr("the end of ScatteringData"));
  EXPECT_THAT(error("{0} }<", "}<"), HasSubstr("'{' in ScatteringData"));
  EXPECT_THAT(error("2e-1", "2e99"), HasSubstr("finite numbers"));
  EXPECT_THAT(error("Shirley-Chiu", "Klems Full"), HasSubstr("LBNL/Shirley-Chiu"));
  EXPECT_THAT(error("Tree3", "Tree5"), HasSubstr("TensorTree3 or TensorTree4"));
  EXPECT_THAT(error("Reflection Front", "Absorptance Front"), HasSubstr("'Absorptance Front'"));
  EXPECT_THAT(error("{.5}", std::string(40, '{')), HasSubstr("at most 24 levels"));
}

TEST(TensorTreeXml, HoldsASourceAtRankFour) {
  const Source source = open_source(
      "openpbr:base_color=0.8/0.3/0.1,specular_roughness=0.7,specular_roughness_anisotropy=0.5", {});
  const Converted converted = convert(source, "tensortree", {.cells = 16});
  EXPECT_THAT(converted.losses, Contains(HasSubstr("luminance")));
  const Source grey = open_source("ggx:alpha_x=0.5,alpha_y=0.7,f0=0.4", {});
  EXPECT_THAT(convert(grey, "tensortree", {.cells = 8}).losses, Not(Contains(HasSubstr("luminance"))));
  const Source back = parse_source(memory_file(converted.bytes), {});
  const auto& tree = std::get<TensorTree>(back.brdf);
  EXPECT_EQ(tree.rank, 4);
  std::array<double, 3> rgb;
  for (const TreeLeaf& leaf : leaves(tree)) {
    const auto [wi, wo] = leaf_directions(tree, leaf);
    source.ref().eval(wi, wo, rgb);
    const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    EXPECT_NEAR(static_cast<double>(leaf.value), luminance, 2e-3 * luminance);
  }
  const Source again = parse_source(memory_file(convert(back, "tensortree", {}).bytes), {});
  EXPECT_EQ(std::get<TensorTree>(again.brdf).values, tree.values);
  EXPECT_EQ(std::get<TensorTree>(again.brdf).links, tree.links);
}

TEST(TensorTreeXml, ReadsAndWritesEachPartAndBand) {
  const TensorTree tree = parse_tensor_tree(memory_file(seeds::kTensorTree4), {}).table;
  for (const BsdfPart part : kBsdfParts) {
    const BsdfBlock block{part, "Solar"};
    const TensorTreeFile back = parse_tensor_tree(memory_file(format_tensor_tree(tree, "a sheet", block)),
                                                  {.part = part, .band = "solar"});
    EXPECT_EQ(back.table.values, tree.values);
    EXPECT_EQ(back.findings.block, block);
    EXPECT_EQ(back.findings.transmits(), is_transmission(part));
  }
}

// Trees of X, Y and Z that do not branch alike are one function of three channels.
TEST(TensorTreeXml, ReadsColourAsAFunctionOfThreeChannels) {
  const auto block_of = [](std::string_view band, std::string_view braces) {
    return "<WavelengthData><Wavelength>" + std::string(band) +
           "</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Transmission Front"
           "</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis><ScatteringData>" +
           std::string(braces) + "</ScatteringData></WavelengthDataBlock></WavelengthData>";
  };
  const auto text = [&](std::string_view x) {
    return "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>TensorTree3"
           "</IncidentDataStructure></DataDefinition>" +
           block_of("CIE-X", x) + block_of("Visible", "{.3}") +
           block_of("CIE-Z", "{.3 .3 .3 .3 .3 .3 .3 .3}") + "</Layer></Optical></WindowElement>";
  };
  const Source grey = parse_source(memory_file(text("{.3}")), {.band = "CIE-XYZ"});
  ASSERT_EQ(grey.ref().channels(), 3u);
  EXPECT_TRUE(grey.findings.transmits());
  std::array<double, 3> f;
  grey.ref().eval({0, 0, 1}, {0, 0, 1}, f);
  for (const double value : f) EXPECT_NEAR(value, 0.3, 1e-7);
  const Source red = parse_source(memory_file(text("{.5}")), {.band = "CIE-XYZ"});
  red.ref().eval({0, 0, 1}, {0, 0, 1}, f);
  EXPECT_GT(f[0], 0.5);
  EXPECT_LT(f[1], 0.3);
}

// Radiance's SDqueryTre and SDlookupTre, which work on the text itself.
struct Radiance {
  std::string_view text;
  std::size_t at = 0;

  void blanks() { at = text.find_first_not_of(" \t\r\n", at); }
  void skip() {
    int depth = 0;
    do {
      depth += text[at] == '{';
      depth -= text[at] == '}';
      ++at;
    } while (depth > 0);
    blanks();
  }
  /// Returns the value at coordinates in [0, 1), one for each axis.
  double look_up(std::vector<double> x) {
    blanks();
    ++at;
    blanks();
    if (text[at] == '{') {
      int child = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] *= 2;
        if (x[i] < 1) continue;
        child |= 1 << i;
        x[i] -= 1;
      }
      for (; child > 0; --child) skip();
      return look_up(x);
    }
    const std::string inner(text.substr(at, text.find('}', at) - at));
    std::istringstream numbers(inner);
    const std::vector<double> values(std::istream_iterator<double>(numbers), {});
    const auto n = static_cast<std::size_t>(
        std::lround(std::pow(static_cast<double>(values.size()), 1 / static_cast<double>(x.size()))));
    std::size_t index = 0;
    for (const double c : x) index = index * n + static_cast<std::size_t>(static_cast<double>(n) * c);
    return values[index];
  }
};

std::string_view braces_of(std::string_view text) {
  const std::size_t start = text.find("<ScatteringData>") + 16;
  return text.substr(start, text.find("</Scatt", start) - start);
}

// The axes of rank 4 are the direction that the light travels to, then the viewer's. Rows of 16 cells are .06 wide.
TEST(TensorTreeXml, WritesARankFourThatRadianceEvaluatesToItsSource) {
  const Source source = open_source("ggx:alpha_x=0.3,alpha_y=0.8,f0=0.4,kd=0.2", {});
  const std::string bytes = convert(source, "tensortree", {.cells = 16}).bytes;
  const TensorTree tree = parse_tensor_tree(memory_file(bytes), {}).table;
  Pcg32 random(1);
  double off = 0;
  constexpr int kPairs = 300;
  for (int i = 0; i < kPairs; ++i) {
    const Vec3 wi = spherical_direction(1.2 * random.uniform(), kTwoPi * random.uniform());
    const Vec3 wo = spherical_direction(1.2 * random.uniform(), kTwoPi * random.uniform());
    const DiskPoint in = shirley_chiu_square({-wi.x, -wi.y}), out = shirley_chiu_square({wo.x, wo.y});
    const double found = Radiance{braces_of(bytes)}.look_up({in.x, in.y, out.x, out.y});
    double f;
    tree.eval(wi, wo, {&f, 1});
    EXPECT_NEAR(f, found, 1e-6 * found);
    std::array<double, 3> expected;
    source.ref().eval(wi, wo, expected);
    off += std::abs(found / expected[0] - 1) / kPairs;
  }
  EXPECT_LT(off, 0.1);  // other orders or signs of the axes give .47 and more
}

TEST(TensorTreeXml, EvaluatesAFabricAsRadianceDoes) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "tensortree" / "t3.xml");
  const TensorTreeFile file = parse_tensor_tree(bytes, {});
  EXPECT_TRUE(file.table.isotropic());
  const std::string_view braces = braces_of(bytes.text());
  Pcg32 random(1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 wi = spherical_direction(kHalfPi * 0.99 * random.uniform(), kTwoPi * random.uniform());
    const Vec3 wo = spherical_direction(kHalfPi * 0.99 * random.uniform(), kTwoPi * random.uniform());
    const double turn = phi_of(wo) - std::atan2(-wi.y, -wi.x), sine = std::hypot(wo.x, wo.y);
    const DiskPoint square = shirley_chiu_square({sine * std::cos(turn), sine * std::sin(turn)});
    const double expected =
        Radiance{braces}.look_up({0.5 - 0.5 * std::hypot(wi.x, wi.y), square.x, square.y});
    double f;
    file.table.eval(wi, wo, {&f, 1});
    EXPECT_NEAR(f, expected, 1e-6 * expected);
  }
  const TensorTree again = parse_tensor_tree(memory_file(format_tensor_tree(file.table, "fabric")), {}).table;
  EXPECT_EQ(again.values, file.table.values);
}

// Radiance 6.0a gives these values, by bsdf.query of pyradiance 1.3.1. Its front, z > 0, is the file's back.
TEST(TensorTreeXml, TransmitsAsRadianceDoes) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "tensortree" / "t3.xml");
  constexpr double kAngles[][4] = {
      {10, 20, 12, 205}, {40, 100, 38, 275}, {60, 230, 22, 70}, {70, 310, 72, 125}, {31, 0, 50, 80}};
  struct Row {
    BsdfPart part;
    double values[5];
  };
  for (const Row& row :
       {Row{BsdfPart::reflection_back, {0.123396, 0.134365, 0.147259, 0.160522, 0.129896}},
        Row{BsdfPart::transmission_back, {4.523268, 0.007202, 0.004505, 0.002391, 0.008284}}}) {
    const TensorTree tree = parse_tensor_tree(bytes, {.part = row.part}).table;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto& [theta_i, phi_i, theta_o, phi_o] = kAngles[k];
      double f;
      tree.eval(spherical_direction(radians(theta_i), radians(phi_i)),
                spherical_direction(radians(theta_o), radians(phi_o)), {&f, 1});
      EXPECT_NEAR(f, row.values[k], 1e-3 * row.values[k]) << to_string(row.part) << " " << k;
    }
  }
}

}  // namespace
}  // namespace burnish
