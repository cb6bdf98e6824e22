// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/library/folder_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

TEST(FolderFile, HoldsTheBytesThatWereWrittenLast) {
  const TemporaryFolder folder("folder_file");
  const auto path = folder.path / "a", other = folder.path / "b";
  const std::string bytes("one\0two\n", 8);
  write_durably(path, "a longer text than what comes after it");
  write_durably(path, bytes);
  EXPECT_EQ(read(path), bytes);
  write_durably(other, "new");
  rename_durably(other, path);
  EXPECT_EQ(read(path), "new");
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST(FolderFile, IsNewForOneOfSeveralCallers) {
  const TemporaryFolder folder("folder_file_new");
  const auto path = folder.path / "claim";
  std::atomic<int> made = 0;
  std::vector<std::string> texts;
  for (int i = 0; i < 8; ++i) texts.push_back("caller " + std::to_string(i));
  std::atomic<int> maker = -1;
  {
    std::vector<std::jthread> callers;
    for (int i = 0; i < 8; ++i)
      callers.emplace_back([&, i] {
        if (!write_new_durably(path, texts[static_cast<std::size_t>(i)])) return;
        ++made;
        maker = i;
      });
  }
  ASSERT_EQ(made, 1);
  EXPECT_EQ(read(path), texts[static_cast<std::size_t>(maker)]);
}

TEST(FolderFile, SaysWhereItCannotBe) {
  const TemporaryFolder folder("folder_file_bad");
  const auto missing = folder.path / "none" / "a", file = folder.path / "file";
  EXPECT_THAT(error_of([&] { write_durably(missing, "x"); }), HasSubstr(missing.string()));
  EXPECT_THAT(error_of([&] { write_new_durably(missing, "x"); }), HasSubstr(missing.string()));
  EXPECT_THAT(error_of([&] { rename_durably(file, missing); }), HasSubstr(missing.string()));
  EXPECT_THAT(error_of([&] { GrowingFile{missing}; }), HasSubstr(missing.string()));
  make_folder(missing.parent_path() / "deeper");
  make_folder(missing.parent_path());  // is there
  EXPECT_NO_THROW(write_durably(missing, "x"));
  write_durably(file, "x");
  EXPECT_THAT(error_of([&] { make_folder(file / "below"); }), HasSubstr((file / "below").string()));
}

TEST(GrowingFile, KeepsLinesOfSeveralThreadsWhole) {
  const TemporaryFolder folder("growing_file");
  const auto path = folder.path / "journal";
  constexpr int kThreads = 4, kLines = 5;
  const auto line = [](int thread, int i) {
    return std::string(static_cast<std::size_t>(300 * (thread + 1)), static_cast<char>('a' + thread)) +
           std::to_string(i) + "\n";
  };
  GrowingFile(path).append("first\n");
  {
    GrowingFile file(path);  // goes on behind what is there
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t)
      threads.emplace_back([&, t] {
        for (int i = 0; i < kLines; ++i) file.append(line(t, i));
      });
  }
  std::vector<std::string> found, expected{"first"};
  std::istringstream text(read(path));
  for (std::string next; std::getline(text, next);) found.push_back(next);
  for (int t = 0; t < kThreads; ++t)
    for (int i = 0; i < kLines; ++i) {
      expected.push_back(line(t, i));
      expected.back().pop_back();
    }
  EXPECT_EQ(found.at(0), "first");
  EXPECT_THAT(found, testing::UnorderedElementsAreArray(expected));
}

TEST(GrowingFile, MissesAFolderThatWasRemoved) {
  const TemporaryFolder folder("growing_file_gone");
  make_folder(folder.path / "batch");
  GrowingFile file(folder.path / "batch" / "journal");
  file.append("here\n");
  std::filesystem::remove_all(folder.path / "batch");
  EXPECT_THAT(error_of([&] { file.append("gone\n"); }), HasSubstr("journal"));
}

}  // namespace
}  // namespace burnish
