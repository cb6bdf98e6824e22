// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <initializer_list>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/io/byte_reader.h>

namespace burnish {
namespace {

FileBytes bytes_of(std::initializer_list<int> values) {
  FileBytes file{.name = "f", .bytes = {}};
  for (const int value : values) file.bytes.push_back(static_cast<std::byte>(value));
  return file;
}

TEST(ByteReader, ReadsLittleEndianNumbersInTurn) {
  const FileBytes file = bytes_of({0x01, 0x02, 0x03, 0x04, 0xff, 0xff, 0x00, 0x00, 0x80, 0x3f});
  ByteReader reader(file);
  EXPECT_EQ(reader.number<std::uint32_t>("a"), 0x04030201u);
  EXPECT_EQ(reader.number<std::int16_t>("b"), -1);
  EXPECT_EQ(reader.number<float>("c"), 1.0f);
  EXPECT_EQ(reader.offset(), file.bytes.size());
  EXPECT_EQ(reader.remaining(), 0u);
}

TEST(ByteReader, ThrowsBeforeItPassesTheEnd) {
  const FileBytes file = bytes_of({1, 2, 3});
  ByteReader reader(file);
  EXPECT_THROW(reader.number<std::uint32_t>("a"), Error);
  EXPECT_EQ(reader.offset(), 0u) << "nothing is taken where there is too little";
  EXPECT_THROW(reader.require(~std::uint64_t{0}, "a lying size"), Error);
  EXPECT_THROW(reader.seek(4), Error);
  reader.seek(3);
  EXPECT_TRUE(reader.take(0, "nothing").empty());
  EXPECT_THROW(reader.take(1, "more"), Error);
}

}  // namespace
}  // namespace burnish
