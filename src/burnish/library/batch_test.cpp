// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <gmock/gmock.h>

#include <burnish/fitting/fit_file.h>
#include <burnish/io/open_source.h>
#include <burnish/library/batch.h>
#include <burnish/library/catalogue.h>
#include <burnish/library/figures_table.h>
#include <burnish/library/journal.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

// Angles are in degrees, values in 1/sr. The table is fitted in a moment.
constexpr const char* kScattered =
    "theta_i,phi_i,theta_o,phi_o,value\n5,0,12,0,0.3\n22,0,11,60,0.2\n40,0,17,60,0.25\n50,0,50,180,0.5\n"
    "11,0,62,110,0.2\n28,0,29,175,0.6\n62,0,23,50,0.2\n";

FitOptions small_fit(bool) {
  return {.form = OneLobe{.model = "pqp", .tables = {"p=8x8", "q=9x9"}}, .samples = 500, .score = false};
}

class BatchOfMaterials : public testing::Test {
 protected:
  BatchOfMaterials() {
    write(source("felt.csv"), kScattered);
    write(source("damaged.csv"), "theta_i,phi_i,theta_o,phi_o,value\n5,0,12,0,nothing\n");
    options.folder = folder.path / "out";
    options.fit = small_fit;
    options.threads = 2;
  }
  std::string source(const std::string& name) const { return (folder.path / name).string(); }
  std::vector<LibraryEntry> entries() const {
    return named_entries({source("felt.csv"), source("damaged.csv"), source("missing.csv"),
                          "ggx:alpha_x=0.3,alpha_y=0.3", "ward:alpha_x=0.2,alpha_y=0.2"});
  }
  std::map<std::string, MaterialRecord> run() const { return run(entries()); }
  std::map<std::string, MaterialRecord> run(const std::vector<LibraryEntry>& given) const {
    Batch batch(given, options);
    std::map<std::string, MaterialRecord> records;
    while (auto record = batch.next()) EXPECT_TRUE(records.emplace(record->name, *record).second);
    return records;
  }
  std::map<std::string, std::string> models() const {
    std::map<std::string, std::string> bytes;
    for (const auto& file : std::filesystem::directory_iterator(options.folder / "models"))
      bytes[file.path().filename().string()] = read(file.path());
    return bytes;
  }
  std::size_t fits_begun() const {
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator(options.folder / "journal")) {
      const std::string text = read(file.path());
      for (std::size_t at = 0; (at = text.find(R"({"event":"began")", at)) != std::string::npos; ++at)
        ++count;
    }
    return count;
  }

  TemporaryFolder folder{"batch"};
  BatchOptions options;
};

TEST_F(BatchOfMaterials, HasTheBitsOfEachFitAlone) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const auto records = run();
  EXPECT_EQ(records.size(), 5u);
  for (const auto& [name, record] : records) {
    if (!record.fitted()) continue;
    const Source alone = open_source(record.argument, {});
    EXPECT_EQ(read(options.folder / record.files.front().path),
              format_fit(fit(alone, small_fit(true)), "a.burnish"))
        << name;
  }
  EXPECT_EQ(models().size(), 3u);
  // Models that are fitted one after the other, and in little memory, are the same.
  const auto together = models();
  options.folder = folder.path / "alone";
  options.threads = 1;
  options.memory = 1;
  run();
  EXPECT_EQ(models(), together);
}

TEST_F(BatchOfMaterials, SaysWhatIsWrongWithEachThatFails) {
  options.fit = [](bool isotropic) {
    FitOptions how = small_fit(isotropic);
    how.score = true;
    return how;
  };
  const auto records = run();
  EXPECT_THAT(records.at("damaged").reason, HasSubstr("damaged.csv: line 2"));
  EXPECT_THAT(records.at("missing").reason, HasSubstr("missing.csv"));
  EXPECT_TRUE(records.at("felt").fitted());
  EXPECT_GT(records.at("felt").bytes, 0u);
  EXPECT_THAT(records.at("felt").warnings, testing::Contains("only 7 samples"));
  EXPECT_LT(records.at("ggx_alpha_x_0.3_alpha_y_0.3").relative.value(), 0.5);
  EXPECT_GT(records.at("ggx_alpha_x_0.3_alpha_y_0.3").psnr.value(), 20);
  EXPECT_TRUE(std::filesystem::exists(options.folder / kFiguresTable));
  EXPECT_TRUE(std::filesystem::exists(options.folder / kCataloguePage));
  EXPECT_TRUE(std::filesystem::is_empty(options.folder / "staging"));
  EXPECT_TRUE(std::filesystem::is_empty(options.folder / "claims"));
}

TEST_F(BatchOfMaterials, GoesOnWithoutDoingAgainWhatIsWhole) {
  run();
  const auto before = models();
  EXPECT_EQ(fits_begun(), 4u);  // the missing file was not begun
  EXPECT_THAT(error_of([&] { run(); }), HasSubstr("to resume it"));

  options.resume = true;
  for (const auto& [name, record] : run()) EXPECT_EQ(record.earlier, name != "missing") << name;
  EXPECT_EQ(fits_begun(), 4u);

  // One model is cut in half, and one input is replaced. These two alone are fitted again.
  write(options.folder / "models/felt.burnish", before.at("felt.burnish").substr(0, 20));
  write(source("damaged.csv"), kScattered);
  const auto repaired = run();
  EXPECT_EQ(fits_begun(), 6u);
  EXPECT_TRUE(repaired.at("damaged").fitted());
  EXPECT_EQ(models().at("felt.burnish"), before.at("felt.burnish"));
  EXPECT_EQ(models().at("damaged.burnish"), before.at("felt.burnish"));

  // With other options, all are fitted again.
  options.fit = [](bool) {
    return FitOptions{.form = OneLobe{.model = "pqp", .tables = {"p=9x9"}}, .samples = 500, .score = false};
  };
  run();
  EXPECT_EQ(fits_begun(), 10u);
}

TEST_F(BatchOfMaterials, MakesTableAndPageAgainThatAreNotWhole) {
  run();
  options.resume = true;
  for (const std::filesystem::path file : {"library.sqlite", "index.html", "page/materials.js"}) {
    const std::string whole = read(options.folder / file);
    write((options.folder / file).string(), whole.substr(0, whole.size() / 2));
    run();
    EXPECT_EQ(read(options.folder / file), whole) << file;
  }
  const auto before = std::filesystem::last_write_time(options.folder / kFiguresTable);
  run();
  EXPECT_EQ(std::filesystem::last_write_time(options.folder / kFiguresTable), before);
}

// The folder looks as if a process was killed between its journal's line and the last rename.
TEST_F(BatchOfMaterials, GivesFilesTheirNamesThatAreWholeUnderOthers) {
  const auto records = run();
  const auto before = models();
  for (const RecordedFile& file : records.at("felt").files)
    std::filesystem::rename(options.folder / file.path, options.folder / file.staged);
  options.resume = true;
  EXPECT_TRUE(run().at("felt").earlier);
  EXPECT_EQ(models(), before);
}

TEST_F(BatchOfMaterials, IsSharedByThoseWhoWorkInItsFolder) {
  options.resume = true;
  options.threads = 1;
  Batch one(entries(), options), two(entries(), options);
  std::size_t earlier = 0, all = 0;
  for (Batch* batch : {&one, &two})
    while (const auto record = batch->next()) {
      ++all;
      earlier += record->earlier ? 1 : 0;
    }
  EXPECT_EQ(all, 10u);
  EXPECT_EQ(fits_begun(), 4u);
  EXPECT_EQ(earlier, 4u);  // both batches look for the missing file
}

TEST_F(BatchOfMaterials, ExportsEachUnderItsName) {
  options.exports.to = {ExportTarget::glsl};
  const auto records = run(named_entries({source("felt.csv")}));
  EXPECT_TRUE(std::filesystem::exists(options.folder / "exports/felt/felt.glsl"));
  EXPECT_THAT(read(options.folder / "exports/felt/felt.glsl"), HasSubstr("felt"));
  EXPECT_GT(records.at("felt").files.size(), 3u);
}

TEST_F(BatchOfMaterials, StopsWhereItsFolderIsGone) {
  Batch batch(entries(), options);
  std::filesystem::remove_all(options.folder);
  EXPECT_THAT(error_of([&] {
                while (batch.next()) {
                }
              }),
              HasSubstr("out/"));
}

TEST_F(BatchOfMaterials, IsRefusedWhereNothingCanBeWritten) {
  options.folder = "/proc/nowhere";
  EXPECT_THAT(error_of([&] { run(); }), HasSubstr("/proc/nowhere"));
}

TEST_F(BatchOfMaterials, CanBeLeftInTheMiddle) {
  {
    Batch batch(entries(), options);
    EXPECT_TRUE(batch.next());
    EXPECT_EQ(batch.summary().total, 5u);
  }
  options.resume = true;
  EXPECT_EQ(run().size(), 5u);
}

}  // namespace
}  // namespace burnish
