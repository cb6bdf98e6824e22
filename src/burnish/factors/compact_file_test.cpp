// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/math/random.h>
#include <burnish/testing/models.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using namespace std::string_literals;

Model read_compact(const std::string& bytes) {
  return parse_compact(memory_file(bytes));
}

// Expects that both files of a model give it back, and that each can be rewritten as the other to the byte.
void expect_twins(const Model& model) {
  const std::string compact = format_compact(model, CompactContent::model_and_notes),
                    exr = format_model(model);
  EXPECT_TRUE(looks_like_compact(memory_file(compact).bytes));
  EXPECT_TRUE(read_compact(compact) == model);
  EXPECT_TRUE(parse_model(memory_file(compact)) == model);
  EXPECT_TRUE(parse_model(memory_file(exr)) == model);
  EXPECT_TRUE(format_model(read_compact(compact)) == exr);
  EXPECT_TRUE(format_compact(parse_model(memory_file(exr)), CompactContent::model_and_notes) == compact);

  // Without its notes, all else stays.
  const Model bare = read_compact(format_compact(model));
  EXPECT_TRUE(bare.brdf == model.brdf);
  EXPECT_EQ(bare.lambda_nm, model.lambda_nm);
  EXPECT_EQ(bare.notes, "{}");
}

TEST(CompactFile, RestoresModelsToTheLastBit) {
  for (const TableFormat format :
       {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8})
    for (const std::size_t channels : {1, 3, 31}) {
      if (!holds_channels(format, channels)) continue;
      Model model{.brdf = random_model(kEverything, kEverySize, channels, format),
                  .lambda_nm = {},
                  .notes = R"({"error":0.1,"source":"random"})"};
      for (std::size_t c = 0; channels == 31 && c < channels; ++c)
        model.lambda_nm.push_back(400 + 10.1 * static_cast<double>(c));
      expect_twins(model);
    }
}

// A model of transmission that is read as a reflection would be another material.
TEST(CompactFile, KeepsThePartOfTheNotesWithoutTheOthers) {
  Model model{.brdf = smooth_model(model_case("Pqp"))};
  model.notes = R"({"band":"Visible","part":"transmission-front","source":"a.xml"})";
  const Model back = parse_compact(memory_file(format_compact(model)));
  EXPECT_EQ(back.notes, R"({"band":"Visible","part":"transmission-front"})");
  EXPECT_TRUE(back.brdf == model.brdf);
  model.notes = R"({"source":"a.xml"})";
  EXPECT_EQ(parse_compact(memory_file(format_compact(model))).notes, "{}");
}

TEST(CompactFile, RestoresEveryKindOfTableWarpAndProjection) {
  for (const ModelCase& model : kModelCases)
    for (const TableFormat format : {TableFormat::half, TableFormat::single, TableFormat::unorm8})
      expect_twins({.brdf = smooth_model(model, format)});
}

TEST(CompactFile, RestoresScalesThatNoFloatHolds) {
  const FactoredBrdf base =
      random_model("p(wo) s(0.123456789wi-1.75m+1e-7n)", {"p=4,rational:-1.3"}, 3, TableFormat::half);
  std::vector<Table> tables(base.tables().begin(), base.tables().end());
  std::vector<Lobe> lobes(base.lobes().begin(), base.lobes().end());
  lobes[0].scale = {1.0 / 3, 0, std::numeric_limits<double>::max()};
  tables[0].name = "ein Täfelchen";
  expect_twins({.brdf = FactoredBrdf(3, tables, lobes)});
}

// docs/notes/compact-file.md lists these bytes.
TEST(CompactFile, IsTheseBytes) {
  // clang-format off
  const std::string bytes =
      "\xd9\xd9\xf7\x88\x67" "burnish\x01\x03\x80"  // self-described, version 1, 3 channels, no wavelengths
      "\x82"                                           // two kinds of tables:
      "\x84\x00\x03\x01\x02"                           // a line, unorm8, 1 channel, 2 nodes;
      "\x84\x01\x02\x03\x83\x02\x02\xf9\x38\x00"       // a disk, rgb9e5, 3 channels, 2 x 2 nodes, rational:0.5
      "\x86"                                           // two tables:
      "\x61" "p\x00\x42\xff\x33"                        // p of kind 0, 2 bytes of texels;
      "\x61" "q\x01\x50"                               // q of kind 1, 16 bytes
      "\x00\x01\x02\x84\x00\x01\x02\x84\x00\x01\x02\x84\x00\x01\x02\x84"
      "\x81\x83\x81\x00\x81\x01\x81\x02"               // a product of lookups by wi, wo and h
      "\x81\x85\x83\xc4\x82\x20\x01\xc4\x82\x20\x02\xc4\x82\x20\x03"  // a lobe of scales 0.1, 0.2, 0.3,
      "\x00\x00\x00\x01"s;                            // of product 0, with tables p, p and q
  // clang-format on
  EXPECT_EQ(format_compact(seeds::small_model()), bytes);
  EXPECT_EQ(read_compact(bytes), seeds::small_model());
}

TEST(CompactFile, IsCborToAnotherReader) {
  using Json = nlohmann::json;
  const Model model{.brdf = random_model("p(wo) q(h)", {"p=4", "q=5"}, 3, TableFormat::half)};
  const std::string bytes = format_compact(model, CompactContent::model_and_notes);
  const Json json = Json::from_cbor(bytes, true, true, Json::cbor_tag_handler_t::ignore);
  EXPECT_EQ(json.at(0), "burnish");
  const Json& table = json.at(5);
  EXPECT_EQ(table.at(3), "q");
  const std::vector<std::byte> texels = pack(TableFormat::half, 3, model.brdf.tables()[1].values);
  EXPECT_EQ(table.at(5).get_binary().size(), texels.size());
  EXPECT_EQ(json.at(8), "{}");
}

TEST(CompactFile, RefusesFilesCutAnywhere) {
  const std::string bytes = seeds::compact_seed();
  EXPECT_NO_THROW(read_compact(bytes));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::string error = error_of([&] { read_compact(bytes.substr(0, n)); });
    EXPECT_THAT(error, HasSubstr("test.file: offset ")) << n;
  }
  EXPECT_THAT(error_of([&] { read_compact(bytes + '\0'); }),
              HasSubstr("expected the end of the file, found 1 more bytes"));
}

TEST(CompactFile, RefusesFlippedBitsOrGivesAModelThatRoundTrips) {
  const std::string bytes = seeds::compact_seed();
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    Model model;
    const std::string error = error_of([&] { model = read_compact(flipped); });
    if (error.empty()) {
      EXPECT_TRUE(read_compact(format_compact(model, CompactContent::model_and_notes)) == model) << bit;
    } else {
      EXPECT_THAT(error, HasSubstr("test.file: ")) << bit;
      EXPECT_THAT(error, HasSubstr("expected ")) << bit;
      EXPECT_EQ(error.find('\n'), error.npos) << bit;
      ++refused;
    }
  }
  EXPECT_GT(refused, 4 * bytes.size());
}

TEST(CompactFile, RefusesWhatContradictsItself) {
  const std::string good = format_compact(seeds::small_model());
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    const auto at = bytes.find(from);
    EXPECT_NE(at, bytes.npos);
    bytes.replace(at, from.size(), to);
    return error_of([&] { read_compact(bytes); });
  };
  const std::string line = "\x84\x00\x03\x01\x02"s;
  EXPECT_THAT(error("burnish\x01", "burnish\x02"), HasSubstr("offset 12: expected version"));
  EXPECT_THAT(error(line, "\x84\x02\x03\x01\x02"), HasSubstr("a kind of tables with 2 axes, found 1"));
  EXPECT_THAT(error(line, "\x84\x00\x02\x01\x02"s), HasSubstr("3 channels for rgb9e5, found 1"));
  EXPECT_THAT(error(line, "\x84\x00\x03\x02\x02"s), HasSubstr("1 or 3 channels, found 2"));
  EXPECT_THAT(error(line, "\x84\x00\x03\x01\x01"s), HasSubstr("nodes of an axis"));
  EXPECT_THAT(error(line, "\x84\x00\x03\x01\x19\x20\x00"s),
              HasSubstr("texels of table 'p', a string of 8192 bytes"));
  EXPECT_THAT(error("\x83\x02\x02\xf9", "\x83\x02\x00\xf9"s), HasSubstr("a spacing with a parameter"));
  EXPECT_THAT(error("\xf9\x38\x00\x86"s, "\xf9\xb8\x00\x86"s), HasSubstr("warp: expected"));
  EXPECT_THAT(error("\x42\xff\x33", "\x42\xff\x00"s), HasSubstr("table 'p': expected positive"));
  EXPECT_THAT(error("\x61q", "\x61p"), HasSubstr("distinct table names"));
  EXPECT_THAT(error("\x61q", "\x61\n"), HasSubstr("control characters"));
  EXPECT_THAT(error("\x86\x61p", "\x85\x61p"), HasSubstr("three items a table, found 5"));
  const std::string by_half = "\x81\x02\x81\x85", tables = "\x00\x00\x01"s;
  EXPECT_THAT(error(by_half, "\x81\x07\x81\x85"), HasSubstr("a projection"));
  EXPECT_THAT(error(by_half, "\x81\x81\x00\x81\x85"s), HasSubstr("projection: expected"));
  EXPECT_THAT(error(by_half, "\x80\x81\x85"), HasSubstr("the projections of a factor"));
  EXPECT_THAT(error(by_half, "\x82\x02\x02\x81\x85"), HasSubstr("a table of 2 axes, found one of 1"));
  EXPECT_THAT(error(by_half, "\x81\x02\x81\x84"), HasSubstr("a lobe of 3 factors, found 2"));
  EXPECT_THAT(error("\x03\x00"s + tables, "\x03\x01"s + tables), HasSubstr("a lobe's product"));
  EXPECT_THAT(error("\x03\x00"s + tables, "\x03\x00\x00\x00\x02"s), HasSubstr("a factor's table"));
  EXPECT_THAT(error("\xc4\x82\x20\x01", "\x20"), HasSubstr("finite scales >= 0"));
}

TEST(CompactFile, WritesNothingThatItsReaderRefuses) {
  Model model = seeds::small_model();
  model.notes = "[]";
  EXPECT_NO_THROW(format_compact(model));
  EXPECT_THROW(format_compact(model, CompactContent::model_and_notes), Error);
  model.notes = R"({"a":)" + std::string(40, '[') + std::string(40, ']') + "}";
  EXPECT_THROW(format_compact(model, CompactContent::model_and_notes), Error);

  std::vector<Table> tables(model.brdf.tables().begin(), model.brdf.tables().end());
  tables[0].name = "\xff";
  model.brdf = FactoredBrdf(3, tables, {model.brdf.lobes().begin(), model.brdf.lobes().end()});
  EXPECT_THROW(format_compact(model), Error);
  const Lobe lobe{.scale = {1, 1, 1}, .factors = {}};
  model.brdf = FactoredBrdf(3, {}, std::vector<Lobe>(kMaxCompactItems + 1, lobe));
  EXPECT_THROW(format_compact(model), Error);
}

TEST(ModelFile, IsChosenByTheEndingOfItsName) {
  const Model model = seeds::small_model();
  EXPECT_EQ(format_model_as("a/model.burnish", model), format_compact(model));
  for (const char* name : {"model.exr", "burnish", "model", ""})
    EXPECT_EQ(format_model_as(name, model), format_model(model));
}

}  // namespace
}  // namespace burnish
