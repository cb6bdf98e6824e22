// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/library/material_record.h>

namespace burnish {
namespace {

MaterialRecord some_record() {
  MaterialRecord record{.name = "paint", .argument = "paint.binary", .key = "k"};
  record.files = {{"models/paint.exr", "staged/1", "ab"}, {"pictures/paint.png", "staged/2", "cd"}};
  record.format = "merl";
  record.model = "p(wo) q(h) p(wi)";
  record.bytes = 2676;
  record.fetches = 2;
  double value = 1;
  for (const auto& [figure, member] : kRecordFigures) record.*member = value /= 3;
  record.warnings = {"one", "two"};
  record.seconds = 1.5;
  return record;
}

TEST(MaterialRecord, RoundTrips) {
  MaterialRecord record = some_record();
  EXPECT_EQ(parse_material_record(to_json(record)), record);
  for (const auto& [figure, member] : kRecordFigures) {
    record.*member = {};
    EXPECT_EQ(parse_material_record(to_json(record)), record) << figure;
  }
  const MaterialRecord failed{
      .name = "a", .argument = "b", .key = "", .reason = "no such file", .seconds = 2};
  EXPECT_EQ(parse_material_record(to_json(failed)), failed);
}

TEST(MaterialRecord, LeavesOutWhatIsNoNumber) {
  MaterialRecord record = some_record();
  record.psnr = std::numeric_limits<double>::infinity();
  const auto parsed = nlohmann::json::parse(to_json(record));
  EXPECT_FALSE(parsed.contains("psnr"));
  EXPECT_TRUE(parsed.contains("ssim"));
}

TEST(MaterialRecord, RefusesEveryTruncation) {
  const std::string whole = to_json(some_record());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(parse_material_record(whole.substr(0, size)), Error) << size;
  EXPECT_THROW(parse_material_record("{}"), Error);
  EXPECT_THROW(parse_material_record(R"({"name":1,"argument":"b","key":"c","seconds":1})"), Error);
}

}  // namespace
}  // namespace burnish
