// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/io/tensor_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

const std::array<float, 6> kNumbers{1, -2, 3.5f, 0, 5, 6};
const std::array<std::uint8_t, 3> kText{'a', 'b', 'c'};

std::vector<Tensor> example() {
  return {{"text", TensorType::u8, {3}, std::as_bytes(std::span(kText))},
          {"numbers", TensorType::f32, {2, 3}, std::as_bytes(std::span(kNumbers))},
          {"scalar", TensorType::f32, {}, std::as_bytes(std::span(kNumbers).first(1))},
          {"none", TensorType::f64, {0, 7}, {}}};
}

// Offsets in the header of the parts of the first field, "text".
constexpr std::size_t kFirstField = 18, kDimensions = kFirstField + 2 + 4, kType = kDimensions + 2,
                      kOffset = kType + 1, kShape = kOffset + 8, kSecondField = kShape + 8;

template <class T>
std::string with(std::string bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
  return bytes;
}

std::string parse_error(const std::string& bytes) {
  return error_of([&] { parse_tensor_file(memory_file(bytes)); });
}

TEST(TensorFile, RoundTripsFields) {
  const auto tensors = example();
  const FileBytes file = memory_file(format_tensor_file(tensors));
  EXPECT_TRUE(looks_like_tensor_file(file.bytes));
  const auto read = parse_tensor_file(file);
  ASSERT_EQ(read.size(), tensors.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].name, tensors[i].name);
    EXPECT_EQ(read[i].type, tensors[i].type);
    EXPECT_EQ(read[i].shape, tensors[i].shape);
    EXPECT_EQ(read[i].offset % 8, 0u);
    EXPECT_TRUE(
        std::equal(read[i].data.begin(), read[i].data.end(), tensors[i].data.begin(), tensors[i].data.end()));
  }
}

TEST(TensorFile, EveryTruncatedFileThrows) {
  auto tensors = example();
  tensors.pop_back();  // the empty field needs no bytes
  const std::string bytes = format_tensor_file(tensors);
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_NE(parse_error(bytes.substr(0, n)), "") << n;
  EXPECT_EQ(parse_error(bytes), "");
}

// Mitsuba refuses a file only if both version bytes differ from its own.
TEST(TensorFile, TakesAnyMinorVersion) {
  const std::string bytes = format_tensor_file(example());
  for (const std::size_t at : {12u, 13u})
    EXPECT_EQ(parse_tensor_file(memory_file(with(bytes, at, std::uint8_t{7}))).size(), example().size());
}

TEST(TensorFile, LyingHeadersThrow) {
  const std::string bytes = format_tensor_file(example());
  ASSERT_EQ(bytes[kFirstField], 4);
  ASSERT_EQ(bytes[kType], 1);
  ASSERT_EQ(bytes[kShape], 3);
  using U8 = std::uint8_t;
  using U16 = std::uint16_t;
  using U32 = std::uint32_t;
  using U64 = std::uint64_t;
  const std::pair<std::string, std::string_view> cases[] = {
      {with(bytes, 0, U8{'T'}), "signature"},
      {with(bytes, 11, U8{'x'}), "signature"},
      {with(with(bytes, 12, U8{2}), 13, U8{1}), "version"},
      {with(bytes, 14, U32{0xffffffff}), "fields"},
      {with(bytes, 14, U32{5}), "expected"},
      {with(bytes, kFirstField, U16{0}), "empty name"},
      {with(bytes, kFirstField, U16{0xffff}), "name"},
      {with(bytes, kDimensions, U16{0xffff}), "shape"},
      {with(bytes, kType, U8{0}), "type"},
      {with(bytes, kType, U8{12}), "type"},
      {with(bytes, kOffset, U64{0}), "header"},
      {with(bytes, kOffset, U64{bytes.size()}), "within"},
      {with(bytes, kOffset, U64{bytes.size() - 2}), "within"},
      {with(bytes, kOffset, ~U64{0}), "within"},
      {with(bytes, kOffset, ~U64{0} - 2), "within"},
      {with(bytes, kShape, U64{bytes.size() + 1}), "fits"},
      {with(bytes, kShape, ~U64{0}), "fits"},
      {with(with(bytes, kSecondField + 2 + 7 + 11, U64{1} << 33), kSecondField + 2 + 7 + 19, U64{1} << 33),
       "fits"},
      {with(with(bytes, kSecondField + 2 + 7 + 11, U64{1} << 32), kSecondField + 2 + 7 + 19, U64{1} << 30),
       "fits"}};
  for (const auto& [lie, what] : cases)
    EXPECT_NE(parse_error(lie).find(what), std::string::npos) << parse_error(lie);
}

TEST(TensorFile, RepeatedNamesAndOverlappingDataThrow) {
  auto twice = example();
  twice[1].name = "text";
  EXPECT_NE(parse_error(format_tensor_file(twice)).find("two fields named text"), std::string::npos);

  const FileBytes file = memory_file(format_tensor_file(example()));
  const std::string bytes(file.text());
  const auto second = parse_tensor_file(file)[1].offset;
  EXPECT_NE(parse_error(with(bytes, kOffset, second + 4)).find("another field"), std::string::npos);
}

TEST(TensorFile, ChangingAnyHeaderByteNeverReadsOutside) {
  const std::string bytes = format_tensor_file(example());
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      const FileBytes file = memory_file(with(bytes, at, static_cast<std::uint8_t>(value)));
      try {
        for (const Tensor& tensor : parse_tensor_file(file)) {
          EXPECT_GE(tensor.data.data(), file.bytes.data());
          EXPECT_LE(tensor.data.data() + tensor.data.size(), file.bytes.data() + file.bytes.size());
        }
      } catch (const Error&) {
      }
    }
}

}  // namespace
}  // namespace burnish
