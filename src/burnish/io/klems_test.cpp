#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/klems.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using testing::AllOf;
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
  front.table.eval(minus_x, minus_x, {&f, 1});  // light that travels to +x
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
      EXPECT_EQ(file.findings.side, "Reflection Front");
    }
  const auto alone = parse_klems(memory_file(window(kBasis, solar)), {});
  EXPECT_EQ(at_normal(alone), 9);
  EXPECT_THAT(alone.findings.conventions.front(), HasSubstr("Solar, no Visible block"));
  EXPECT_THAT(alone.findings.left_out, IsEmpty());
  // colour is left out, and said
  const auto colour =
      parse_klems(memory_file(window(kBasis, matrix("Reflection Front", "9 9 9 9 9 9 9 9 9", "CIE-X") +
                                                 matrix("Reflection Front", kValues) +
                                                 matrix("Reflection Front", "8 8 8 8 8 8 8 8 8", "CIE-Z"))),
                  {});
  EXPECT_EQ(at_normal(colour), 1);
  EXPECT_THAT(colour.findings.left_out, ElementsAre("Reflection Front (CIE-X)", "Reflection Front (CIE-Z)"));
}

TEST(Klems, TakesTheOnlyReflectionThereIs) {
  const auto back = parse_klems(memory_file(window(kBasis, matrix("reflection back", kValues))), {});
  EXPECT_EQ(at_normal(back), 1);
  EXPECT_EQ(back.findings.side, "Reflection Back");
  EXPECT_THAT(back.findings.conventions.front(),
              HasSubstr("'Reflection Back', the only reflection there is"));
  const auto front =
      parse_klems(memory_file(window(kBasis, matrix("Reflection Front", kValues))), {.back_side = true});
  EXPECT_THAT(front.findings.conventions.front(),
              HasSubstr("'Reflection Front', the only reflection there is"));
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
    // the mirror direction has the same patch
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
  EXPECT_THAT(klems_error(window(kBasis, matrix("Transmission Back", kValues))),
              HasSubstr("'Reflection Front', found 'Transmission Back'"));
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
    // Albedo of every incident patch, and the fabric's own reciprocity.
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

}  // namespace
}  // namespace burnish
