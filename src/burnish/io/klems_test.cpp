#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/klems.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

using testing::HasSubstr;

std::string basis(std::string_view rings) {
  return fmt::format("<AngleBasis><AngleBasisName>Small</AngleBasisName>{}</AngleBasis>", rings);
}

std::string ring(double low, double high, int count) {
  return fmt::format(
      "<AngleBasisBlock><nPhis>{}</nPhis><ThetaBounds><LowerTheta>{}</LowerTheta><UpperTheta>{}</UpperTheta>"
      "</ThetaBounds></AngleBasisBlock>",
      count, low, high);
}

std::string matrix(std::string_view direction, std::string_view values) {
  return fmt::format(
      "<WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>"
      "<WavelengthDataDirection>{}</WavelengthDataDirection><ColumnAngleBasis>Small</ColumnAngleBasis>"
      "<RowAngleBasis>Small</RowAngleBasis><ScatteringData>\n{}</ScatteringData></WavelengthDataBlock></"
      "WavelengthData>",
      direction, values);
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

TEST(Klems, SaysWhatIsWrong) {
  const std::string good = matrix("Reflection Front", kValues);
  EXPECT_THAT(klems_error("<WindowElement>"), HasSubstr("well-formed XML"));
  EXPECT_THAT(klems_error("<WindowElement/>"), HasSubstr("Layer"));
  EXPECT_THAT(klems_error(window(kBasis, good, "TensorTree3")), HasSubstr("Columns"));
  EXPECT_THAT(klems_error(window(kBasis, matrix("Reflection Back", kValues))),
              HasSubstr("'Reflection Front', found 'Reflection Back'"));
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
