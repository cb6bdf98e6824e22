// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/library/journal.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

MaterialRecord gold() {
  return {.name = "gold",
          .argument = "gold.binary",
          .key = "k",
          .files = {{"models/gold.burnish", "staging/gold.0", "abc"}},
          .format = "MERL binary",
          .model = "p(wo) q(h) p(wi)",
          .bytes = 2700,
          .fetches = 2,
          .psnr = 41.5,
          .relative = 0.05,
          .albedo = 0.9,
          .warnings = {"only 7 samples"},
          .seconds = 1.5};
}

MaterialRecord broken() {
  return {
      .name = "broken", .argument = "b\xff.csv", .key = "k", .reason = "b.csv: offset 3: \"", .seconds = 0.1};
}

TEST(Journal, GivesBackWhatWasAppended) {
  const TemporaryFolder folder("journal");
  {
    Journal journal(folder.path, "one");
    EXPECT_TRUE(journal.empty());
    journal.append_began("gold", "k");
    journal.append(gold());
    journal.append(broken());
    journal.append_assembled("digest", {{"index.html", "1f"}});
    EXPECT_EQ(journal.record("gold", "k"), gold());
  }
  const Journal again(folder.path, "two");
  EXPECT_FALSE(again.empty());
  EXPECT_EQ(again.record("gold", "k"), gold());
  EXPECT_EQ(again.record("broken", "k")->reason, broken().reason);
  EXPECT_FALSE(again.record("gold", "another"));
  EXPECT_EQ(again.assembled("digest"), (std::vector<AssembledFile>{{"index.html", "1f"}}));
  EXPECT_FALSE(again.assembled("another"));
}

TEST(Journal, ReadsWhatOthersAppendMeanwhile) {
  const TemporaryFolder folder("journal_others");
  Journal one(folder.path, "one"), two(folder.path, "two");
  one.append(gold());
  EXPECT_FALSE(two.record("gold", "k"));
  two.refresh();
  EXPECT_TRUE(two.record("gold", "k"));
  one.append(broken());
  two.refresh();
  EXPECT_TRUE(two.record("broken", "k"));
}

TEST(Journal, PassesOverHalfALineAndTakesItOnceItIsWhole) {
  const TemporaryFolder folder("journal_half");
  Journal(folder.path, "one").append(gold());
  const std::string line = read(folder.path / "journal/one.jsonl");
  for (std::size_t cut = 0; cut < line.size(); cut += 7) {
    write(folder.path / "journal/one.jsonl", line.substr(0, cut));
    Journal journal(folder.path, "two");
    EXPECT_FALSE(journal.record("gold", "k")) << cut;
    write(folder.path / "journal/one.jsonl", line);
    journal.refresh();
    EXPECT_TRUE(journal.record("gold", "k")) << cut;
  }
}

TEST(Journal, TakesNoLineThatIsNoRecord) {
  const TemporaryFolder folder("journal_no_record");
  std::filesystem::create_directory(folder.path / "journal");
  write(folder.path / "journal/one.jsonl",
        "[]\n{}\nnull\n{\"event\":\"fitted\"}\n{\"event\":\"fitted\",\"name\":3}\n{\"event\":\"failed\","
        "\"name\":\"a\"}\n");
  const Journal journal(folder.path, "two");
  EXPECT_FALSE(journal.record("a", ""));
}

TEST(Journal, KeepsAFitWhereALaterAttemptFailed) {
  const TemporaryFolder folder("journal_later");
  Journal journal(folder.path, "one");
  journal.append(gold());
  MaterialRecord failed = broken();
  failed.name = "gold";
  journal.append(failed);
  EXPECT_TRUE(journal.record("gold", "k")->fitted());
}

TEST(Journal, SaysWhereItCannotWrite) {
  EXPECT_NE(error_of([] { Journal("/proc/nowhere", "one"); }).find("/proc/nowhere"), std::string::npos);
  const TemporaryFolder folder("journal_gone");
  Journal journal(folder.path, "one");
  journal.append(gold());
  std::filesystem::remove_all(folder.path / "journal");
  EXPECT_NE(error_of([&] { journal.append(gold()); }).find("one.jsonl"), std::string::npos);
}

}  // namespace
}  // namespace burnish
