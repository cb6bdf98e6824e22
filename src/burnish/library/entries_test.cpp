// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <burnish/library/entries.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(LibraryEntries, NameWhatALineNames) {
  EXPECT_THAT(
      named_entries({"a/gold paint.binary", "np:codes#alum-bronze", "nbrdf:f.csv#red_felt",
                     "surface:wall.burnish#3,4", "ggx:alpha_x=0.1,alpha_y=0.1", "../..", "b/gold paint.csv"}),
      ElementsAre(LibraryEntry{"gold_paint", "a/gold paint.binary"},
                  LibraryEntry{"alum-bronze", "np:codes#alum-bronze"},
                  LibraryEntry{"red_felt", "nbrdf:f.csv#red_felt"},
                  LibraryEntry{"3_4", "surface:wall.burnish#3,4"},
                  LibraryEntry{"ggx_alpha_x_0.1_alpha_y_0.1", "ggx:alpha_x=0.1,alpha_y=0.1"},
                  LibraryEntry{"material", "../.."}, LibraryEntry{"gold_paint-2", "b/gold paint.csv"}));
}

TEST(LibraryEntries, AreTheLinesOfAListWithoutRemarks) {
  const TemporaryFolder folder("entries");
  write(folder.path / "list", "# metals\n\n  a.binary \r\n\tggx:alpha_x=0.1\nlast.csv");
  EXPECT_THAT(library_entries(folder.path / "list"),
              ElementsAre(LibraryEntry{"a", "a.binary"}, LibraryEntry{"ggx_alpha_x_0.1", "ggx:alpha_x=0.1"},
                          LibraryEntry{"last", "last.csv"}));
}

TEST(LibraryEntries, AreTheFilesBelowAFolderByName) {
  const TemporaryFolder folder("entries_folder");
  std::filesystem::create_directories(folder.path / "b/.cache");
  for (const char* name : {"c.csv", "b/x.csv", "b/.cache/y.csv", ".hidden"})
    write(folder.path / name, "theta_i,theta_o,value\n");
  EXPECT_THAT(library_entries(folder.path),
              ElementsAre(LibraryEntry{"b_x", (folder.path / "b/x.csv").string()},
                          LibraryEntry{"c", (folder.path / "c.csv").string()}));
}

TEST(LibraryEntries, AreNotTheResultsOfThisBatchOrOfEarlierOnes) {
  const TemporaryFolder folder("entries_results");
  const std::filesystem::path meas = folder.path / "meas";
  for (const char* below : {"earlier/models", "earlier/journal", "output/models", "models"})
    std::filesystem::create_directories(meas / below);
  for (const char* name : {"c.csv", "models/d.csv", "earlier/models/c.burnish", "earlier/index.html",
                           "earlier/journal/host-1.jsonl", "output/models/c.burnish", "all.burnish"})
    write(meas / name, "theta_i,theta_o,value\n");
  const auto names = [&](const std::vector<std::filesystem::path>& others) {
    std::vector<std::string> found;
    for (const LibraryEntry& entry : library_entries(meas, others)) found.push_back(entry.name);
    return found;
  };
  EXPECT_THAT(names({meas / "output"}), ElementsAre("all", "c", "models_d"));
  EXPECT_THAT(names({meas / "all.burnish"}), ElementsAre("c", "models_d", "output_models_c"));
  EXPECT_THAT(names({folder.path / "elsewhere"}), ElementsAre("all", "c", "models_d", "output_models_c"));
  EXPECT_THAT(names({meas / "output", meas / "all.burnish"}), ElementsAre("c", "models_d"));
  for (const auto& [place, output] : {std::pair{meas, meas}, {meas / "earlier", folder.path / "elsewhere"}})
    EXPECT_THAT(error_of([&] { library_entries(place, {output}); }), HasSubstr("a folder with measurements"));
}

TEST(LibraryEntries, AreNotTheOtherFilesOfAFolder) {
  const TemporaryFolder folder("entries_others");
  write(folder.path / "a.csv", "theta_i;theta_o;value\n");
  write(folder.path / "broken.binary", "");
  write(folder.path / "README.txt", "Measured in May.\n");
  write(folder.path / "files.csv", "file,licence\na.csv,CC0\n");
  write(folder.path / "about.json", "{\"title\": \"paints\"}");
  write(folder.path / "empty.txt", "");
  write(folder.path / "photo.exr", std::string("\x76\x2f\x31\x01\0\0\0\0", 8));
  std::vector<std::string> skipped, names;
  for (const LibraryEntry& entry : library_entries(folder.path, {}, &skipped)) names.push_back(entry.name);
  EXPECT_THAT(names, ElementsAre("a", "broken"));
  EXPECT_THAT(skipped, ElementsAre(HasSubstr("README.txt"), HasSubstr("about.json"), HasSubstr("empty.txt"),
                                   HasSubstr("files.csv"), HasSubstr("photo.exr")));
  for (const char* name : {"a.csv", "broken.binary"}) std::filesystem::remove(folder.path / name);
  EXPECT_THAT(error_of([&] { library_entries(folder.path); }),
              HasSubstr("expected a folder with measurements, found 5 other files"));
}

TEST(LibraryEntries, SayWhatIsWrongWithTheirPlace) {
  const TemporaryFolder folder("entries_wrong");
  const auto said = [&](const std::string& name) {
    return error_of([&] { library_entries(folder.path / name); });
  };
  write(folder.path / "binary", std::string("abc\0def", 7));
  write(folder.path / "remarks", "# nothing\n");
  std::filesystem::create_directory(folder.path / "empty");
  EXPECT_THAT(said("binary"), HasSubstr("offset 3"));
  EXPECT_THAT(said("remarks"), HasSubstr("no argument"));
  EXPECT_THAT(said("empty"), HasSubstr("a folder with files"));
  EXPECT_THAT(said("missing"), HasSubstr("no such file"));
}

}  // namespace
}  // namespace burnish
