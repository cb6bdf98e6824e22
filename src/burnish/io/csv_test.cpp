// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/csv.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pointwise;

std::string csv_error(std::string_view text) {
  return error_of([&] { parse_csv(memory_file(text), {}); });
}

TEST(Csv, ReadsEveryNamingOfTheDirections) {
  const std::vector<std::string> texts = {
      "# isotropic\ntheta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,60,180,1,2,3\n",
      "# "
      "isotropic\nb,g,r,theta_o_rad,phi_o_rad,theta_i_rad,phi_i_rad\n3,2,1,1.0471975511965976,3."
      "141592653589793,0.5235987755982988,0\n",
      fmt::format("# isotropic\r\nwi_x, wi_y, wi_z, wo_x, wo_y, wo_z, R, G, B\r\n0.5,0,{},{},0,0.5,1,2,3\r\n",
                  std::cos(kPi / 6), -std::sin(kPi / 3))};
  for (const std::string& text : texts) {
    EXPECT_TRUE(looks_like_csv(text));
    const SampleFile file = parse_csv(memory_file(text), {});
    ASSERT_EQ(file.samples.size(), 1u);
    EXPECT_NEAR(length(file.samples.pairs[0].wi - spherical_direction(kPi / 6, 0)), 0, 1e-12);
    EXPECT_NEAR(length(file.samples.pairs[0].wo - spherical_direction(kPi / 3, kPi)), 0, 1e-12);
    EXPECT_EQ(file.samples.values, (std::vector<double>{1, 2, 3}));
    EXPECT_TRUE(file.samples.isotropic);
  }
}

TEST(Csv, ReadsGreyAndSpectralValues) {
  const auto grey = parse_csv(memory_file("theta_i,phi_i,theta_o,phi_o,value\n0,0,0,0,0.5\n"), {});
  EXPECT_EQ(grey.samples.channels, 1);
  OpenOptions options;
  options.keep_spectral = true;
  const auto spectral =
      parse_csv(memory_file("theta_i,phi_i,theta_o,phi_o,value_400,value_510.5\n0,0,0,0,0.5,0.6\n"), options);
  EXPECT_EQ(spectral.samples.channels, 2);
  EXPECT_EQ(spectral.findings.lambda_nm, (std::vector<double>{400, 510.5}));
}

TEST(Csv, DividesTheCosineOutOnRequest) {
  OpenOptions options;
  options.has_cosine = true;
  const auto file = parse_csv(memory_file("theta_i,phi_i,theta_o,phi_o,value\n60,0,0,0,1\n"), options);
  EXPECT_NEAR(file.samples.values[0], 2, 1e-12);
}

TEST(Csv, TakesIsotropyFromTheTagOrTheAzimuths) {
  const auto isotropic = [](std::string_view text) {
    return parse_csv(memory_file(text), {}).samples.isotropic;
  };
  const std::string header = "theta_i,phi_i,theta_o,phi_o,value\n";
  EXPECT_TRUE(isotropic(header + "10,20,30,40,1\n10,20,50,60,1\n"));
  EXPECT_TRUE(isotropic(header + "10,0,30,40,1\n10,360,50,60,1\n"));
  EXPECT_FALSE(isotropic(header + "10,20,30,40,1\n10,25,50,60,1\n"));
  EXPECT_TRUE(isotropic("# Isotropic\n" + header + "10,20,30,40,1\n10,25,50,60,1\n"));
  EXPECT_FALSE(isotropic("# anisotropic\n" + header + "10,20,30,40,1\n10,20,50,60,1\n"));
}

TEST(Csv, SaysWhatIsWrong) {
  const std::string header = "theta_i,phi_i,theta_o,phi_o,value\n";
  EXPECT_THAT(csv_error("theta_i,phi_i,theta_o,value\n1,2,3,4\n"), HasSubstr("a column phi_o"));
  EXPECT_THAT(csv_error("theta_i,phi_i,theta_o,phi_o\n1,2,3,4\n"), HasSubstr("columns r, g, b or value"));
  EXPECT_THAT(csv_error("theta_i,phi_i,theta_o,phi_o,value,Value\n1,2,3,4,5,6\n"),
              HasSubstr("line 1: expected one column 'value', found 'Value' too"));
  EXPECT_THAT(csv_error(header + "1,2,3,4\n"), HasSubstr("line 2: expected 5 columns, found 4"));
  EXPECT_THAT(csv_error(header + "1,2,3,4,5,6\n"), HasSubstr("line 2: expected 5 columns, found 6"));
  EXPECT_THAT(csv_error(header + "1,2,x,4,5\n"), HasSubstr("a finite number for 'theta_o', found 'x'"));
  EXPECT_THAT(csv_error("theta_i;phi_i;theta_o;phi_o;value\n1,5;2;3.5;4;5\n"),
              HasSubstr("one decimal mark, for the column 'theta_o'"));
  EXPECT_THAT(csv_error("theta_i (grad),phi_i,theta_o,phi_o,value\n"), HasSubstr("degrees or radians"));
  EXPECT_THAT(csv_error("theta_i,phi_i,theta_o,phi_o,brdf_cos\n"), HasSubstr("the cosine of theta_i or of"));
  EXPECT_THAT(csv_error(header + "1,2,3,4,inf\n"), HasSubstr("finite"));
  EXPECT_THAT(csv_error(header + "1,2,3,4,1e999\n"), HasSubstr("finite"));
  EXPECT_THAT(csv_error(header + "95,2,3,4,1\n"), HasSubstr("above the horizon"));
  EXPECT_THAT(csv_error("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value\n0,0,2,0,0,1,1\n"), HasSubstr("unit vector"));
  EXPECT_THAT(csv_error(header), HasSubstr("at least one measurement"));
  EXPECT_THAT(csv_error("# nothing\n"), HasSubstr("header"));
}

// A form in which programs and countries write one table. Forms differ in separators, decimals, quotes, ends of
// lines, names, units, wavelengths, order, remarks and columns of one's own.
struct Dialect {
  char separator = ',';
  bool decimal_comma = false, quotes = false, upper = false, reversed = false, commented = false;
  std::string end = "\n", preamble, unit;
  std::array<std::string, 4> angles = {"theta_i", "phi_i", "theta_o", "phi_o"};
  std::string value = "value_{}";
  bool extra = false;
  std::string wavelength;  ///< name of a column of wavelengths, if a row has one wavelength
  double of_nm = 1;        ///< the unit of that column in nanometres
};

std::string in_dialect(const Dialect& d, const Samples& samples, std::span<const double> lambda_nm) {
  const auto cell = [&](std::string text, bool number) {
    if (number && d.decimal_comma) std::replace(text.begin(), text.end(), '.', ',');
    return d.quotes ? '"' + text + '"' : text;
  };
  const auto row = [&](std::vector<std::string> cells) {
    if (d.reversed) std::reverse(cells.begin(), cells.end());
    return fmt::format("{}{}", fmt::join(cells, std::string(1, d.separator)), d.end);
  };
  std::vector<std::string> names;
  for (const std::string& angle : d.angles) names.push_back(angle + d.unit);
  if (d.wavelength.empty())
    for (const double lambda : lambda_nm) names.push_back(fmt::format(fmt::runtime(d.value), lambda));
  else
    names.insert(names.end(), {d.wavelength, d.value});
  if (d.extra) names.push_back("operator");
  for (std::string& name : names) {
    if (d.upper)
      std::transform(name.begin(), name.end(), name.begin(),
                     [](char c) { return c >= 'a' && c <= 'z' ? c - 32 : c; });
    name = cell(name, false);
  }
  std::string text = d.preamble + (d.commented ? "# " : "") + row(names);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [wi, wo] = samples.pairs[i];
    std::vector<std::string> cells;
    for (const double angle : {theta_of(wi), phi_of(wi), theta_of(wo), phi_of(wo)})
      cells.push_back(cell(fmt::format("{}", degrees(angle)), true));
    const auto values = samples.at(i);
    if (!d.wavelength.empty()) {
      for (std::size_t c = 0; c < values.size(); ++c) {
        std::vector<std::string> band = cells;
        for (const double number : {lambda_nm[c] * d.of_nm, values[c]})
          band.push_back(cell(fmt::format("{}", number), true));
        text += row(band);
      }
      continue;
    }
    for (const double value : values) cells.push_back(cell(fmt::format("{}", value), true));
    if (d.extra) cells.push_back(cell("Jane", false));
    text += row(cells);
  }
  return text;
}

std::vector<Dialect> dialects() {
  std::vector<Dialect> all;
  for (const char separator : {',', ';', '\t', ' '})
    for (const bool decimal_comma : {false, true})
      for (const bool quotes : {false, true})
        if (!(separator == ',' && decimal_comma && !quotes))
          all.push_back({.separator = separator, .decimal_comma = decimal_comma, .quotes = quotes});
  for (const char* end : {"\r\n", "\r"})
    for (const char separator : {',', ';'}) all.push_back({.separator = separator, .end = end});
  for (const std::array<std::string, 4>& angles : std::initializer_list<std::array<std::string, 4>>{
           {"theta_i", "phi_i", "theta_r", "phi_r"},
           {"theta_i", "phi_i", "theta_s", "phi_s"},
           {"theta_s", "phi_s", "theta_v", "phi_v"},
           {"theta_i", "phi_i", "theta_v", "phi_v"},
           {"Theta i", "Phi i", "Theta r", "Phi r"},
           {"thetai", "phii", "thetao", "phio"},
           {"theta_in", "phi_in", "theta_out", "phi_out"},
           {"src_z", "src_a", "view_z", "view_a"},
           {"incident_zenith", "incident_azimuth", "reflected_zenith", "reflected_azimuth"},
           {"SZA", "SAA", "VZA", "VAA"},
           {"Incident Angle", "Incident Azimuth", "Scatter Angle", "Scatter Azimuth"},
           {"\xce\xb8i", "\xcf\x86i", "\xce\xb8r", "\xcf\x86r"}})
    all.push_back({.separator = ';', .angles = angles});
  for (const char* unit : {" [deg]", " (degrees)", "_deg", " (\xc2\xb0)"})
    all.push_back({.separator = '\t', .unit = unit});
  for (const char* value : {"{}nm", "{}", "{} nm", "BRDF_{}", "brdf_{}nm", "lambda_{}", "{} [nm]"})
    all.push_back({.separator = ';', .value = value});
  all.push_back({.upper = true});
  all.push_back({.reversed = true});
  all.push_back({.commented = true});
  all.push_back({.preamble = "\xef\xbb\xbf"});
  all.push_back(
      {.separator = '\t', .preamble = "Sample panel 7\nmeasured on Monday, 12.5 degrees outside\n\n"});
  all.push_back({.extra = true});
  for (const auto& [name, of_nm] :
       {std::pair{"wavelength", 1.0}, std::pair{"Wavelength (nm)", 1.0}, std::pair{"lambda_nm", 1.0},
        std::pair{"\xce\xbb [\xc2\xb5m]", 1e-3}, std::pair{"wl", 1e-3}, std::pair{"wavelength_um", 1e-3}})
    all.push_back(
        {.separator = ';', .decimal_comma = true, .value = "BRDF", .wavelength = name, .of_nm = of_nm});
  all.push_back({.reversed = true, .value = "value", .wavelength = "lambda"});
  return all;
}

TEST(Csv, ReadsTheSameOfEveryDialect) {
  const std::array lambda{450.0, 550.5, 650.0};
  Samples samples{3, false, draw_pairs(20, 3, false), {}};
  for (std::size_t i = 0; i < 60; ++i) samples.values.push_back(0.1 + 0.01 * static_cast<double>(i));
  const std::vector<Dialect> all = dialects();
  EXPECT_GE(all.size(), 40u);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::string text = in_dialect(all[k], samples, lambda);
    SCOPED_TRACE(fmt::format("dialect {}: {}", k, text.substr(0, 160)));
    EXPECT_TRUE(looks_like_csv(text));
    SampleFile file;
    ASSERT_NO_THROW(file = parse_csv(memory_file(text), {.keep_spectral = true}));
    ASSERT_EQ(file.samples.size(), samples.size());
    EXPECT_EQ(file.samples.values, samples.values);
    EXPECT_THAT(file.findings.lambda_nm, Pointwise(testing::DoubleNear(1e-9), lambda));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      EXPECT_NEAR(length(file.samples.pairs[i].wi - samples.pairs[i].wi), 0, 1e-12);
      EXPECT_NEAR(length(file.samples.pairs[i].wo - samples.pairs[i].wo), 0, 1e-12);
    }
    EXPECT_EQ(file.findings.warnings.size(), all[k].extra ? 1u : 0u);
  }
}

// A comment of Cornell's files describes their rows, which are no table of columns.
TEST(Csv, TakesNoCommentForAHeaderThatItsRowsDoNotFit) {
  EXPECT_FALSE(
      looks_like_csv("# theta i, phi i, theta s, phi_s, spectrum\n2\n400 500\n0.5 0 0.25 3.14 0.1 0.2\n"));
  EXPECT_TRUE(looks_like_csv("# theta_i theta_o value\n30 40 0.1\n"));
}

TEST(Csv, MakesSpectraOfRowsOfOneWavelength) {
  const std::string header = "theta_i,phi_i,theta_o,phi_o,wavelength,value\n";
  // Rows come in any order; a direction that lacks a wavelength is left out.
  const SampleFile file = parse_csv(
      memory_file(header +
                  "10,0,20,0,650,3\n10,0,20,0,450,1\n30,0,20,0,450,5\n10,0,40,0,450,7\n10,0,40,0,650,8\n"),
      {.keep_spectral = true});
  EXPECT_EQ(file.samples.values, (std::vector<double>{1, 3, 7, 8}));
  EXPECT_EQ(file.findings.lambda_nm, (std::vector<double>{450, 650}));
  EXPECT_THAT(file.findings.warnings,
              ElementsAre("1 direction without a value at every wavelength was left out."));
  EXPECT_THAT(csv_error(header + "10,0,20,0,450,1\n10,0,20,0,450,2\n"),
              HasSubstr("line 3: expected one value for each direction and wavelength"));
  EXPECT_THAT(csv_error(header + "10,0,20,0,0,1\n"), HasSubstr("a wavelength above 0"));
  EXPECT_THAT(csv_error("theta_i,phi_i,theta_o,phi_o,wavelength,r,g,b\n10,0,20,0,450,1,2,3\n"),
              HasSubstr("expected one column of values beside 'wavelength', found 3"));
}

TEST(Csv, TellsWhatValuesAreByNameOrOption) {
  // f_r is 0.5 at theta_i 60 and theta_o 30 degrees.
  const auto f = [](std::string_view name, double value, const OpenOptions& options = {}) {
    const auto file = parse_csv(
        memory_file(fmt::format("theta_i,phi_i,theta_o,phi_o,{}\n60,0,30,90,{}\n", name, value)), options);
    return file.samples.values[0];
  };
  const double cos_i = 0.5, cos_o = std::cos(radians(30));
  for (const char* name : {"value", "BRDF", "f_r", "fr", "f", "BSDF [1/sr]", "brdf (sr^-1)"})
    EXPECT_NEAR(f(name, 0.5), 0.5, 1e-12) << name;
  for (const char* name : {"BRF", "reflectance factor", "radiance_factor"})
    EXPECT_NEAR(f(name, 0.5 * kPi), 0.5, 1e-12) << name;
  for (const char* name :
       {"CCBRDF", "ccbsdf", "brdf_cos_theta_o", "BRDF*cos(theta_r)", "f_cos_theta_s", "BRDF cos theta_v"})
    EXPECT_NEAR(f(name, 0.5 * cos_o), 0.5, 1e-12) << name;
  for (const char* name : {"brdf_cos_theta_i", "f_r cos theta_i", "value*cos(theta_i)"})
    EXPECT_NEAR(f(name, 0.5 * cos_i), 0.5, 1e-12) << name;
  EXPECT_NEAR(f("value", 0.5 * kPi, {.brf = true}), 0.5, 1e-12);
  EXPECT_NEAR(f("BRF", 0.5 * kPi, {.brf = true}), 0.5, 1e-12);
  EXPECT_NEAR(f("value", 0.5 * cos_o, {.has_cosine_o = true}), 0.5, 1e-12);
  EXPECT_NEAR(f("value", 0.5 * cos_i, {.has_cosine = true}), 0.5, 1e-12);
  EXPECT_THROW(f("value", 1, {.has_cosine = true, .brf = true}), Error);
  // If several columns hold values, f_r itself is read and the other columns are named.
  const auto both =
      parse_csv(memory_file("theta_i,phi_i,theta_o,phi_o,CCBRDF,BRDF,BRF\n60,0,30,90,1,2,3\n"), {});
  EXPECT_EQ(both.samples.values, std::vector<double>{2});
  EXPECT_THAT(both.findings.warnings, ElementsAre("Columns passed over: 'CCBRDF', 'BRF'."));
}

// A field goniometer's table begins with two lines of remarks, which state the kind of the values.
TEST(Csv, ReadsTablesOfReflectanceFactorsByTheirRemarks) {
  const std::string text =
      "BRF Values\nsample panel\nsrc_z\tsrc_a\tview_z\tview_a\t450.00nm\t550.00nm\t650.00nm\n"
      "30.000\t0.000\t0.000\t0.000\t0.500000\t0.400000\t0.300000\n"
      "30.000\t0.000\t30.000\t90.000\t0.500000\t0.400000\t0.300000\n";
  EXPECT_TRUE(looks_like_csv(text));
  const SampleFile file = parse_csv(memory_file(text), {.keep_spectral = true});
  EXPECT_THAT(file.samples.values, Pointwise(DoubleNear(1e-15), {0.5 / kPi, 0.4 / kPi, 0.3 / kPi, 0.5 / kPi,
                                                                 0.4 / kPi, 0.3 / kPi}));
  EXPECT_EQ(file.findings.description, "BRF Values, sample panel");
  EXPECT_THAT(file.findings.conventions,
              Contains(HasSubstr("reflectance factors, as the file's first lines say")));
}

TEST(Csv, LeavesOutRowsWithoutAValueAndNamesColumnsItPassesOver) {
  const SampleFile file = parse_csv(memory_file("theta_i,phi_i,theta_o,phi_o,value,weight,note\n10,0,20,0,1,"
                                                "2,\"a, b\"\n10,0,30,0,nan,2,c\n10,0,40,0,,2,\n"),
                                    {});
  EXPECT_EQ(file.samples.values, std::vector<double>{1});
  EXPECT_THAT(file.findings.warnings,
              ElementsAre("Columns passed over: 'weight', 'note'.", "2 rows without a value were left out."));
  // A value at the horizon cannot be divided by its cosine.
  const SampleFile grazing =
      parse_csv(memory_file("theta_i,phi_i,theta_o,phi_o,CCBRDF\n10,0,90,0,0.1\n10,0,60,0,0.1\n"), {});
  EXPECT_THAT(grazing.samples.values, ElementsAre(DoubleNear(0.2, 1e-12)));
  EXPECT_THAT(grazing.findings.warnings, ElementsAre(HasSubstr("1 rows on the horizon")));
}

/// Returns a table of theta_i 30 and 60 degrees with a peak at `peak` times theta_i in the plane of incidence.
std::string plane(double peak) {
  std::string text = "theta_i,theta_o,value\n";
  for (const int theta_i : {30, 60})
    for (int theta_o = -80; theta_o <= 80; theta_o += 5)
      text +=
          fmt::format("{},{},{}\n", theta_i, theta_o, 0.1 + (std::abs(theta_o - peak * theta_i) < 1 ? 5 : 0));
  return text;
}

TEST(Csv, FindsTheMirrorDirectionOfSignedAnglesByTheirPeak) {
  for (const double peak : {1.0, -1.0}) {
    const SampleFile file = parse_csv(memory_file(plane(peak)), {});
    EXPECT_TRUE(file.samples.isotropic);
    EXPECT_THAT(file.findings.warnings, ElementsAre(HasSubstr("In the plane of incidence only")));
    std::size_t peaks = 0;
    for (std::size_t i = 0; i < file.samples.size(); ++i) {
      if (file.samples.values[i] < 1) continue;
      EXPECT_NEAR(length(file.samples.pairs[i].wo - mirror(file.samples.pairs[i].wi)), 0, 1e-12);
      ++peaks;
    }
    EXPECT_EQ(peaks, 2u);
    EXPECT_THAT(file.findings.conventions,
                Contains(HasSubstr(peak > 0 ? "theta_o = theta_i, where" : "theta_o = -theta_i")));
  }
  // Without a peak, angles count alike on both sides of the normal.
  const SampleFile flat = parse_csv(memory_file("theta_i,theta_o,value\n30,-30,1\n30,30,1\n"), {});
  EXPECT_NEAR(length(flat.samples.pairs[0].wo - mirror(flat.samples.pairs[0].wi)), 0, 1e-12);
}

TEST(Csv, TakesAnAzimuthBetweenTheDirections) {
  for (const char* names :
       {"theta_i,theta_o,phi", "theta_i,theta_r,relative azimuth", "SZA,VZA,RAA", "theta_i,theta_o,phi_o"}) {
    const SampleFile file =
        parse_csv(memory_file(fmt::format("{},value\n30,40,150,1\n50,40,10,1\n", names)), {});
    EXPECT_TRUE(file.samples.isotropic) << names;
    EXPECT_NEAR(length(file.samples.pairs[0].wo - spherical_direction(radians(40), radians(150))), 0, 1e-12)
        << names;
  }
}

TEST(Csv, SuspectsRadiansAndAzimuthsThatAreCountedOtherwise) {
  const auto warnings = [](const std::string& text) {
    return parse_csv(memory_file(text), {}).findings.warnings;
  };
  const std::string header = "theta_i,phi_i,theta_o,phi_o,value\n";
  EXPECT_THAT(warnings(header + "0.5,0,0.6,3.14,1\n"),
              ElementsAre(HasSubstr("radians have names such as theta_i_rad")));
  EXPECT_THAT(warnings(header + "0.5,0,3.3,3.14,1\n"), IsEmpty());
  EXPECT_THAT(warnings("theta_i (deg),phi_i,theta_o,phi_o,value\n0.5,0,0.6,3.14,1\n"), IsEmpty());
  // One peak lies at phi_o = phi_i, and one in the mirror direction.
  const auto peak_at = [&](int phi) {
    std::string text = header;
    for (const int theta_i : {20, 40, 60})
      for (int theta_o = 0; theta_o <= 80; theta_o += 10)
        for (const int phi_o : {0, 90, 180, 270})
          text += fmt::format("{},0,{},{},{}\n", theta_i, theta_o, phi_o,
                              phi_o == phi && theta_o == theta_i ? 3 : 0.2);
    return text;
  };
  EXPECT_THAT(warnings(peak_at(0)), ElementsAre(HasSubstr("phi_o = phi_i")));
  EXPECT_THAT(warnings(peak_at(180)), IsEmpty());
  EXPECT_THAT(warnings(peak_at(90)), IsEmpty());
}

TEST(Csv, RoundTripsSamplesToTheLastBit) {
  for (const std::size_t channels : {1, 3, 5}) {
    Samples samples{channels, channels == 3, draw_pairs(200, 9, false), {}};
    for (std::size_t i = 0; i < samples.size() * channels; ++i)
      samples.values.push_back(std::exp(std::sin(static_cast<double>(i))));
    const std::vector<double> lambda =
        channels == 5 ? std::vector<double>{400, 450, 500, 550, 600.5} : std::vector<double>{};
    OpenOptions options;
    options.keep_spectral = true;
    const SampleFile back = parse_csv(memory_file(samples_csv(samples, lambda)), options);
    EXPECT_EQ(back.samples.pairs, samples.pairs);
    EXPECT_EQ(back.samples.values, samples.values);
    EXPECT_EQ(back.samples.isotropic, samples.isotropic);
    EXPECT_EQ(back.findings.lambda_nm, lambda);
  }
  EXPECT_THROW(samples_csv(Samples{2, true, {{}}, {1, 2}}), Error);
}

TEST(TexelCsv, HasWhatTheColumnsSay) {
  const TexelCsv read = parse_texel_csv(memory_file(seeds::kTexelCsv), 10);
  EXPECT_EQ(read.texels, (std::vector<std::array<int, 2>>{{0, 0}, {1, 0}, {1, 0}}));
  EXPECT_EQ(read.held_out, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(read.pairs[1], (DirectionPair{{0, 0.6, 0.8}, {0, 0, 1}}));
  EXPECT_EQ(read.f[2], (std::array<float, 3>{4, 5, 6}));
  // This file has degrees, one channel and columns in another order.
  const TexelCsv grey =
      parse_texel_csv(memory_file("value,theta_i,phi_i,theta_o,phi_o,texel_y,texel_x\n2,60,0,0,0,7,3\n"), 7);
  EXPECT_EQ(grey.texels, (std::vector<std::array<int, 2>>{{3, 7}}));
  EXPECT_TRUE(grey.held_out.empty());
  EXPECT_NEAR(grey.pairs[0].wi.z, 0.5, 1e-12);
  EXPECT_EQ(grey.f[0], (std::array<float, 3>{2, 2, 2}));
}

TEST(TexelCsv, RefusesWhatCannotBe) {
  const std::string head = "texel_x,texel_y,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value\n";
  EXPECT_NO_THROW(parse_texel_csv(memory_file(head + "5,0,0,0,1,0,0,1,1\n"), 5));
  for (const char* row :
       {"6,0,0,0,1,0,0,1,1", "0,-1,0,0,1,0,0,1,1", "0.5,0,0,0,1,0,0,1,1", "0,0,0,0,-1,0,0,1,1",
        "0,0,0,0,1,0,0,2,1", "0,0,0,0,1,0,0,1,nan", "0,0,0,0,1,0,0,1,1e300", "0,0,0,0,1,0,0,1"})
    EXPECT_THROW(parse_texel_csv(memory_file(head + row + "\n"), 5), Error) << row;
  for (const char* columns :
       {"texel_x,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value", "texel_x,texel_y,wi_x,wi_y,wi_z,value",
        "texel_x,texel_y,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value_400",
        "texel_x,texel_y,texel_z,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value"})
    EXPECT_THROW(parse_texel_csv(memory_file(std::string(columns) + "\n"), 5), Error) << columns;
  EXPECT_THROW(parse_csv(memory_file(seeds::kTexelCsv), {}), Error);
}

TEST(Directions, AreReadInEitherHalfSpace) {
  const auto pairs =
      parse_directions(memory_file("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,-1,1,0,0\n0,0.6,0.8,0,0,1\n")).pairs;
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (DirectionPair{{0, 0, -1}, {1, 0, 0}}));
  EXPECT_EQ(pairs[1].wi, (Vec3{0, 0.6, 0.8}));
  EXPECT_THROW(parse_directions(memory_file("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r\n0,0,1,0,0,1,1\n")), Error);
  EXPECT_THROW(parse_directions(memory_file("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,0,0,0,1\n")), Error);
}

TEST(Directions, KeepTheirColumnsAsTheFileHasThem) {
  const DirectionTable table =
      parse_directions(memory_file("Theta_r [deg];phi_r;theta_i;phi_i\n30,5;180;10;270\n0;0;1e1;-90\n"));
  EXPECT_EQ(table.names, (std::vector<std::string>{"Theta_r [deg]", "phi_r", "theta_i", "phi_i"}));
  EXPECT_EQ(table.numbers, (std::vector<double>{30.5, 180, 10, 270, 0, 0, 10, -90}));
  EXPECT_NEAR(table.pairs[0].wo.x, -std::sin(radians(30.5)), 1e-15);
  EXPECT_NEAR(table.pairs[1].wi.y, -std::sin(radians(10)), 1e-15);
}

}  // namespace
}  // namespace burnish
