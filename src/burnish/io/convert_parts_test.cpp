// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/convert.h>
#include <burnish/io/klems.h>
#include <burnish/io/open_source.h>
#include <burnish/io/speos.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Returns four parts of a sheet, each of other values.
std::vector<Source> four_parts() {
  std::vector<PatchTable> tables;
  std::vector<PatchBlock> blocks;
  for (std::size_t k = 0; k < kBsdfParts.size(); ++k) {
    PatchTable table{.incident = klems_quarter_basis(), .outgoing = klems_quarter_basis(), .values = {}};
    table.incident.first_azimuth = kPi;
    for (std::size_t i = 0; i < 41 * 41; ++i) table.values.push_back(0.01f * static_cast<float>(i % 13 + k));
    tables.push_back(std::move(table));
  }
  for (std::size_t k = 0; k < kBsdfParts.size(); ++k)
    blocks.push_back({&tables[k], {kBsdfParts[k], "Visible"}});
  blocks.push_back({&tables[0], {BsdfPart::reflection_front, "Solar"}});
  const std::string text = format_klems(blocks, "a <sheet> & more");
  std::vector<Source> parts;
  for (const auto& [table, block] : blocks)
    parts.push_back(parse_source(memory_file(text), {.part = block.part, .band = block.band}));
  return parts;
}

Source back(const Converted& converted, const OpenOptions& options) {
  return parse_source(memory_file(converted.bytes), options);
}

TEST(ConvertParts, KlemsKeepsEveryPartAndBand) {
  const std::vector<Source> parts = four_parts();
  EXPECT_EQ(parts.front().findings.description, "a <sheet> & more");
  const Converted converted = convert_parts(parts, "klems");
  EXPECT_THAT(converted.losses, IsEmpty());
  EXPECT_FALSE(converted.resampled);
  for (const Source& part : parts) {
    const Source again =
        back(converted, {.part = part.findings.block->part, .band = part.findings.block->band});
    EXPECT_EQ(again.findings.block, part.findings.block);
    EXPECT_EQ(std::get<PatchTable>(again.brdf).values, std::get<PatchTable>(part.brdf).values);
    EXPECT_EQ(std::get<PatchTable>(again.brdf).incident, std::get<PatchTable>(part.brdf).incident);
  }
}

TEST(ConvertParts, OnePartSaysWhatItLeavesBehind) {
  const std::vector<Source> parts = four_parts();
  const Converted converted = convert(parts[2], "klems");
  EXPECT_THAT(converted.losses, Contains(HasSubstr("Reflection Front (Visible)")));
  EXPECT_EQ(back(converted, {}).findings.block->part, BsdfPart::transmission_front);
}

TEST(ConvertParts, RefusesOnePartTwice) {
  std::vector<Source> parts = four_parts();
  parts.push_back(parts.front());
  EXPECT_THAT(error_of([&] { convert_parts(parts, "klems"); }),
              HasSubstr("two of reflection-front (Visible)"));
  EXPECT_THAT(error_of([&] { convert_parts(parts, "csv"); }), HasSubstr("one part for csv, found 6"));
}

TEST(ConvertParts, TensorTreesHaveEveryPart) {
  const std::vector<Source> parts = four_parts();
  const Converted converted = convert_parts(parts, "tensortree", {.cells = 8});
  for (const Source& part : parts) {
    const Source again =
        back(converted, {.part = part.findings.block->part, .band = part.findings.block->band});
    EXPECT_EQ(again.findings.block, part.findings.block);
  }
}

TEST(ConvertParts, SpeosHasBothPartsOfTheFront) {
  std::vector<Source> parts = four_parts();
  parts.pop_back();
  const Converted converted = convert_parts(parts, "speos");
  EXPECT_THAT(converted.losses, Contains("reflection-back (Visible)"));
  EXPECT_THAT(converted.losses, Contains("transmission-back (Visible)"));
  EXPECT_THAT(converted.losses, Each(Not(HasSubstr("Transmission Front"))));
  const Source through = back(converted, {.part = BsdfPart::transmission_front});
  EXPECT_TRUE(through.findings.transmits());
}

TEST(ConvertParts, SpeosFilesComeBackToTheBit) {
  // An isotropic table of half a circle, and one of the whole.
  for (const bool folded : {true, false}) {
    AngleTable table = speos_layout(true);
    if (!folded) table.axes[3] = make_axis({0, radians(90), radians(180), radians(270)}, kTwoPi);
    table.folded = folded;
    for (std::size_t k = 0; k < entry_count(table); ++k)
      table.values.push_back(0.3f + 0.001f * static_cast<float>(k % 97));
    ASSERT_TRUE(fits_speos(table));
    const std::string text = format_speos({.reflection = &table, .transmission = &table}, "both");
    for (const BsdfPart part : {BsdfPart::reflection_front, BsdfPart::transmission_front}) {
      const SpeosFile file = parse_speos(memory_file(text), {.part = part});
      EXPECT_TRUE(file.table.isotropic());
      ASSERT_EQ(file.table.values.size(), table.values.size()) << folded;
      EXPECT_EQ(file.table.values, table.values) << folded;
    }
  }
}

TEST(ConvertParts, GlossBecomesPatchesOfItsEnergy) {
  const Source gloss = open_source("ggx:alpha_x=0.15,alpha_y=0.15", {});
  const Converted converted = convert(gloss, "klems");
  EXPECT_TRUE(converted.resampled);
  EXPECT_EQ(back(converted, {}).findings.block->part, BsdfPart::reflection_back);
}

}  // namespace
}  // namespace burnish
