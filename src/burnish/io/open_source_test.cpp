// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/factors/model_file.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/testing/files.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

using testing::HasSubstr;

TEST(Source, TellsTextFormatsApart) {
  const auto format_of = [](std::string_view text) {
    return parse_source(memory_file(text), {}).findings.format;
  };
  EXPECT_EQ(format_of("# c\n1\n500\n0.1 0 0.2 0 1\n"), "Cornell scattered spectra");
  EXPECT_EQ(format_of("# c\ntheta_i,phi_i,theta_o,phi_o,value\n1,0,2,0,1\n"), "CSV of scattered samples");
  EXPECT_EQ(format_of("SAMPLE x\nVARS theta_i,phi_i,theta_s,phi_s,BRDF\n.1 0 .2 0 1\n"), "ASTM E1392 text");
  EXPECT_EQ(format_of("Source Measured\nSymmetry Asymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"
                      "SampleRotation 1\n0\nAngleOfIncidence 1\n10\nScatterAzimuth 1\n0\nScatterRadial 1\n0\n"
                      "Monochrome\nDataBegin\nTIS 1\n1\nDataEnd\n"),
            "Zemax tabular BRDF");
}

TEST(Source, ReportsBytesOfNoKnownKind) {
  for (const std::string_view bytes : {"", "hello\n", "\x7f\x45LF\x01\x02", "<html></html>", "v/1"}) {
    const std::string error = error_of([&] { parse_source(memory_file(bytes), {}); });
    EXPECT_THAT(error, HasSubstr("test.file")) << bytes;
    EXPECT_THAT(error, HasSubstr("expected")) << bytes;
  }
  EXPECT_THAT(error_of([] { open_source("/nonexistent/file", {}); }), HasSubstr("no such file"));
}

TEST(Source, OpensAnalyticBrdfsByName) {
  const Source source = open_source("lambert", {});
  EXPECT_EQ(source.findings.format, "analytic");
  EXPECT_THAT(source.findings.description, HasSubstr("lambert"));
  EXPECT_EQ(source.ref().channels(), 3);
  EXPECT_THROW(open_source("lambert:nonsense=1", {}), Error);
}

TEST(Source, OpensModels) {
  Table table{"p", {.shape = TableShape::line, .width = 4}, 1, {1.0f, 1.0f, 0.5f, 0.5f}};
  const FactoredBrdf brdf(1, {table}, {Lobe{{0.25}, {{.table = 0, .projection = kProjectWi}}}},
                          TableFormat::half);
  const Source source = parse_source(memory_file(format_model({brdf, {}, "{}"})), {});
  EXPECT_EQ(source.findings.format, "burnish model");
  EXPECT_EQ(source.findings.sample_count, 4u);
  EXPECT_EQ(std::get<FactoredBrdf>(source.brdf), brdf);
}

TEST(Source, OpensTexelsOfSurfaces) {
  const TemporaryFolder folder("texels");
  const SpatialBrdf surface = random_surface(3, 2);
  for (const char* name : {"a#b.burnish", "wall.exr"}) {
    const std::string file = (folder.path / name).string();
    write_then_rename(file, format_surface_as(name, {.brdf = surface, .notes = "{}"}));
    const Source source = open_source("surface:" + file + "#2,1", {});
    EXPECT_EQ(source.findings.format, "texel of a surface");
    EXPECT_EQ(std::get<FactoredBrdf>(source.brdf), surface.texel(2, 1));
    for (const char* texel : {"3,1", "2,2", "-1,0", "1", "1,", "1,1,1", "a,b", ""})
      EXPECT_THAT(error_of([&] { open_source("surface:" + file + "#" + texel, {}); }),
                  HasSubstr("3 x 2 texels"))
          << texel;
    EXPECT_THAT(error_of([&] { open_source(file, {}); }), HasSubstr("surface:FILE#COLUMN,ROW"));
  }
}

TEST(Source, RefersToScatteredSamplesOnlyWhereThereAreSome) {
  const Source source = parse_source(memory_file("theta_i,phi_i,theta_o,phi_o,value\n1,0,2,0,1\n"), {});
  ASSERT_NE(source.samples(), nullptr);
  EXPECT_EQ(source.samples()->size(), 1u);
  EXPECT_EQ(source.ref().channels(), 1);
}

TEST(Source, OpensEveryRealMeasurementWithAPlausibleAlbedo) {
  BURNISH_NEEDS_DATA();
  std::size_t opened = 0;
  for (const char* folder : {"rgl", "cornell", "mbsdf", "zemax", "klems"})
    for (const auto& entry : std::filesystem::directory_iterator(data_folder() / folder)) {
      const Source source = open_source(entry.path(), {});
      ++opened;
      EXPECT_FALSE(source.findings.conventions.empty());
      EXPECT_GT(source.findings.sample_count, 0u);
      for (const double theta : {0.0, 30.0, 60.0}) {
        const auto [albedo, clamped, unknown] =
            directional_albedo(source.ref(), spherical_direction(radians(theta), 0));
        // Raw values of a colour outside the gamut may be below zero.
        for (std::size_t c = 0; c < albedo.size(); ++c) {
          EXPECT_TRUE(unknown > 0.5 || clamped[c] > 0) << entry.path();
          EXPECT_LT(clamped[c], 1.05) << entry.path() << " at " << theta;
        }
      }
    }
  EXPECT_EQ(opened, 15u);
}

}  // namespace
}  // namespace burnish
