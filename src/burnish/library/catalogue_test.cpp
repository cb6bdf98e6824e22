// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <burnish/image/png.h>
#include <burnish/library/catalogue.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Returns the argument of the call FUNCTION(...); in a script.
json argument_of(const std::string& script) {
  const std::size_t begin = script.find('(') + 1;
  return json::parse(script.substr(begin, script.rfind(')') - begin));
}

class Catalogue : public testing::Test {
 protected:
  MaterialRecord add(const std::string& name, const std::string& ending) {
    std::filesystem::create_directories(folder.path / "models");
    std::filesystem::create_directories(folder.path / "pictures");
    write(folder.path / ("models/" + name + ending), "bytes of " + name + "\xff\xfe\xfb");
    Image8 picture(4, 4, 4);
    std::ranges::fill(picture.pixels, static_cast<std::uint8_t>(name.back()));
    write_png(folder.path / ("pictures/" + name + ".png"), picture);
    return {.name = name,
            .argument = "<script>" + name,
            .key = "k",
            .files = {{"models/" + name + ending, "", ""}, {"pictures/" + name + ".png", "", ""}},
            .bytes = 700};
  }
  json materials() const { return argument_of(read(folder.path / "page/materials.js")); }
  json models(int part) const {
    return argument_of(read(folder.path / ("page/models-" + std::to_string(part) + ".js")));
  }

  TemporaryFolder folder{"catalogue"};
};

TEST_F(Catalogue, HoldsFiguresPicturesAndModels) {
  std::vector<MaterialRecord> records;
  for (int k = 0; k < 70; ++k) records.push_back(add("material" + std::to_string(k), ".burnish"));
  records[3].warnings = {"only 7 samples"};
  records[4].rms_log = 0.25;
  records.push_back(add("svd", ".json"));
  records.push_back({.name = "lost", .argument = "lost.csv", .reason = "no such file"});
  write_catalogue(folder.path, records, "studio/index.html");

  const json all = materials();
  EXPECT_EQ(all["studio"], "studio/index.html");
  ASSERT_EQ(all["materials"].size(), 71u);
  EXPECT_EQ(all["materials"][3]["warnings"][0], "only 7 samples");
  EXPECT_EQ(all["materials"][3]["psnr"], nullptr);
  EXPECT_EQ(all["materials"][4]["rms_log"], 0.25);
  EXPECT_TRUE(all["materials"][69]["linked"]);
  EXPECT_FALSE(all["materials"][70]["linked"]);  // the studio opens no baseline
  ASSERT_EQ(all["failed"].size(), 1u);
  EXPECT_EQ(all["failed"][0]["reason"], "no such file");

  // Picture 66, counted from 0, is the third of the second sheet.
  EXPECT_EQ(read_png(folder.path / "page/pictures-1.png").at(4 * 2, 0)[0], '6');
  // The bytes include those that base64url has other digits for. This command computes the link:
  // printf 'bytes of material0\xff\xfe\xfb' | basenc --base64url
  EXPECT_EQ(models(0)["links"][0], "Ynl0ZXMgb2YgbWF0ZXJpYWww__77");
  EXPECT_EQ(models(2)["links"].size(), 7u);
  EXPECT_EQ(models(2)["links"][6], "");
}

TEST_F(Catalogue, LoadsNothingFromElsewhereAndRunsNoTextAsCode) {
  write_catalogue(folder.path, std::vector{add("gold", ".burnish")}, "studio/index.html");
  const std::string page = read(folder.path / kCataloguePage);
  EXPECT_THAT(page, HasSubstr("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'"));
  for (const char* file : {"page/catalogue.css", "page/catalogue.js", "page/icon.svg", "page/materials.js"}) {
    EXPECT_THAT(page, HasSubstr(file));
    EXPECT_TRUE(std::filesystem::exists(folder.path / file)) << file;
  }
  const std::string script = read(folder.path / "page/catalogue.js");
  for (const char* word : {"innerHTML", "eval(", "http:", "https:", "document.write"})
    EXPECT_EQ(script.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace burnish
