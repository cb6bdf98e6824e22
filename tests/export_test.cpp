// SPDX-License-Identifier: Apache-2.0
// These tests open the files of `burnish export` in other programs.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/factors/model_file.h>
#include <burnish/image/png.h>
#include <burnish/io/rgl.h>
#include <burnish/render/light/image_based_light.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Export : public testing::Test {
 protected:
  void SetUp() override {
    write(folder_ / "two lobes.exr", format_model({smooth_model(model_case("Pqpr")), {}, "{}"}));
  }

  // Runs the exported page with `script`. Returns the page's data-result, after the "errors" of the console.
  std::string run_page(const std::string& script, int window) const {
    std::string page = read(folder_ / "out/two_lobes.html");
    page.insert(page.find("<script>"),
                "<script>let errors = 0; console.error = () => ++errors;"
                "addEventListener('error', () => ++errors);</script>");
    page.insert(page.find("</html>"), "<script>" + script + "</script>");
    write(folder_ / "page.html", page);
    const int code =
        run(fmt::format("timeout 300 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
                        "--enable-unsafe-swiftshader --window-size={1},{1} --user-data-dir={0}/profile "
                        "--virtual-time-budget=5000 --dump-dom file://{0}/page.html > {0}/dom 2> {0}/said",
                        folder_.string(), window))
            .status;
    EXPECT_EQ(code, 0) << read(folder_ / "said");
    const std::string dom = read(folder_ / "dom"), mark = "data-result=\"";
    const auto at = dom.find(mark);
    return at == dom.npos ? ""
                          : dom.substr(at + mark.size(), dom.find('"', at + mark.size()) - at - mark.size());
  }

  int exports(const std::string& arguments) const {
    return run(fmt::format("{} export '{}/two lobes.exr' -o {}/out {} > {}/said 2>&1", BURNISH_CLI,
                           folder_.string(), folder_.string(), arguments, folder_.string()))
        .status;
  }

  TemporaryFolder scratch_{"export"};
  const fs::path folder_ = scratch_.path;
};

TEST_F(Export, WritesEveryLanguageWithItsTexturesAndAManifest) {
  ASSERT_EQ(exports("--to glsl --to glsl_es --to hlsl --to msl --to wgsl --to cpp --to html"), 0)
      << read(folder_ / "said");
  const std::string manifest = read(folder_ / "out/two_lobes.json");
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    ++files;
    EXPECT_GT(fs::file_size(entry), 0u);
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.ends_with(".json") || manifest.find('"' + name + '"') != std::string::npos) << name;
  }
  EXPECT_EQ(files, 6u + 1 + 1 + 1);  // languages, texture, page, manifest
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("two_lobes.glsl: hardware filter, 4 fetches"));
}

TEST_F(Export, MultipliesInHalfPrecisionWhereAsked) {
  ASSERT_EQ(exports("--to glsl_es --to wgsl --to cpp --half"), 0) << read(folder_ / "said");
  EXPECT_THAT(read(folder_ / "said"),
              HasSubstr("two_lobes.es.glsl: hardware filter, half products, 4 fetches"));
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("two_lobes.h: exact filter, 8 fetches"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.es.glsl"), HasSubstr("mediump vec3"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.wgsl"), HasSubstr("enable f16;"));
  EXPECT_EQ(exports("--to glsl --half --exact"), 2);
  EXPECT_EQ(exports("--to cpp --half"), 2);
  EXPECT_EQ(exports("--to cpp --area"), 2);
}

TEST_F(Export, WritesFunctionsThatDrawDirections) {
  ASSERT_EQ(exports("--to glsl,wgsl,cpp --sample"), 0) << read(folder_ / "said");
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("two_lobes.sample.glsl: a draw, 24 fetches of 1 texture"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.sample.wgsl"),
              HasSubstr("fn burnish_two_lobes_sample(wo: vec3f, u: vec2f)"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.sample.h"),
              HasSubstr("unsigned short burnish_two_lobes_sample_cells[]"));
  EXPECT_TRUE(fs::exists(folder_ / "out/two_lobes.sample.ktx2"));
  EXPECT_EQ(exports("--to exr,ktx2 --sample"), 2);
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("found exr, ktx2"));
  EXPECT_EQ(exports("--to glsl_es,png --binding 1"), 2);
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("found glsl_es, png"));
}

TEST_F(Export, NumbersTexturesAsItIsTold) {
  ASSERT_EQ(exports("--to glsl,hlsl,slang,wgsl,dds --binding 4 --set 2 --space 3"), 0)
      << read(folder_ / "said");
  EXPECT_THAT(read(folder_ / "out/two_lobes.glsl"),
              HasSubstr("layout(set = 2, binding = 4) uniform sampler2D"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.hlsl"), HasSubstr("register(t4, space3)"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.slang"), HasSubstr("[[vk::binding(4, 2)]]"));
  EXPECT_THAT(read(folder_ / "out/two_lobes.wgsl"), HasSubstr("@group(2) @binding(4)"));
  EXPECT_TRUE(read(folder_ / "out/two_lobes.tables.dds").starts_with("DDS "));
  ASSERT_EQ(exports("--to wgsl --half --appended"), 0);
  EXPECT_THAT(read(folder_ / "out/two_lobes.wgsl"), Not(HasSubstr("enable f16")));
  EXPECT_EQ(exports("--to glsl_es --set 1"), 2);
  EXPECT_EQ(exports("--to glsl --space 1"), 2);
  EXPECT_EQ(exports("--to glsl --binding -1"), 2);
  EXPECT_EQ(exports("--to glsl --set 1 --environment sun"), 2);
}

TEST_F(Export, RefusesWhatIsNoModelAndNoTargetAndLeavesNothing) {
  EXPECT_EQ(exports("--to jpeg"), 2);
  EXPECT_EQ(exports("--to usda --cells 20"), 2);
  EXPECT_EQ(exports("--to glsl --name a__b"), 1);
  write(folder_ / "two lobes.exr", "v/1\x01 no model");
  EXPECT_EQ(exports("--to glsl"), 1);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Export, WritesTexturesAsImagesAndOtherFormatsOfTheMaterial) {
  ASSERT_EQ(exports("--to exr --to png --to three --to babylon --to materialx --to rgl"), 0)
      << read(folder_ / "said");
  const fs::path out = folder_ / "out";
  EXPECT_EQ(read_png(out / "two_lobes_0.png").width, 32);
  EXPECT_TRUE(read(out / "two_lobes_2.exr").starts_with("v/1\x01"));
  EXPECT_THAT(read(out / "two_lobes.babylon.js"), HasSubstr("export function createMaterial(BABYLON, scene"));
  EXPECT_TRUE(read(out / "two_lobes.tables.exr").starts_with("v/1\x01"));
  EXPECT_THAT(read(out / "two_lobes.three.js"), HasSubstr("export function createMaterial(THREE)"));
  const RglTable table = parse_rgl(read_file(out / "two_lobes.bsdf"), {}).table;
  const FactoredBrdf brdf = smooth_model(model_case("Pqpr"));
  for (int row = 4; row < 28; row += 4) {  // nodes hold the model's values
    const auto [wi, wo] = table.node_directions(0, 5, row, 16);
    double f[3], expected[3];
    if (wo.z < 0.1) continue;
    table.eval(wi, wo, f);
    brdf.eval(wi, wo, expected);
    EXPECT_NEAR(f[1], expected[1], 1e-3 * expected[1]);
  }
}

TEST_F(Export, WritesTheSpecularFamilyInEveryLanguage) {
  const auto exports_model = [&](const std::string& arguments) {
    return run(fmt::format("{} export {} -o {}/out > {}/said 2>&1", BURNISH_CLI, arguments, folder_.string(),
                           folder_.string()))
        .status;
  };
  ASSERT_EQ(
      exports_model("blinn_phong:exponent=60 --to glsl --to glsl_es --to hlsl --to msl --to wgsl --to cpp "
                    "--to html --power w8"),
      0)
      << read(folder_ / "said");
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("blinn_phong.wgsl: w8, 0 fetches, 22 operations"));
  EXPECT_THAT(read(folder_ / "out/blinn_phong.json"), HasSubstr("\"bound\": 0.0161"));
  EXPECT_THAT(read(folder_ / "out/blinn_phong.html"), HasSubstr("burnish_blinn_phong_power_w8"));
  ASSERT_EQ(exports_model("phong:exponent=20 --to hlsl --name shine"), 0) << read(folder_ / "said");
  EXPECT_THAT(read(folder_ / "said"), HasSubstr("shine.hlsl: cubic2"));
  EXPECT_EQ(exports_model("ggx --to glsl"), 1);
  EXPECT_EQ(exports_model("phong --to ktx2"), 1);
  EXPECT_EQ(exports_model("phong --to glsl --half"), 2);
  EXPECT_EQ(exports_model("phong --to glsl --power w9"), 2);
  EXPECT_EQ(exports("--to glsl --power w8"), 2);
}

TEST_F(Export, WritesOpenPbrAsParameters) {
  const std::string files = " --to materialx --to usda --to gltf -o " + (folder_ / "out").string() + " 2>&1";
  const Outcome done = run(fmt::format("{} export openpbr:coat_weight=1{}", BURNISH_CLI, files));
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_TRUE(read(folder_ / "out/openpbr.glb").starts_with("glTF"));
  EXPECT_THAT(read(folder_ / "out/openpbr.usda"), HasSubstr("inputs:coat_weight = 1\n"));
  EXPECT_EQ(run(fmt::format("{} export openpbr:coat_weight=2{}", BURNISH_CLI, files)).status, 1);
  EXPECT_EQ(run(fmt::format("{} export openpbr --to ktx2 -o {}", BURNISH_CLI, folder_.string())).status, 1);
  EXPECT_EQ(run(fmt::format("{} export openpbr --power w8{}", BURNISH_CLI, files)).status, 2);
}

TEST_F(Export, ThePageLoadsNothing) {
  ASSERT_EQ(exports("--to html"), 0);
  const std::string page = read(folder_ / "out/two_lobes.html");
  for (const char* loads : {"http", "src=", "url(", "import ", "fetch(", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(loads)));
}

TEST_F(Export, ThePageShowsTheMaterialUnderALightThatIsDragged) {
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool("chromium")) GTEST_SKIP() << "no chromium";
  ASSERT_EQ(exports("--to html"), 0);
  EXPECT_EQ(run_page(R"(
const shot = () => canvas.toDataURL(), move = (buttons, x, y) => {
  canvas.dispatchEvent(new PointerEvent("pointermove", {buttons, clientX: x, clientY: y, bubbles: true}));
  return shot();
};
const start = shot(), hovered = move(0, 60, 300), dragged = move(1, 60, 300), back = move(1, 300, 60);
const show = (shape) => {
  find("select").value = shape;
  find("select").dispatchEvent(new Event("input"));
  return shot();
};
const teapot = show("teapot"), sphere = show("sphere"), pixel = new Uint8Array(4);
gl.readPixels(canvas.width / 2, canvas.height / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
document.body.dataset.result = [hovered === start, dragged !== start, back !== dragged,
                                teapot !== back && sphere !== back && teapot !== sphere,
                                pixel[0] + pixel[1] + pixel[2] > 80, gl.getError() === 0, errors === 0].join(" ");
)",
                     400),
            "true true true true true true true");
}

TEST_F(Export, ThePageShowsTheLightFromAllAround) {
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool("chromium")) GTEST_SKIP() << "no chromium";
  const FactoredBrdf brdf = smooth_model(model_case("Pqpr"));
  write(folder_ / "two lobes.exr", format_model({brdf, {}, "{}"}));
  ASSERT_EQ(exports("--to html --environment studio"), 0) << read(folder_ / "said");
  std::istringstream found(run_page(R"(
find("#lamp").checked = false;
find("select").value = "sphere";
find("select").dispatchEvent(new Event("input"));
const pixel = new Uint8Array(4), lit = canvas.toDataURL();
gl.readPixels(canvas.width / 2, canvas.height / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
find("#around").click();
document.body.dataset.result = [canvas.toDataURL() !== lit, gl.getError() + errors, find("#exposure").value,
                                canvas.width, canvas.height, ...pixel].join(" ");
)",
                                    300));
  std::string changes;
  int faults = -1, width = 0, height = 0;
  double stops = 0;
  found >> changes >> faults >> stops >> width >> height;
  EXPECT_EQ(changes, "true");
  EXPECT_EQ(faults, 0);
  // The light is that of the pixel's middle, on a sphere of radius 0.85 that is as wide as the lesser side.
  const auto at = [&](int pixels) { return pixels % 2 ? 0 : 1 / (0.85 * std::min(width, height)); };
  const double x = at(width), y = at(height);
  const Rgb light =
      prefilter(brdf, *find_environment("studio")).radiance({x, y, std::sqrt(1 - x * x - y * y)}, {0, 0, 1});
  for (const double channel : {light.r, light.g, light.b}) {
    double level = -1;
    found >> level;
    EXPECT_NEAR(level, 255 * std::pow(std::min(std::exp2(stops) * channel, 1.0), 1 / 2.2), 2);
  }
}

TEST_F(Export, WritesTheLightFromAllAroundInGlsl) {
  for (const char* model : {"Pqpr", "DiskPqp"}) {
    const FactoredBrdf brdf = smooth_model(model_case(model));
    write(folder_ / "two lobes.exr", format_model({brdf, {}, "{}"}));
    ASSERT_EQ(exports("--to glsl --to glsl_es --environment sun"), 0) << read(folder_ / "said");
    const std::string manifest = read(folder_ / "out/two_lobes.json"), out = (folder_ / "out").string();
    EXPECT_THAT(manifest, HasSubstr("\"environment\": \"sun\""));
    EXPECT_THAT(manifest, HasSubstr("burnish_two_lobes_light"));
    EXPECT_THAT(read(folder_ / "out/two_lobes.light_0.ktx2"), HasSubstr("KTX 20"));
    if (!has_tool("glslangValidator")) GTEST_SKIP() << "no glslang";
    const char* arguments = brdf.isotropic() ? "vec3(0), vec3(1)" : "vec3(0), vec3(0), vec3(0), vec3(1)";
    for (const auto& [file, version] :
         {std::pair{"two_lobes.light.glsl", "450"}, {"two_lobes.light.es.glsl", "300 es"}}) {
      write(folder_ / "a.frag",
            fmt::format(
                "#version {}\n{}\nout vec4 c;\nvoid main() {{ c = vec4(burnish_two_lobes_light({}), 1); }}\n",
                version, read(folder_ / "out" / file), arguments));
      const Outcome checked = run(fmt::format("glslangValidator {}/a.frag", folder_.string()));
      EXPECT_EQ(checked.status, 0) << checked.output;
    }
  }
  EXPECT_EQ(exports("--to ktx2 --environment sun"), 2);
  EXPECT_EQ(exports("--to html --environment no_such_sky.exr"), 1);
}

TEST_F(Export, PutsManyTablesIntoFewTextures) {
  const auto textures = [&] {
    return std::ranges::count_if(
        fs::directory_iterator(folder_ / "out"),
        [](const fs::directory_entry& entry) { return entry.path().extension() == ".ktx2"; });
  };
  write(folder_ / "two lobes.exr", format_model({smooth_model(model_case("ManyTables")), {}, "{}"}));
  ASSERT_EQ(exports("--to wgsl --to three --to html"), 0) << read(folder_ / "said");
  EXPECT_EQ(textures(), 1);
  EXPECT_EQ(exports("--to html --environment studio"), 0) << read(folder_ / "said");
  write(folder_ / "two lobes.exr", format_model({smooth_model(model_case("Volumes")), {}, "{}"}));
  ASSERT_EQ(exports("--to wgsl"), 0) << read(folder_ / "said");
  EXPECT_EQ(textures(), 2);
}

}  // namespace
}  // namespace burnish
