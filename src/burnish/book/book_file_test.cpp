// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/model_file.h>
#include <burnish/testing/books.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(BookFile, RestoresABookToTheLastBit) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const MaterialBook book = random_book(seed);
    const std::string bytes = format_book(book);
    EXPECT_EQ(parse_book(memory_file(bytes)), book);
    EXPECT_EQ(format_book(parse_book(memory_file(bytes))), bytes);
  }
}

TEST(BookFile, IsKnownFromAModel) {
  const std::string bytes = format_book(random_book());
  EXPECT_TRUE(looks_like_book(memory_file(bytes).bytes));
  const std::string model = format_compact({.brdf = random_book().brdf(0), .lambda_nm = {}});
  EXPECT_FALSE(looks_like_book(memory_file(model).bytes));
  EXPECT_FALSE(looks_like_model(memory_file(bytes).bytes));
  EXPECT_THAT([&] { parse_book(memory_file(model)); }, ThrowsMessage<Error>(HasSubstr("offset")));
}

TEST(BookFile, EveryTruncatedFileThrows) {
  const std::string bytes = format_book(random_book());
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(parse_book(memory_file(bytes.substr(0, length))), Error) << length;
  EXPECT_THROW(parse_book(memory_file(bytes + '\0')), Error);
}

TEST(BookFile, DamagedBytesThrowOrGiveSoundMaterials) {
  const std::string bytes = format_book(random_book());
  std::array<double, 3> f{};
  std::size_t thrown = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (const char damage : {'\0', '\xff', '\x1b', '9'}) {
      std::string damaged = bytes;
      damaged[at] = damage;
      try {
        const MaterialBook book = parse_book(memory_file(damaged));
        for (std::size_t i = 0; i < book.materials().size(); ++i) {
          book.brdf(i).eval({0.6, 0, 0.8}, {0, -0.6, 0.8}, f);
          for (const double value : f) EXPECT_TRUE(std::isfinite(value) && value >= 0) << at;
        }
      } catch (const Error&) {
        ++thrown;
      }
    }
  EXPECT_GT(thrown, bytes.size() / 4);
}

}  // namespace
}  // namespace burnish
