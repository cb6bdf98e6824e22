// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/cbor.h>
#include <burnish/math/random.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using namespace std::string_literals;

std::string number_of(double value) {
  CborWriter writer;
  writer.number(value);
  return writer.written();
}

double read_number(const std::string& bytes) {
  const FileBytes file = memory_file(bytes);
  CborReader reader(file);
  const double value = reader.number("a value");
  reader.end();
  return value;
}

// [RFC8949, appendix A and 3.4.4]
TEST(Cbor, SpellsNumbersAsTheStandardDoes) {
  EXPECT_EQ(number_of(0), "\x00"s);
  EXPECT_EQ(number_of(23), "\x17");
  EXPECT_EQ(number_of(24), "\x18\x18");
  EXPECT_EQ(number_of(1000), "\x19\x03\xe8");
  EXPECT_EQ(number_of(-1), "\x20");
  EXPECT_EQ(number_of(-1000), "\x39\x03\xe7");
  EXPECT_EQ(number_of(-0.0), "\xf9\x80\x00"s);
  EXPECT_EQ(number_of(1.5), "\xf9\x3e\x00"s);
  EXPECT_EQ(number_of(100000), "\xc4\x82\x05\x01");
  EXPECT_EQ(number_of(100001), "\xfa\x47\xc3\x50\x80");
  EXPECT_EQ(number_of(0.8), "\xc4\x82\x20\x08");
  EXPECT_EQ(number_of(3.4028234663852886e+38), "\xfa\x7f\x7f\xff\xff");
  EXPECT_EQ(number_of(1.0 / 3), "\xfb\x3f\xd5\x55\x55\x55\x55\x55\x55");
  EXPECT_EQ(read_number("\x1b\x00\x00\x00\xe8\xd4\xa5\x10\x00"s), 1e12);
  EXPECT_EQ(read_number("\xc4\x82\x21\x19\x6a\xb3"), 273.15);
}

TEST(Cbor, RestoresNumbersToTheLastBit) {
  Pcg32 random(3);
  std::vector<double> values{
      0.05, -1.3,  5e-324, 1.7976931348623157e308, 65504, 65505, 65536, 0x1p-24, 0x1p-25, 1e-7,
      1e30, 4e100, 0.1f,   2147483648.0,           1e15,  -0.0,  1e-300};
  for (int i = 0; i < 2000; ++i) {
    values.push_back(std::exp(160 * (random.uniform() - 0.5)));
    values.push_back(static_cast<float>(values.back()));
    values.push_back(std::round(2000 * random.uniform() - 1000) / 100);
  }
  for (const double value : values) {
    const std::string bytes = number_of(value);
    EXPECT_LE(bytes.size(), 9u);
    EXPECT_LE(bytes.size(), static_cast<float>(value) == value ? 5u : 9u) << value;
    const double again = read_number(bytes);
    EXPECT_EQ(again, value);
    EXPECT_EQ(std::signbit(again), std::signbit(value));
  }
}

TEST(Cbor, IsReadByAnotherReader) {
  CborWriter writer;
  writer.list(5);
  writer.text("µ");
  writer.integer(-70000);
  writer.number(0.25);
  writer.number(123456.789f);
  writer.list(0);
  EXPECT_EQ(nlohmann::json::from_cbor(writer.written()),
            nlohmann::json::parse(R"(["µ",-70000,0.25,123456.7890625,[]])"));
}

TEST(Cbor, RefusesWhatIsNotExpectedAndSaysWhere) {
  const auto error = [](const std::string& bytes, const auto& read) {
    const FileBytes file = memory_file(bytes);
    CborReader reader(file);
    return error_of([&] { read(reader); });
  };
  const auto integer = [](CborReader& r) { r.integer("a count", -5, 5); };
  const auto number = [](CborReader& r) { r.number("a scale"); };
  const auto text = [](CborReader& r) { r.text("a name", 8); };
  const auto bytes = [](CborReader& r) { r.bytes("texels", 4); };
  const auto list = [](CborReader& r) { r.list("tables", 1, 9); };

  EXPECT_EQ(error("\x06", integer),
            "test.file: offset 0: expected a count, an integer from -5 to 5, found the integer 6");
  EXPECT_EQ(error("", integer),
            "test.file: offset 0: expected a count, an integer, found the end of the file");
  EXPECT_NE(error("\x25", integer), "");
  EXPECT_NE(error("\x3b\xff\xff\xff\xff\xff\xff\xff\xff", integer), "");
  EXPECT_NE(error("\xf9\x3c\x00"s, integer), "");
  EXPECT_THAT(error("\x19\x01", integer), HasSubstr("offset 1: expected 2 bytes of a count"));
  EXPECT_THAT(error("\xf9\x7c\x00"s, number), HasSubstr("a finite number, found inf"));
  EXPECT_THAT(error("\xf6", number), HasSubstr("found the simple value 22"));
  EXPECT_NE(error("\xc5\x82\x20\x08", number), "");
  EXPECT_NE(error("\xc4\x82\x19\x01\x90\x01"s, number), "");  // 1e400
  EXPECT_THAT(error("\x7f\x61\x61\xff", text), HasSubstr("definite length"));
  EXPECT_THAT(error("\x61\xff", text), HasSubstr("UTF-8"));
  EXPECT_NE(error("\x69"
                  "123456789",
                  text),
            "");
  EXPECT_NE(error("\x43"
                  "123",
                  bytes),
            "");
  EXPECT_THAT(error("\x44"
                    "123",
                    bytes),
              HasSubstr("expected 4 bytes of texels, found 3"));
  EXPECT_NE(error("\x80", list), "");
  EXPECT_THAT(error("\x85\x01", list), HasSubstr("found one of 5 items and 1 bytes"));
  EXPECT_THAT(error("\xa1\x01\x01", list), HasSubstr("found a map of 1"));
}

}  // namespace
}  // namespace burnish
