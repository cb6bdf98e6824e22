#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/csv.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::HasSubstr;

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
  EXPECT_THAT(csv_error("theta_i,phi_i,theta_o,phi_o,value,weight\n1,2,3,4,5,6\n"), HasSubstr("unknown"));
  EXPECT_THAT(csv_error(header + "1,2,3,4\n"), HasSubstr("line 2: expected a finite number"));
  EXPECT_THAT(csv_error(header + "1,2,3,4,5,6\n"), HasSubstr("end of the line"));
  EXPECT_THAT(csv_error(header + "1,2,3,4,inf\n"), HasSubstr("finite"));
  EXPECT_THAT(csv_error(header + "1,2,3,4,1e999\n"), HasSubstr("finite"));
  EXPECT_THAT(csv_error(header + "95,2,3,4,1\n"), HasSubstr("above the horizon"));
  EXPECT_THAT(csv_error("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,value\n0,0,2,0,0,1,1\n"), HasSubstr("unit vector"));
  EXPECT_THAT(csv_error(header), HasSubstr("at least one measurement"));
  EXPECT_THAT(csv_error("# nothing\n"), HasSubstr("header"));
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
  // degrees, one channel, any order of columns
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
      parse_directions(memory_file("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,-1,1,0,0\n0,0.6,0.8,0,0,1\n"));
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (DirectionPair{{0, 0, -1}, {1, 0, 0}}));
  EXPECT_EQ(pairs[1].wi, (Vec3{0, 0.6, 0.8}));
  EXPECT_THROW(parse_directions(memory_file("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r\n0,0,1,0,0,1,1\n")), Error);
  EXPECT_THROW(parse_directions(memory_file("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,0,0,0,1\n")), Error);
}

}  // namespace
}  // namespace burnish
