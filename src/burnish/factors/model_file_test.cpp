// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/model_file.h>
#include <burnish/math/random.h>
#include <burnish/testing/models.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

// The text with one part replaced by another, padded with spaces to the same length.
std::string replaced(std::string text, const std::string& from, std::string to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  EXPECT_LE(to.size(), from.size());
  to.resize(from.size(), ' ');
  return text.replace(at, from.size(), to);
}

TEST(ModelFile, RestoresModelsToTheLastBit) {
  for (const TableFormat format :
       {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8})
    for (const std::size_t channels : {1, 3, 31}) {
      if (format == TableFormat::rgb9e5 && channels != 3) continue;
      Model model{.brdf = random_model(kEverything, kEverySize, channels, format),
                  .lambda_nm = {},
                  .notes = R"({"source":"random","error":0.1})"};
      for (std::size_t c = 0; channels == 31 && c < channels; ++c)
        model.lambda_nm.push_back(400 + 10 * static_cast<double>(c));
      const std::string bytes = format_model(model);
      const FileBytes file = memory_file(bytes);
      EXPECT_TRUE(looks_like_exr(file.bytes));
      const Model again = parse_model(file);
      EXPECT_EQ(again.brdf.tables().size(), model.brdf.tables().size());
      EXPECT_TRUE(again.brdf == model.brdf);
      EXPECT_EQ(again.lambda_nm, model.lambda_nm);
      EXPECT_EQ(format_model(again), bytes);
    }
}

TEST(ModelFile, RestoresMixedFormats) {
  std::vector<Table> tables;
  Pcg32 random(5);
  for (const TableFormat format :
       {TableFormat::unorm8, TableFormat::single, TableFormat::half, TableFormat::rgb9e5}) {
    Table table{.name = std::string(to_string(format)), .layout = {.width = 9}, .channels = 3};
    for (int i = 0; i < 27; ++i) table.values.push_back(static_cast<float>(-20 * random.uniform()));
    table.format = format;
    tables.push_back(std::move(table));
  }
  const Lobe lobe{.scale = {0, 0, 0}, .factors = {{.table = 3, .projection = kProjectWi}}};
  const Model model{.brdf = from_log_tables(3, tables, {lobe})};
  EXPECT_EQ(parse_model(memory_file(format_model(model))), model);
}

TEST(ModelFile, ReadsFilesOfVersionOne) {
  const Model model{.brdf = random_model("a(h)", {}, 3, TableFormat::half),
                    .notes = R"({"room":"for the format"})"};
  std::string bytes = format_model(model);
  bytes = replaced(bytes, "\"version\":2", "\"version\":1");
  bytes = replaced(bytes, "\"format\":\"half\",", "");
  bytes = replaced(bytes, "\"notes\":" + model.notes, "\"notes\":{},\"format\":\"half\"");
  EXPECT_EQ(parse_model(memory_file(bytes)).brdf, model.brdf);
}

TEST(ModelFile, RefusesFormatsThatTheValuesContradict) {
  const auto with_format = [](TableFormat truth, const std::string& stated) {
    const std::string bytes = format_model({.brdf = random_model("pqp", {}, 3, truth)});
    return memory_file(replaced(bytes, "\"" + std::string(to_string(truth)) + "\"", "\"" + stated + "\""));
  };
  EXPECT_NO_THROW(parse_model(with_format(TableFormat::rgb9e5, "half")));  // true, if not all of the truth
  EXPECT_NO_THROW(parse_model(with_format(TableFormat::unorm8, "float")));
  EXPECT_THROW(parse_model(with_format(TableFormat::single, "half")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::unorm8, "half")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::unorm8, "rgb9e5")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::rgb9e5, "unorm8")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::rgb9e5, "byte")), Error);
}

TEST(ModelFile, RefusesDamagedFiles) {
  const std::string bytes =
      format_model({.brdf = random_model("pqp", {"p=8", "q=8x8"}, 3, TableFormat::half)});
  const auto parse = [](const std::string& text) { return parse_model(memory_file(text)); };
  for (std::size_t n = 1; n < bytes.size(); n += n < 64 ? 1 : 61)
    EXPECT_THROW(parse(bytes.substr(0, n)), Error) << n;
  EXPECT_THROW(parse(replaced(bytes, "\"version\":2", "\"version\":7")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"channels\":3", "\"channels\":9")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"width\":8", "\"width\":9")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"shape\":\"disk\"", "\"shape\":\"disc\"")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"projection\":\"wo\"", "\"projection\":\"ww\"")), Error);
}

}  // namespace
}  // namespace burnish
