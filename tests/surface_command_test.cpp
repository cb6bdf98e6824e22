// SPDX-License-Identifier: Apache-2.0
// These tests run `burnish measure --surface` and `fit-surface` as users do.

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/capture/pictures/capture.h>
#include <burnish/image/png.h>
#include <burnish/surface/surface_file.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SurfaceCommand : public testing::Test {
 protected:
  void SetUp() override {
    write(
        file("scene.json"),
        R"({"version":1,"width":20,"height":20,"materials":["lambert:kd=0.6/0.3/0.1","ggx:alpha_x=0.4,alpha_y=0.4"],)"
        R"("shares":{"cells":2},"heights":{"cells":2,"amplitude":0.02},"lights":{"count":9,"angle_deg":60},)"
        R"("views":{"count":2,"angle_deg":40},"held_out":6})");
    const Outcome made = burnish("measure --surface '{0}/scene.json' -o '{0}/capture'");
    ASSERT_EQ(made.status, 0) << made.output;
    EXPECT_THAT(made.output, HasSubstr("18 pictures of 20 x 20 texels"));
  }
  fs::path file(const std::string& name) const { return folder_.path / name; }
  /// Runs burnish; {0} is the folder.
  Outcome burnish(const std::string& arguments) const {
    return run(fmt::format("'{}' {} 2>&1", BURNISH_CLI,
                           fmt::format(fmt::runtime(arguments), folder_.path.string())));
  }
  static constexpr const char* kFit =
      "fit-surface '{0}/capture' -o '{0}/wall.burnish' --lobes 2 --lobe-bytes 1K --rounds 2";

 private:
  TemporaryFolder folder_{"surface_command"};
};

TEST_F(SurfaceCommand, FitsWhatWasMeasured) {
  const Outcome fit = burnish(std::string(kFit) + " --json --compare --picture '{0}/wall.png'");
  ASSERT_EQ(fit.status, 0) << fit.output;
  const auto report = nlohmann::json::parse(fit.output);
  EXPECT_EQ(report["held_out"]["pictures"], 3);
  EXPECT_EQ(report["lights_and_views"], 15);
  EXPECT_GT(report["fitted"]["psnr"].get<double>(), 25);
  EXPECT_EQ(report["methods"].size(), 4u);
  EXPECT_EQ(parse_surface(read_file(file("wall.burnish"))).brdf.width(), 20);
  EXPECT_TRUE(fs::exists(file("wall.png")));
  EXPECT_FALSE(fs::exists(file("wall.burnish.part")));
  // One thread with few bytes at a time writes the same file again.
  const std::string bytes = read(file("wall.burnish"));
  const Outcome again = burnish(std::string(kFit) + " --compare --threads 1 --memory 20K");
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.output, HasSubstr("held out"));
  for (const char* method : {"\nlobes ", "\nggx ", "\nnearest ", "\npca "})
    EXPECT_THAT(again.output, HasSubstr(method));
  EXPECT_EQ(read(file("wall.burnish")), bytes);
}

TEST_F(SurfaceCommand, CountsOneAsOne) {
  std::string scene = read(file("scene.json"));
  scene.replace(scene.find("\"held_out\":6"), 12, "\"held_out\":18");
  write(file("scene.json"), scene);
  ASSERT_EQ(burnish("measure --surface '{0}/scene.json' -o '{0}/capture'").status, 0);
  const Outcome fit =
      burnish("fit-surface '{0}/capture' -o '{0}/w' --lobes 1 --lobe-bytes 1K --rounds 1 --normals flat");
  EXPECT_THAT(fit.output, HasSubstr("surface    1 lobe of "));
  EXPECT_THAT(fit.output, HasSubstr(" of 17 pictures\n"));
  EXPECT_THAT(fit.output, HasSubstr("\nheld out   psnr "));
  EXPECT_THAT(fit.output,
              testing::AllOf(HasSubstr("dB of 1 picture"), testing::Not(HasSubstr("1 pictures"))));
}

// The surface is black, and one of its texels is masked.
TEST_F(SurfaceCommand, SaysWhatIsExactAndWithoutData) {
  write(file("black.json"), R"({"version":1,"width":8,"height":8,"materials":["lambert:kd=0"],)"
                            R"("lights":{"count":8},"views":{"count":1},"held_out":4})");
  ASSERT_EQ(burnish("measure --surface '{0}/black.json' -o '{0}/black'").status, 0);
  CaptureForm form = parse_capture(read_file(file("black/capture.json")));
  Image8 mask(8, 8, 3);
  std::ranges::fill(mask.pixels, std::uint8_t{255});
  std::ranges::fill(mask.at(5, 2), std::uint8_t{0});
  write_png(file("black/mask.png"), mask);
  for (CapturePicture& picture : form.pictures)
    if (!picture.held_out) picture.mask = "mask.png";
  for (CapturePicture& picture : form.pictures) picture.light = {.is_direction = true, .at = {0, 0, 1}};
  write(file("black/capture.json"), format_capture(form));
  const Outcome fit =
      burnish("fit-surface '{0}/black' -o '{0}/w' --lobes 1 --lobe-bytes 1K --rounds 1 --compare");
  EXPECT_THAT(fit.output, HasSubstr("8 pictures (1 pair of light and view fitted);"));
  EXPECT_THAT(fit.output, HasSubstr("0 missing; 1 texel without data\n"));
  EXPECT_THAT(fit.output, HasSubstr("\nfitted     exact of 6 pictures\n"));
  EXPECT_THAT(fit.output, HasSubstr("\n"
                                    "lobes      exact of held-out pictures"));
}

TEST_F(SurfaceCommand, SurfacesBecomeTheirOtherFileAndTheirTexelsModels) {
  ASSERT_EQ(burnish(std::string(kFit)).status, 0);
  const Outcome exr = burnish("convert '{0}/wall.burnish' '{0}/wall.exr'");
  ASSERT_EQ(exr.status, 0) << exr.output;
  ASSERT_EQ(burnish("convert '{0}/wall.exr' '{0}/again.burnish' --json").status, 0);
  EXPECT_EQ(read(file("again.burnish")), read(file("wall.burnish")));
  EXPECT_EQ(burnish("info '{0}/wall.exr'").status, 0);
  EXPECT_THAT(burnish("convert '{0}/wall.exr' '{0}/wall.binary'").output,
              HasSubstr("surface:FILE#COLUMN,ROW"));
  // These verbs use one texel.
  for (const char* verb : {"eval 'surface:{0}/wall.exr#3,4' '{0}/directions.csv' -o '{0}/values.csv'",
                           "convert 'surface:{0}/wall.burnish#3,4' '{0}/texel.burnish'",
                           "compare '{0}/texel.burnish' 'surface:{0}/wall.exr#3,4'"}) {
    write(file("directions.csv"), "theta_i,phi_i,theta_o,phi_o\n10,0,20,180\n");
    const Outcome done = burnish(verb);
    EXPECT_EQ(done.status, 0) << verb << done.output;
  }
  EXPECT_THAT(burnish("eval '{0}/wall.exr' '{0}/directions.csv' -o '{0}/v.csv'").output,
              HasSubstr("surface:FILE#COLUMN,ROW"));
}

TEST_F(SurfaceCommand, SurfacesAreDescribedAndDrawn) {
  ASSERT_EQ(burnish(std::string(kFit) + " --widen").status, 0);
  const Outcome text = burnish("info '{0}/wall.burnish'"), json = burnish("info '{0}/wall.burnish' --json");
  ASSERT_EQ(text.status, 0) << text.output;
  EXPECT_THAT(text.output, HasSubstr("20 x 20"));
  EXPECT_THAT(text.output, HasSubstr("widened for mip levels"));
  const auto says = nlohmann::json::parse(json.output);
  EXPECT_EQ(says["format"], "surface");
  EXPECT_EQ(says["lobes"], 2);
  EXPECT_EQ(says["weights"].size(), 2u);
  EXPECT_GT(says["albedo"]["largest"].get<double>(), 0.1);
  // Two tessellations of the plane are drawn. Mip levels show in the distance.
  for (const char* vertices : {"100", "400"}) {
    const Outcome drawn =
        burnish(fmt::format("render --mesh plane --vertices {} --renderer cpu --size 24 --samples 1 "
                            "--material '{{0}}/wall.burnish' "
                            "-o '{{0}}/wall{}.png'",
                            vertices, vertices));
    EXPECT_EQ(drawn.status, 0) << drawn.output;
  }
  EXPECT_TRUE(fs::exists(file("wall100.png")));
  // A damaged surface is refused in one line.
  const std::string bytes = read(file("wall.burnish"));
  write(file("cut.burnish"), bytes.substr(0, bytes.size() / 2));
  for (const char* arguments :
       {"info '{0}/cut.burnish'", "render --mesh plane --material '{0}/cut.burnish' -o '{0}/cut.png'"}) {
    const Outcome refused = burnish(arguments);
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
    EXPECT_THAT(refused.output, HasSubstr("cut.burnish"));
  }
  EXPECT_FALSE(fs::exists(file("cut.png")));
}

TEST_F(SurfaceCommand, SaysWhatIsWrongInOneLine) {
  fs::remove(file("capture/00002.exr"));
  const Outcome left_out = burnish(kFit);
  EXPECT_EQ(left_out.status, 0);
  EXPECT_THAT(left_out.output, HasSubstr("left out   00002.exr"));
  fs::remove(file("wall.burnish"));

  write(file("capture/capture.json"), "{\"version\":1,\"width\":0}");
  for (const char* arguments : {kFit, "measure --surface '{0}/capture/capture.json' -o '{0}/other'"}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("width"));
  }
  EXPECT_FALSE(fs::exists(file("wall.burnish")));
  EXPECT_FALSE(fs::exists(file("other")));
  const Outcome other = burnish("fit-surface '{0}/scene.json' -o '{0}/w.burnish'");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.output,
              HasSubstr("scene.json: expected a folder with capture.json, a BTF of UBO2014, or a CSV"));
  EXPECT_EQ(burnish("measure -o '{0}/x.csv'").status, 2);
  EXPECT_EQ(burnish("fit-surface '{0}/capture' -o '{0}/w.burnish' --lobes 99").status, 2);
}

TEST_F(SurfaceCommand, WritesOverNothingThatItReads) {
  const auto refused = [&](int status, const std::string& arguments, const std::string& why) {
    const Outcome outcome = burnish("fit-surface '{0}/" + arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    const std::string line = outcome.output.substr(0, outcome.output.find('\n') + 1);
    EXPECT_EQ(outcome.output, status == 1 ? line : line + "Run with --help for more information.\n");
    EXPECT_THAT(line, HasSubstr(why)) << arguments;
  };
  // These outputs are refused by name, before the capture is looked for.
  for (const char* name : {"w.png", "capture/capture.json"})
    refused(2, fmt::format("none' -o '{{0}}/{}'", name),
            "--output: expected a name such as wall.burnish, found");
  for (const char* name : {"w.burnish", "capture/00001.exr"})
    refused(2, fmt::format("none' -o '{{0}}/w.burnish' --picture '{{0}}/{}'", name),
            "--picture: expected a name such as wall.png, found");
  refused(2, "none' -o '{0}/w' --picture '{0}/capture/../w'",
          "--picture: expected another file than --output");

  // These outputs are refused by their content, whatever their names.
  const std::string form = read(file("capture/capture.json")), picture = read(file("capture/00001.exr"));
  fs::create_symlink("capture/00001.exr", file("linked"));
  fs::create_hard_link(file("capture/capture.json"), file("form.png"));
  refused(1, "capture' -o '{0}/capture/00001.exr'",
          "expected an output that is not also an input, found a file of");
  refused(1, "capture' -o '{0}/linked'",
          "linked: expected an output that is not also an input, found a file of");
  refused(1, "capture' -o '{0}/w' --picture '{0}/form.png'", "form.png: expected an output that is not");
  fs::create_hard_link(file("capture/00002.exr"), file("v.part"));  // a fit that begins anew removes it
  refused(1, "capture' -o '{0}/v'", "v.part: expected an output that is not also an input, found a file of");
  EXPECT_TRUE(fs::exists(file("v.part")));
  EXPECT_EQ(read(file("capture/00001.exr")), picture);
  EXPECT_EQ(read(file("capture/capture.json")), form);
  ASSERT_EQ(burnish(kFit).status, 0);
  const std::string surface = read(file("wall.burnish"));
  refused(1, "capture' -o '{0}/wall.burnish' --book '{0}/wall.burnish'",
          "is not also an input, found the book");
  EXPECT_EQ(read(file("wall.burnish")), surface);
  EXPECT_FALSE(fs::exists(file("w")));
}

}  // namespace
}  // namespace burnish
