// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <burnish/library/figures_table.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::ElementsAre;

// The first column of a query's rows, "NULL" where it is.
std::vector<std::string> query(const std::filesystem::path& path, const char* sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  std::vector<std::string> found;
  const auto row = [](void* into, int, char** values, char**) {
    static_cast<std::vector<std::string>*>(into)->emplace_back(values[0] ? values[0] : "NULL");
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(database, sql, row, &found, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
  return found;
}

TEST(FiguresTable, AnswersQuestions) {
  const TemporaryFolder folder("figures_table");
  const std::vector<MaterialRecord> records = {
      {.name = "gold",
       .argument = "g'old.binary",
       .key = "k",
       .files = {{"models/gold.burnish", "", ""}},
       .bytes = 2700,
       .fetches = 2,
       .psnr = 41,
       .albedo = 0.9,
       .warnings = {"one", "two"}},
      {.name = "felt",
       .argument = "felt.csv",
       .key = "k",
       .files = {{"models/felt.burnish", "", ""}},
       .bytes = 700,
       .relative = 0.25},
      {.name = "glass",
       .argument = "glass.bsdf",
       .key = "k",
       .files = {{"models/glass.burnish", "", ""}},
       .psnr = 30},
      {.name = "lost", .argument = "lost.csv", .reason = "no such file"}};
  write_figures_table(folder.path, records);
  const auto path = folder.path / kFiguresTable;
  EXPECT_THAT(query(path, "SELECT name FROM materials WHERE psnr < 40"), ElementsAre("glass"));
  EXPECT_THAT(query(path, "SELECT name FROM materials ORDER BY name"),
              ElementsAre("felt", "glass", "gold", "lost"));
  EXPECT_THAT(
      query(path, "SELECT path || bytes || fetches || warnings || file FROM materials WHERE name = 'gold'"),
      ElementsAre("g'old.binary27002one; twomodels/gold.burnish"));
  EXPECT_THAT(query(path, "SELECT reason FROM materials WHERE reason NOT NULL"), ElementsAre("no such file"));
  EXPECT_THAT(query(path, "SELECT psnr FROM materials WHERE name = 'felt'"), ElementsAre("NULL"));
  EXPECT_THAT(query(path, "PRAGMA integrity_check"), ElementsAre("ok"));

  // written again it is replaced, and nothing else is left
  write_figures_table(folder.path, std::span(records).first(1));
  EXPECT_THAT(query(path, "SELECT count(*) FROM materials"), ElementsAre("1"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path), {}), 1);
}

}  // namespace
}  // namespace burnish
