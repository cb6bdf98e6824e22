// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/klems.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string basis(std::string_view rings) {
  return fmt::format("<AngleBasis><AngleBasisName>Small</AngleBasisName>{}</AngleBasis>", rings);
}

std::string ring(double low, double high, int count) {
  return fmt::format(
      "<AngleBasisBlock><nPhis>{}</nPhis><ThetaBounds><LowerTheta>{}</LowerTheta><UpperTheta>{}</UpperTheta>"
      "</ThetaBounds></AngleBasisBlock>",
      count, low, high);
}

std::string matrix(std::string_view direction, std::string_view values,
                   std::string_view wavelength = "Visible") {
  return fmt::format(
      "<WavelengthData><Wavelength>{}</Wavelength><WavelengthDataBlock>"
      "<WavelengthDataDirection>{}</WavelengthDataDirection><ColumnAngleBasis>Small</ColumnAngleBasis>"
      "<RowAngleBasis>Small</RowAngleBasis><ScatteringData>\n{}</ScatteringData></WavelengthDataBlock></"
      "WavelengthData>",
      wavelength, direction, values);
}

std::string window(std::string_view bases, std::string_view matrices,
                   std::string_view structure = "Columns") {
  return fmt::format(
      "<?xml "
      "version=\"1.0\"?><WindowElement><Optical><Layer><Material><Name>blind</Name></"
      "Material><DataDefinition>"
      "<IncidentDataStructure>{}</IncidentDataStructure>{}</DataDefinition>{}</Layer></Optical></"
      "WindowElement>",
      structure, bases, matrices);
}

const std::string kBasis = basis(ring(0, 30, 1) + ring(30, 90, 2));  // patches at the normal, +x and -x
constexpr std::string_view kValues = "1, 2, 3\n4 5 6\n7 8 -9\n";     // rows outgoing, columns incident

std::string klems_error(const std::string& text) {
  return error_of([&] { parse_klems(memory_file(text), {}); });
}

TEST(Klems, ReadsTheMatrixOfTheChosenSide) {
  const std::string text = window(kBasis, matrix("Transmission Front", "0 0 0 0 0 0 0 0 0") +
                                              matrix("Reflection Back", "0 0 0 0 0 0 0 0 5") +
                                              matrix("Reflection Front", kValues));
  EXPECT_TRUE(looks_like_klems(text));
  const auto front = parse_klems(memory_file(text), {});
  EXPECT_EQ(front.findings.description, "blind");
  EXPECT_EQ(front.findings.negative_count, 1u);
  const Vec3 normal{0, 0, 1}, plus_x = spherical_direction(kPi / 3, 0), minus_x = mirror(plus_x);
  double f;
  front.table.eval(minus_x, minus_x, {&f, 1});  // the light travels to +x
  EXPECT_NEAR(f, 8, 1e-6);
  front.table.eval(normal, plus_x, {&f, 1});
  EXPECT_NEAR(f, 4, 1e-6);
  front.table.eval(plus_x, normal, {&f, 1});
  EXPECT_NEAR(f, 3, 1e-6);
  OpenOptions options;
  options.back_side = true;
  parse_klems(memory_file(text), options).table.eval(plus_x, minus_x, {&f, 1});
  EXPECT_NEAR(f, 5, 1e-6);
}

double at_normal(const KlemsFile& file) {
  double f;
  file.table.eval({0, 0, 1}, {0, 0, 1}, {&f, 1});
  return f;
}

TEST(Klems, TakesTheVisibleBlockAndNamesTheOthers) {
  const std::string solar = matrix("Reflection Front", "9 9 9 9 9 9 9 9 9", "Solar"),
                    through = matrix("Transmission Front", "9 9 9 9 9 9 9 9 9");
  for (const char* name : {"Visible", "visible", " VISIBLE "})
    for (const bool first : {false, true}) {
      const std::string visible = matrix("Reflection Front", kValues, name);
      const auto file = parse_klems(
          memory_file(window(kBasis, first ? visible + solar + through : solar + through + visible)), {});
      EXPECT_EQ(at_normal(file), 1) << name;
      EXPECT_THAT(file.findings.left_out,
                  ElementsAre("Reflection Front (Solar)", "Transmission Front (Visible)"));
      EXPECT_THAT(file.findings.conventions.front(), HasSubstr("'Reflection Front', visible spectrum"));
      EXPECT_EQ(file.findings.block, (BsdfBlock{BsdfPart::reflection_front, std::string(trimmed(name))}));
    }
  const auto alone = parse_klems(memory_file(window(kBasis, solar)), {});
  EXPECT_EQ(at_normal(alone), 9);
  EXPECT_THAT(alone.findings.conventions.front(), HasSubstr("Solar, no Visible block"));
  EXPECT_THAT(alone.findings.left_out, IsEmpty());
  // Blocks of colour are left out, and the findings name them.
  const auto colour =
      parse_klems(memory_file(window(kBasis, matrix("Reflection Front", "9 9 9 9 9 9 9 9 9", "CIE-X") +
                                                 matrix("Reflection Front", kValues) +
                                                 matrix("Reflection Front", "8 8 8 8 8 8 8 8 8", "CIE-Z"))),
                  {});
  EXPECT_EQ(at_normal(colour), 1);
  EXPECT_THAT(colour.findings.left_out, ElementsAre("Reflection Front (CIE-X)", "Reflection Front (CIE-Z)"));
  EXPECT_EQ(colour.findings.blocks.back(), (BsdfBlock{BsdfPart::reflection_front, "CIE-XYZ"}));
}

TEST(Klems, TakesTheOnlyReflectionThereIs) {
  const auto back = parse_klems(memory_file(window(kBasis, matrix("reflection back", kValues))), {});
  EXPECT_EQ(at_normal(back), 1);
  EXPECT_EQ(back.findings.block, (BsdfBlock{BsdfPart::reflection_back, "Visible"}));
  EXPECT_THAT(back.findings.conventions.front(),
              HasSubstr("'Reflection Back', the only reflection there is"));
  const auto front =
      parse_klems(memory_file(window(kBasis, matrix("Reflection Front", kValues))), {.back_side = true});
  EXPECT_THAT(front.findings.conventions.front(),
              HasSubstr("'Reflection Front', the only reflection there is"));
}

// A sheet with four parts, and a second band of two of them.
std::string sheet() {
  return window(kBasis, matrix("Transmission Front", "1 2 3 4 5 6 7 8 9") +
                            matrix("Transmission Back", "11 12 13 14 15 16 17 18 19", "visible") +
                            matrix("Reflection Back", "21 22 23 24 25 26 27 28 29") +
                            matrix("Reflection Front", "31 32 33 34 35 36 37 38 39") +
                            matrix("Transmission Front", "41 42 43 44 45 46 47 48 49", "Solar") +
                            matrix("Reflection Back", "51 52 53 54 55 56 57 58 59", "NIR"));
}

TEST(Klems, ReadsEachPartInEachBand) {
  using enum BsdfPart;
  struct Wanted {
    std::optional<BsdfPart> part;
    const char* band;
    BsdfBlock found;
    double at_normal;
  };
  for (const Wanted& wanted : {Wanted{{}, "", {reflection_front, "Visible"}, 31},
                               {reflection_back, "", {reflection_back, "Visible"}, 21},
                               {transmission_front, "", {transmission_front, "Visible"}, 1},
                               {transmission_back, "", {transmission_back, "visible"}, 11},
                               {transmission_front, "solar", {transmission_front, "Solar"}, 41},
                               {{}, "SOLAR", {transmission_front, "Solar"}, 41},
                               {{}, "nir", {reflection_back, "NIR"}, 51}}) {
    const auto file = parse_klems(memory_file(sheet()), {.part = wanted.part, .band = wanted.band});
    EXPECT_EQ(file.findings.block, wanted.found) << to_string(wanted.found);
    EXPECT_EQ(at_normal(file), wanted.at_normal) << to_string(wanted.found);
    EXPECT_EQ(file.findings.blocks.size(), 6u);
    EXPECT_EQ(file.findings.left_out.size(), 5u);
    EXPECT_EQ(file.findings.transmits(), is_transmission(wanted.found.part));
  }
}

// wo is mirrored through the surface, so light that goes straight on leaves in the mirror direction.
TEST(Klems, TransmissionHasTheMirrorDirectionStraightOn) {
  const auto file = parse_klems(memory_file(sheet()), {.part = BsdfPart::transmission_front});
  const Vec3 plus_x = spherical_direction(kPi / 3, 0), minus_x = mirror(plus_x);
  double f;
  file.table.eval(plus_x, minus_x, {&f, 1});  // light travels to -x, in the patch of -x
  EXPECT_EQ(f, 9);
  file.table.eval(minus_x, minus_x, {&f, 1});
  EXPECT_EQ(f, 8);
  EXPECT_THAT(file.findings.conventions, Contains(HasSubstr("wo is mirrored through the surface")));
  EXPECT_THAT(file.findings.conventions.front(), HasSubstr("'Transmission Front', visible spectrum"));
  EXPECT_THAT(file.findings.warnings, IsEmpty());
}

TEST(Klems, NamesThePartsThereAreWhereOneIsMissing) {
  const auto error = [](const OpenOptions& options, const std::string& text) {
    return error_of([&] { parse_klems(memory_file(text), options); });
  };
  const std::string front =
      window(kBasis, matrix("Reflection Front", kValues) + matrix("Transmission Front", kValues, "Solar"));
  EXPECT_THAT(error({.part = BsdfPart::transmission_back}, front),
              HasSubstr("expected part transmission-back, found reflection-front (Visible), "
                        "transmission-front (Solar)"));
  EXPECT_THAT(error({.band = "NIR"}, front),
              HasSubstr("expected band 'NIR', found reflection-front (Visible)"));
  EXPECT_THAT(error({.part = BsdfPart::transmission_front, .band = "Visible"}, front),
              HasSubstr("expected part transmission-front in band 'Visible', found"));
}

TEST(Klems, TakesTransmissionWhereThereIsNoReflectionAndSaysSo) {
  const auto file = parse_klems(memory_file(window(kBasis, matrix("Transmission Back", kValues))), {});
  EXPECT_EQ(at_normal(file), 1);
  EXPECT_EQ(file.findings.block, (BsdfBlock{BsdfPart::transmission_back, "Visible"}));
  EXPECT_THAT(file.findings.warnings, ElementsAre("The file has no reflection: transmission-back was read."));
}

// A reflectance of X = Y = Z is white under equal energy, and Visible stands for Y.
TEST(Klems, ReadsColourAsThreeChannels) {
  const std::string grey = ".2 0 0 0 .2 0 0 0 .2", blue = ".4 0 0 0 .2 0 0 0 .2";
  const std::string text =
      window(kBasis, matrix("Transmission Back", grey, "CIE-X") + matrix("Transmission Back", grey) +
                         matrix("Transmission Back", blue, "CIE-Z"));
  const auto file = parse_klems(memory_file(text), {.band = "cie-xyz"});
  ASSERT_EQ(file.table.channels(), 3u);
  EXPECT_EQ(file.findings.block, (BsdfBlock{BsdfPart::transmission_back, "CIE-XYZ"}));
  EXPECT_EQ(file.findings.blocks.size(), 4u);
  EXPECT_THAT(file.findings.left_out, IsEmpty());
  std::array<double, 3> f;
  const Vec3 w = spherical_direction(kPi / 3, 0);
  file.table.eval(w, mirror(w), f);
  for (const double value : f) EXPECT_NEAR(value, 0.2, 1e-7);
  file.table.eval({0, 0, 1}, {0, 0, 1}, f);
  EXPECT_GT(f[2], 0.35) << "more Z is more blue";
  EXPECT_LT(f[1], f[2]);
  // CIE-Z alone is grey.
  EXPECT_EQ(parse_klems(memory_file(text), {.band = "CIE-Z"}).table.channels(), 1u);
}

// genBSDF -recover writes a line in front of the XML.
TEST(Klems, PassesOverTextBeforeTheXml) {
  const std::string text =
      "Recover using: genBSDF -recover genBSDF.abc\n" + window(kBasis, matrix("Reflection Front", kValues));
  EXPECT_TRUE(looks_like_klems(text));
  EXPECT_EQ(at_normal(parse_klems(memory_file(text), {})), 1);
  EXPECT_FALSE(looks_like_klems("a text without any"));
  EXPECT_THAT(klems_error("12345<WindowElement>"),
              AllOf(HasSubstr("well-formed XML"), Not(HasSubstr("offset 0"))));
}

TEST(Klems, KnowsTheBasesByNameInAnyCase) {
  for (const auto& [name, count] : {std::pair("LBNL/Klems Full", 145),
                                    {"LBNL/Klems Half", 77},
                                    {"LBNL/Klems Half", 73},
                                    {"lbnl/klems quarter", 41}}) {
    std::string values, text = matrix("Reflection Front", "@");
    for (int k = 0; k < count * count; ++k) values += k % (count + 1) == 0 ? "0.5 " : "0 ";
    text.replace(text.find('@'), 1, values);
    for (std::size_t at; (at = text.find("Small")) != std::string::npos;) text.replace(at, 5, name);
    const auto file = parse_klems(memory_file(window("", text, "columns")), {});
    EXPECT_EQ(file.table.values.size(), static_cast<std::size_t>(count * count)) << name;
    double f;
    // The mirror direction has the same patch.
    for (const Vec3 wi : {Vec3{0, 0, 1}, spherical_direction(0.6, 0.2), spherical_direction(1.3, 4)}) {
      file.table.eval(wi, mirror(wi), {&f, 1});
      EXPECT_EQ(f, 0.5) << name;
    }
  }
}

TEST(Klems, ReadsRowsAsColumnsTurned) {
  const std::string rows = window(kBasis, matrix("Reflection Front", "1 4 7 2 5 8 3 6 -9"), "Rows"),
                    columns = window(kBasis, matrix("Reflection Front", kValues));
  EXPECT_EQ(parse_klems(memory_file(rows), {}).table.values,
            parse_klems(memory_file(columns), {}).table.values);
}

TEST(Klems, SaysWhatIsWrong) {
  const std::string good = matrix("Reflection Front", kValues);
  EXPECT_THAT(klems_error("<WindowElement>"), HasSubstr("well-formed XML"));
  EXPECT_THAT(klems_error("<WindowElement/>"), HasSubstr("Layer"));
  EXPECT_THAT(klems_error(window(kBasis, good, "TensorTree3")), HasSubstr("Columns"));
  EXPECT_THAT(klems_error(window(kBasis, matrix("Absorptance Front", kValues))),
              HasSubstr("'Reflection Front' or another part, found 'Absorptance Front'"));
  EXPECT_THAT(klems_error(window("", good)), HasSubstr("AngleBasis named"));
  EXPECT_THAT(klems_error(window(basis(ring(0, 30, 1)), good)), HasSubstr("up to 90"));
  EXPECT_THAT(klems_error(window(basis(ring(0, 30, 1) + ring(40, 90, 2)), good)),
              HasSubstr("follow each other"));
  EXPECT_THAT(klems_error(window(basis(ring(0, 90, -3)), good)), HasSubstr("patches"));
  EXPECT_THAT(klems_error(window(basis(ring(0, 90, 2000000000)), good)), HasSubstr("patches"));
  EXPECT_THAT(klems_error(window(kBasis, matrix("Reflection Front", "1 2 3"))),
              HasSubstr("9 values in ScatteringData, found 3"));
  EXPECT_THAT(klems_error(window(kBasis, matrix("Reflection Front", "1 2 3 4 5 6 7 8 9 10"))),
              HasSubstr("found more"));
  EXPECT_THAT(klems_error(window(kBasis, matrix("Reflection Front", "1 2 3 4 5 6 7 8 nan"))),
              HasSubstr("finite"));
}

TEST(Klems, ReadsAShadeFabricThatReflectsLessThanItGets) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "klems" / "mecho_shade_fabric_aniso.xml");
  for (const bool back : {false, true}) {
    OpenOptions options;
    options.back_side = back;
    const auto file = parse_klems(bytes, options);
    const PatchTable& table = file.table;
    ASSERT_EQ(table.values.size(), 145u * 145);
    // The sums give the albedo of every incident patch, and how far the fabric itself is from reciprocity.
    double asymmetry = 0, sum = 0;
    for (std::size_t i = 0; i < 145; ++i) {
      double albedo = 0;
      for (std::size_t o = 0; o < 145; ++o) {
        albedo += static_cast<double>(table.values[o * 145 + i]) * table.outgoing.projected_solid_angle(o);
        asymmetry += static_cast<double>(std::abs(table.values[o * 145 + i] - table.values[i * 145 + o]));
        sum += static_cast<double>(table.values[o * 145 + i]);
      }
      EXPECT_GT(albedo, 0.1);
      EXPECT_LT(albedo, 0.7);
    }
    EXPECT_LT(asymmetry / sum, 0.1);
    // Grazing light is reflected to the other side of the normal more than back.
    double forward = 0, backward = 0, f;
    for (std::size_t i = 133; i < 145; ++i) {
      const Vec3 wi = table.incident.centre(i);
      table.eval(wi, mirror(wi), {&f, 1});
      forward += f;
      table.eval(wi, wi, {&f, 1});
      backward += f;
    }
    EXPECT_GT(forward, (back ? 3 : 1.3) * backward);
  }
}

/// Pairs of directions by their angles in degrees, none on a border of patches.
constexpr double kPairsOfRadiance[][4] = {
    {10, 20, 12, 205}, {40, 100, 38, 275}, {60, 230, 22, 70}, {70, 310, 72, 125}, {30, 0, 50, 90}};

// Radiance 6.0a gives these values, by bsdf.query of pyradiance 1.3.1. Its front, z > 0, is the file's back. No value
// of the pairs that tests/bsdf/radiance.py draws is more than 3e-4 off.
TEST(Klems, EvaluatesEachPartAsRadianceDoes) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "klems" / "mecho_shade_fabric_aniso.xml");
  struct Row {
    BsdfPart part;
    double values[5];
  };
  for (const Row& row :
       {Row{BsdfPart::reflection_front, {0.147169, 0.112806, 0.118509, 0.277434, 0.116319}},
        Row{BsdfPart::reflection_back, {0.076446, 0.082304, 0.075115, 0.327417, 0.063959}},
        Row{BsdfPart::transmission_front, {0.002644, 0.012121, 0.00077, 0.000791, 0.000785}},
        Row{BsdfPart::transmission_back, {0.003052, 0.014371, 0.001211, 0.000659, 0.000602}}}) {
    const PatchTable table = parse_klems(bytes, {.part = row.part}).table;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto& [theta_i, phi_i, theta_o, phi_o] = kPairsOfRadiance[k];
      double f;
      table.eval(spherical_direction(radians(theta_i), radians(phi_i)),
                 spherical_direction(radians(theta_o), radians(phi_o)), {&f, 1});
      EXPECT_NEAR(f, row.values[k], 1e-3 * row.values[k]) << to_string(row.part) << " " << k;
    }
  }
}

// LBNL's window engine gives these shares of light (pywincalc 3.3.1, from the same matrices with commas between
// values). Its front is the file's front. Its azimuth is the patch's, turned by 180 degrees.
TEST(Klems, HasTheSidesOfTheWindowEngineAndItsAzimuthsTurned) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "klems" / "mecho_shade_fabric_aniso.xml");
  struct Row {
    double theta_deg, phi_deg;
    double shares[4];  // in the order of kBsdfParts
  };
  for (const Row& row : {Row{0, 0, {0.400618, 0.217820, 0.0178758, 0.0106714}},
                         Row{30, 0, {0.399368, 0.219885, 0.0178762, 0.0168884}},
                         Row{30, 90, {0.411121, 0.224665, 0.0144066, 0.0151025}},
                         Row{60, 45, {0.454990, 0.248445, 0.00227956, 0.00301157}}})
    for (std::size_t k = 0; k < kBsdfParts.size(); ++k) {
      const PatchTable table = parse_klems(bytes, {.part = kBsdfParts[k]}).table;
      const double share =
          table.albedo(spherical_direction(radians(row.theta_deg), radians(row.phi_deg) + kPi));
      EXPECT_NEAR(share, row.shares[k], 1e-5 * row.shares[k]) << row.theta_deg << " " << k;
    }
}

}  // namespace
}  // namespace burnish
