// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/convert.h>
#include <burnish/io/merl.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/azimuth_mean.h>
#include <burnish/testing/files.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kTolerance = 1e-5;
const ConvertOptions kSmall{.count = 300, .cells = 8};

Source reread(const Converted& converted, const OpenOptions& options = {}) {
  return parse_source(memory_file(converted.bytes), options);
}

// Returns the number of entries, and expects that each is the source's value in its direction.
std::size_t expect_entries_of(const Source& table, BrdfRef source) {
  const Samples entries = table_entries(table);
  std::vector<double> f(source.channels());
  std::size_t compared = 0;
  double worst = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& [wi, wo] = entries.pairs[i];
    // The last ring of an RGL file stands for 89 degrees.
    if (std::min(wi.z, wo.z) < std::cos(radians(88.9)) || !source.eval(wi, wo, f)) continue;
    ++compared;
    for (std::size_t c = 0; c < f.size(); ++c) worst = std::max(worst, std::abs(entries.at(i)[c] / f[c] - 1));
  }
  EXPECT_LT(worst, kTolerance);
  return compared;
}

constexpr const char* kGlossy = "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5,kd=0.3";
constexpr const char* kBrushed = "ggx:alpha_x=0.2,alpha_y=0.5,f0=0.5,kd=0.3";

TEST(Convert, MakesEachFileOfAModelFromTheOther) {
  const Model model{.brdf = random_model(kEverything, kEverySize, 3, TableFormat::rgb9e5),
                    .notes = R"({"source":"random"})"};
  const Source source = to_source("paint", model);
  const Converted exr = convert(source, "model");
  EXPECT_EQ(exr.bytes, format_model(model));
  EXPECT_THAT(exr.losses, IsEmpty());

  // The bytes are the same by way of the other file. Notes are written only if the options say so.
  const Converted whole = convert(reread(exr), "burnish", {.notes = true}), bare = convert(source, "burnish");
  EXPECT_THAT(whole.losses, IsEmpty());
  EXPECT_EQ(convert(reread(whole), "model").bytes, exr.bytes);
  EXPECT_THAT(bare.losses, testing::ElementsAre("the notes of the fit"));
  EXPECT_EQ(to_model(reread(bare)).brdf, model.brdf);
  EXPECT_THAT(convert(reread(bare), "burnish").losses, IsEmpty());

  for (const char* format : {"model", "burnish"})
    EXPECT_THAT(error_of([&] { convert(open_source(kGlossy, {}), format); }), HasSubstr("expected a model"));
}

TEST(Convert, EveryTableHoldsTheSourceAtItsNodes) {
  const Source source = open_source(kGlossy, {});
  for (const char* format : {"merl", "rgl", "mbsdf", "zemax"}) {
    const Converted converted = convert(source, format, kSmall);
    EXPECT_THAT(converted.losses, testing::ElementsAre(HasSubstr("sampled at "))) << format;
    EXPECT_GT(expect_entries_of(reread(converted), source.ref()), 500u) << format;
  }
}

TEST(Convert, IsotropicFormatsGetTheMeanOverTheAzimuth) {
  const Source source = open_source(kBrushed, {});
  const AzimuthMean mean(source.ref());
  for (const char* format : {"merl", "mbsdf"}) {
    const Converted converted = convert(source, format, kSmall);
    EXPECT_THAT(converted.losses, Contains(HasSubstr("anisotropy averaged"))) << format;
    EXPECT_GT(expect_entries_of(reread(converted), mean), 500u) << format;
  }
}

// Small tables of every format.
std::vector<std::pair<std::string, Source>> tables() {
  std::vector<std::pair<std::string, Source>> all;
  const Source source = open_source(kGlossy, {});
  for (const char* format : {"merl", "rgl", "mbsdf", "zemax"})
    all.emplace_back(format, reread(convert(source, format, kSmall)));
  return all;
}

TEST(Convert, ATableInItsOwnFormatKeepsItsEntries) {
  for (const auto& [format, table] : tables()) {
    const Converted converted = convert(table, format, kSmall);
    EXPECT_THAT(converted.losses, IsEmpty()) << format;
    const Samples before = table_entries(table), after = table_entries(reread(converted));
    ASSERT_EQ(before.size(), after.size()) << format;
    EXPECT_EQ(before.pairs, after.pairs) << format;
    for (std::size_t i = 0; i < before.values.size(); ++i)
      ASSERT_NEAR(after.values[i], before.values[i], kTolerance * before.values[i]) << format;
  }
}

TEST(Convert, EntriesSurviveInScatteredFormats) {
  for (const auto& [format, table] : tables()) {
    const Samples entries = table_entries(table);
    for (const char* scattered : {"csv", "astm"}) {
      const Converted converted = convert(table, scattered, {.entries = true});
      EXPECT_THAT(converted.losses, Contains(HasSubstr("the table's grid")));
      const Source back = reread(converted);
      ASSERT_NE(back.samples(), nullptr);
      ASSERT_EQ(back.samples()->size(), entries.size()) << format << " as " << scattered;
      EXPECT_TRUE(back.ref().isotropic());
      double before = 0, after = 0;  // Samples may come in another order.
      for (const double v : entries.values) before += v;
      for (const double v : back.samples()->values) after += v;
      EXPECT_NEAR(after, before, 1e-12 * before);
    }
    break;  // One table of that size is enough.
  }
}

TEST(Convert, WarnsWhereItIsFarFromTheSource) {
  const Converted far = convert(open_source("ggx:alpha_x=0.05,alpha_y=0.05", {}), "mbsdf", {.cells = 6});
  EXPECT_THAT(far.warnings, testing::ElementsAre(HasSubstr("% from the source on average")));
  EXPECT_TRUE(far.resampled);
  const Converted near = convert(open_source("lambert", {}), "mbsdf", {.cells = 6});
  EXPECT_THAT(near.warnings, IsEmpty());
  EXPECT_FALSE(convert(reread(near), "mbsdf", {.cells = 6}).resampled);
}

TEST(Convert, NamesCommentsThatStayBehindAndCallsNotesNoLoss) {
  Source zemax = reread(convert(open_source("lambert", {}), "zemax"));
  zemax.findings.comments = {" Sample: panel 7", " lit from the left"};
  EXPECT_THAT(convert(zemax, "mbsdf", kSmall).losses,
              Contains("2 comments: 'Sample: panel 7', 'lit from the left'"));
  // An MBSDF file has lines of its own.
  Source mbsdf = reread(convert(open_source("lambert", {}), "mbsdf", kSmall));
  mbsdf.findings.description = "MAKER=me";
  EXPECT_THAT(convert(mbsdf, "mbsdf").losses, testing::ElementsAre("the remark 'MAKER=me'"));
  EXPECT_THAT(convert(mbsdf, "zemax").losses, testing::Not(Contains(HasSubstr("remark"))));
  const Converted kept = convert(zemax, "zemax");
  EXPECT_THAT(kept.losses, IsEmpty());
  EXPECT_THAT(kept.notes, testing::ElementsAre(HasSubstr("TIS")));
  EXPECT_THAT(kept.bytes, HasSubstr("# lit from the left\n"));
}

TEST(Convert, KnowsWhichSourcesHaveEntries) {
  for (const auto& [format, table] : tables()) EXPECT_TRUE(has_entries(table)) << format;
  EXPECT_FALSE(has_entries(open_source("lambert", {})));
  EXPECT_FALSE(has_entries(reread(convert(open_source("lambert", {}), "csv", kSmall))));
}

TEST(Convert, ScatteredSamplesStayBetweenCsvAndAstm) {
  for (const bool isotropic : {true, false}) {
    const Converted csv = convert(open_source(isotropic ? kGlossy : kBrushed, {}), "csv", kSmall);
    EXPECT_THAT(csv.losses, Contains(HasSubstr("300 samples drawn")));
    const Source first = reread(csv);
    const Converted astm = convert(first, "astm", kSmall);
    EXPECT_THAT(astm.losses, IsEmpty());
    const Source second = reread(astm);
    const Converted back = convert(second, "csv", kSmall);
    EXPECT_THAT(back.losses, IsEmpty());
    const Source third = reread(back);
    for (const Source* s : {&second, &third}) {
      ASSERT_EQ(s->samples()->size(), 300u);
      EXPECT_EQ(s->ref().isotropic(), isotropic);
      // Each sample of the first has one of the same angles and value in the second.
      const Samples& from = *first.samples();
      const Samples& to = *s->samples();
      for (std::size_t i = 0; i < from.size(); ++i) {
        double nearest = 1;
        for (std::size_t j = 0; j < to.size(); ++j) {
          const auto& a = from.pairs[i];
          const auto& b = to.pairs[j];
          const double angles = std::abs(a.wi.z - b.wi.z) + std::abs(a.wo.z - b.wo.z) +
                                std::abs(dot(a.wi, a.wo) - dot(b.wi, b.wo));
          const double value = std::abs(to.at(j)[1] / from.at(i)[1] - 1);
          nearest = std::min(nearest, angles + value);
        }
        ASSERT_LT(nearest, kTolerance);
      }
    }
  }
}

TEST(Convert, ScatteredSamplesKeepTheirAnglesInAnIsotropicFormat) {
  const Source csv = reread(convert(open_source(kBrushed, {}), "csv", kSmall));
  ASSERT_FALSE(csv.ref().isotropic());
  const Converted converted = convert(csv, "openmaterial", kSmall);
  EXPECT_THAT(converted.losses, Contains(HasSubstr("the orientation of 300 samples")));
  const Source read = reread(converted);
  EXPECT_TRUE(read.ref().isotropic());
  const Samples &from = *csv.samples(), &to = *read.samples();
  ASSERT_EQ(to.size(), from.size());
  for (const DirectionPair& a : from.pairs) {
    double nearest = 1;
    for (const DirectionPair& b : to.pairs)
      nearest = std::min(nearest, std::abs(a.wi.z - b.wi.z) + std::abs(a.wo.z - b.wo.z) +
                                      std::abs(dot(a.wi, a.wo) - dot(b.wi, b.wo)));
    ASSERT_LT(nearest, kTolerance);
  }
}

constexpr const char* kSpectra =
    "# isotropic\ntheta_i,phi_i,theta_o,phi_o,value_450,value_550,value_600,value_650\n"
    "10,0,20,180,0.1,0.2,0.3,0.4\n30,0,20,180,0.2,0.3,0.4,0.5\n10,0,60,180,0.3,0.4,0.5,0.6\n"
    "50,0,60,180,0.3,0.4,0.5,0.6\n";

TEST(Convert, KeepsSpectraWhereTheFormatHasThem) {
  const OpenOptions spectral{.keep_spectral = true};
  const Source source = parse_source(memory_file(kSpectra), spectral);
  for (const char* format : {"astm", "csv"}) {
    const Converted converted = convert(source, format);
    EXPECT_THAT(converted.losses, IsEmpty());
    const Source back = reread(converted, spectral);
    EXPECT_EQ(back.findings.lambda_nm, source.findings.lambda_nm);
    EXPECT_EQ(back.samples()->values.size(), 16u);
  }
  for (const char* format : {"merl", "mbsdf", "zemax", "exr"})
    EXPECT_THAT(error_of([&] { convert(source, format); }),
                AllOf(testing::StartsWith("test.file"), HasSubstr("found 4 channels")))
        << format;
}

TEST(Convert, SaysWhatReadingLost) {
  Source source = parse_source(memory_file(kSpectra), {});
  EXPECT_THAT(convert(source, "csv").losses, Contains(HasSubstr("linear Rec. 709 (equal energy)")));
  source.findings.origin.licence = "MPL-2.0";
  EXPECT_THAT(convert(source, "csv").losses, Contains(HasSubstr("licence")));
}

/// Returns a Klems file with one patch a side, of this part and band beside a reflection.
std::string one_patch(std::string_view direction, std::string_view band) {
  const auto block = [](std::string_view named, std::string_view wavelength, std::string_view value) {
    return fmt::format(
        "<WavelengthData><Wavelength>{}</Wavelength><WavelengthDataBlock><WavelengthDataDirection>{}"
        "</WavelengthDataDirection><ColumnAngleBasis>One</ColumnAngleBasis><RowAngleBasis>One</RowAngleBasis>"
        "<ScatteringData>{}</ScatteringData></WavelengthDataBlock></WavelengthData>",
        wavelength, named, value);
  };
  return fmt::format(
      "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>Columns</IncidentDataStructure>"
      "<AngleBasis><AngleBasisName>One</AngleBasisName><AngleBasisBlock><nPhis>1</nPhis><ThetaBounds>"
      "<LowerTheta>0</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock></AngleBasis>"
      "</DataDefinition>{}{}</Layer></Optical></WindowElement>",
      block("Reflection Front", "Visible", "0.1"), block(direction, band, "0.2"));
}

TEST(Convert, WritesAPartBackToItsSideAndBand) {
  using enum BsdfPart;
  for (const auto& [direction, part] : {std::pair("Transmission Back", transmission_back),
                                        {"Transmission Front", transmission_front},
                                        {"Reflection Back", reflection_back}}) {
    const Source source =
        parse_source(memory_file(one_patch(direction, "Solar")), {.part = part, .band = "Solar"});
    const Converted tree = convert(source, "tensortree", {.cells = 8});
    EXPECT_THAT(tree.losses, Not(Contains(HasSubstr("side"))));
    EXPECT_THAT(tree.losses, Contains("Reflection Front (Visible)"));
    const Source back = parse_source(memory_file(tree.bytes), {.part = part, .band = "Solar"});
    EXPECT_EQ(back.findings.block, source.findings.block);
    double f;
    back.ref().eval({0, 0, 1}, {0, 0, 1}, {&f, 1});
    EXPECT_NEAR(f, 0.2, 1e-6);
  }
}

// MBSDF and Zemax files have no sides, and other formats no transmission.
TEST(Convert, SaysThatASideABandOrTransmissionIsLost) {
  const Source source = parse_source(memory_file(one_patch("Transmission Back", "Solar")),
                                     {.part = BsdfPart::transmission_back});
  for (const char* format : {"mbsdf", "zemax"}) {
    const Converted converted = convert(source, format, {.cells = 6});
    EXPECT_THAT(converted.losses, Contains(HasSubstr("those of the back"))) << format;
    EXPECT_THAT(converted.losses, Contains("the band Solar")) << format;
    EXPECT_THAT(converted.losses, Not(Contains(HasSubstr("transmission: the format")))) << format;
    EXPECT_EQ(parse_source(memory_file(converted.bytes), {}).findings.block,
              (BsdfBlock{BsdfPart::transmission_front, ""}))
        << format;
  }
  EXPECT_THAT(convert(source, "merl", {.cells = 6}).losses, Contains(HasSubstr("transmission: the format")));
}

TEST(Convert, SaysWhichPartASourceOfOnePartIs) {
  const std::string merl =
      convert(open_source("ggx:alpha_x=0.5,alpha_y=0.5,f0=0.4", {}), "merl", {.cells = 6}).bytes;
  EXPECT_EQ(parse_source(memory_file(merl), {.part = BsdfPart::reflection_front}).ref().channels(), 3u);
  EXPECT_THAT(error_of([&] { parse_source(memory_file(merl), {.part = BsdfPart::transmission_front}); }),
              HasSubstr("expected part transmission-front, found reflection-front alone (MERL"));
  EXPECT_THAT(error_of([&] { parse_source(memory_file(merl), {.band = "Solar"}); }),
              HasSubstr("expected band 'Solar', found reflection-front alone (MERL"));
}

// Readers of scattered files take no samples on the horizon, which ALTA's may hold.
TEST(Convert, LeavesOutSamplesOnTheHorizon) {
  const Vec3 up{0, 0, 1}, level{1, 0, 0}, nearly{1, 0, 1e-17}, slanted = spherical_direction(1.5, 0);
  const Source scattered{
      "scattered",
      ScatteredBrdf({1, true, {{up, level}, {slanted, up}, {up, nearly}, {up, slanted}}, {1, 2, 3, 4}}),
      {}};
  for (const char* format : {"csv", "astm"}) {
    const Converted converted = convert(scattered, format);
    EXPECT_THAT(converted.losses, Contains("2 samples on the horizon")) << format;
    EXPECT_EQ(parse_source(memory_file(converted.bytes), {}).samples()->size(), 2u) << format;
  }
}

TEST(Convert, KeepsValuesBelowZero) {
  const Source negative =
      parse_source(memory_file("theta_i,phi_i,theta_o,phi_o,value\n1,0,2,0,-1\n1,0,3,0,1\n"), {});
  const Converted converted = convert(negative, "csv");
  EXPECT_THAT(converted.losses, IsEmpty());
  EXPECT_THAT(parse_source(memory_file(converted.bytes), {}).samples()->values,
              testing::UnorderedElementsAre(-1, 1));
}

// The value f depends on wi alone. The table is not reciprocal, and with `side` not symmetric about the plane
// of incidence.
Source lopsided_table(bool side) {
  AngleTable table;
  table.axes = {make_axis({0}), make_axis({0.2, 0.6, 1.0, 1.4}), make_axis({0.2, 0.6, 1.0, 1.4}),
                make_axis({0, kHalfPi, kPi, 1.5 * kPi}, kTwoPi)};
  for (std::size_t i = 0; i < entry_count(table); ++i) {
    const auto node = node_of_entry(table, i);
    table.values.push_back(1 + static_cast<float>(node[1]) + (side && node[3] == 1 ? 1.0f : 0.0f));
  }
  return {"lopsided", table, {}};
}

TEST(Convert, SaysWhatIsAveraged) {
  EXPECT_THAT(convert(lopsided_table(false), "merl", kSmall).losses,
              Contains(HasSubstr("exchanged directions were averaged")));
  for (const char* format : {"mbsdf", "zemax"}) {
    EXPECT_THAT(convert(lopsided_table(true), format, kSmall).losses,
                Contains(HasSubstr("sides of the plane of incidence")));
    EXPECT_THAT(convert(lopsided_table(false), format, kSmall).losses,
                Not(Contains(HasSubstr("sides of the plane of incidence"))));
  }
}

TEST(Convert, RefusesWhatItCannotDo) {
  const Source source = open_source("lambert", {});
  EXPECT_THAT(error_of([&] { convert(source, "doc"); }), HasSubstr("expected one of merl"));
  EXPECT_THAT(error_of([&] { convert(source, "csv", {.entries = true}); }), HasSubstr("a table"));
  EXPECT_THAT(error_of([&] { convert(source, "merl", {.cells = 1}); }), HasSubstr("2 to 1000"));
}

TEST(Convert, RealTablesKeepTheirEntries) {
  BURNISH_NEEDS_DATA();
  for (const auto& [file, format] : {std::pair("rgl/chm_mint_rgb.bsdf", "rgl"),
                                     {"mbsdf/carpaint_blue.mbsdf", "mbsdf"},
                                     {"zemax/AnoBlackEC1onAlum.bsdf", "zemax"}}) {
    const Source source = open_source(data_folder() / file, {});
    const Samples before = table_entries(source), after = table_entries(reread(convert(source, format)));
    ASSERT_EQ(before.size(), after.size()) << file;
    for (std::size_t i = 0; i < before.values.size(); ++i)
      ASSERT_NEAR(after.values[i], before.values[i], kTolerance * std::abs(before.values[i])) << file;
  }
}

TEST(Convert, OfATensorTreeColourIsLostWhereThereIsSome) {
  const auto losses = [](const char* spec) {
    return convert(open_source(spec, {}), "tensortree", {.cells = 8}).losses;
  };
  EXPECT_THAT(losses("lambert"), Not(Contains(HasSubstr("colour"))));
  EXPECT_THAT(losses("lambert:kd=0.3/0.2/0.2"), Contains(HasSubstr("colour")));
}

}  // namespace
}  // namespace burnish
