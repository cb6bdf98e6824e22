// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <burnish/file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::size_t entries_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(File, ReadsBackWhatWasWrittenAndLeavesNothingElse) {
  const TemporaryFolder folder("file");
  const std::string bytes("\0\xff\n text", 8);
  for (int time = 0; time < 2; ++time) {  // the second replaces the first
    write_then_rename(folder.path / "a", bytes);
    const FileBytes file = read_file(folder.path / "a");
    EXPECT_EQ(file.text(), bytes);
    EXPECT_EQ(file.name, (folder.path / "a").string());
    EXPECT_EQ(entries_in(folder.path), 1u);
  }
}

TEST(File, ReadsUpToTheLimit) {
  const TemporaryFolder folder("file");
  write(folder.path / "a", "12345");
  EXPECT_EQ(read_file(folder.path / "a", 5).bytes.size(), 5u);
  EXPECT_THAT(error_of([&] { read_file(folder.path / "a", 4); }), HasSubstr("at most 4 bytes"));
}

TEST(File, RefusesToReadWhatIsMissingEmptyOrNoFile) {
  const TemporaryFolder folder("file");
  write(folder.path / "empty", "");
  EXPECT_THAT(error_of([&] { read_file(folder.path / "none"); }), HasSubstr("no such file"));
  EXPECT_THAT(error_of([&] { read_file(folder.path / "empty"); }), HasSubstr("an empty file"));
  EXPECT_THAT(error_of([&] { read_file(folder.path); }), HasSubstr("a regular file"));
}

TEST(File, WritesToWhatALinkNames) {
  const TemporaryFolder folder("file");
  write(folder.path / "target", "old");
  fs::create_symlink("target", folder.path / "link");
  write_then_rename(folder.path / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path / "link"));
  EXPECT_EQ(read(folder.path / "target"), "new");
}

TEST(File, RefusesToWriteOverAFolderOrIntoNone) {
  const TemporaryFolder folder("file");
  EXPECT_THAT(error_of([&] { write_then_rename(folder.path, "x"); }),
              HasSubstr("something else than a file"));
  EXPECT_THAT(error_of([&] { write_then_rename(folder.path / "none/a", "x"); }),
              HasSubstr("expected a path in a folder that is there, found no folder"));
  EXPECT_EQ(entries_in(folder.path), 0u);
}

TEST(File, TellsBeforeItWritesWhetherItCan) {
  const TemporaryFolder folder("file");
  write(folder.path / "a", "old");
  for (const char* refused : {"", "none/b", "a/b"}) {
    const fs::path path = folder.path / refused;
    const std::string said = error_of([&] { check_writable(path); });
    EXPECT_THAT(said, HasSubstr(path.string())) << refused;
    EXPECT_EQ(error_of([&] { write_then_rename(path, "x"); }), said) << refused;
  }
  EXPECT_NO_THROW(check_writable(folder.path / "a"));
  EXPECT_NO_THROW(check_writable(folder.path / "b"));
  EXPECT_EQ(read(folder.path / "a"), "old");
  EXPECT_EQ(entries_in(folder.path), 1u);
}

// The device stands for a full disk, under the temporary name.
TEST(File, SaysWhyItCouldNotWrite) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const TemporaryFolder folder("file");
  write(folder.path / "a", "old");
  for (const std::size_t size : {std::size_t{1}, std::size_t{1} << 20}) {  // when it is closed, and before
    fs::create_symlink("/dev/full", folder.path / fmt::format("a.{}.partial", ::getpid()));
    EXPECT_EQ(error_of([&] { write_then_rename(folder.path / "a", std::string(size, 'x')); }),
              fmt::format("{}: expected a writable path, found a write error: No space left on device",
                          (folder.path / "a").string()));
    EXPECT_EQ(read(folder.path / "a"), "old");
    EXPECT_EQ(entries_in(folder.path), 1u);
  }
}

}  // namespace
}  // namespace burnish
