// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <burnish/io/convert.h>
#include <burnish/io/np.h>
#include <burnish/io/open_source.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/testing/files.h>
#include <burnish/testing/np_model.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kCodes = seeds::kNpCode + "paint_rgb,1,2,3,4,5,6,7\n";

std::string decoder_bytes() {
  const std::vector<float> weights = random_np_weights(1);
  return {reinterpret_cast<const char*>(weights.data()), NpDecoder::bytes()};
}

TEST(Np, FindsTheNamedRow) {
  const auto decoder = random_np_decoder(1);
  const NpFile paint = parse_np(memory_file(kCodes), "paint_rgb", decoder);
  EXPECT_EQ(paint.name, "paint_rgb");
  EXPECT_EQ(paint.brdf.code(), (NpBrdf::Code{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(paint.brdf.value(), NpBrdf::Value::with_cosine);
  const NpFile seed = parse_np(memory_file(seeds::kNpCode), {}, decoder);
  EXPECT_EQ(seed.name, "seed");
  EXPECT_EQ(seed.brdf.value(), NpBrdf::Value::reflectance);
}

TEST(Np, SaysWhatIsWrongWithCodes) {
  const auto decoder = random_np_decoder(1);
  const auto error = [&](const std::string& text, std::string_view name) {
    return error_of([&] { parse_np(memory_file(text), name, decoder); });
  };
  EXPECT_THAT(error(kCodes, ""), HasSubstr("np:FILE#NAME, found seed, paint_rgb"));
  EXPECT_THAT(error(kCodes, "c"), HasSubstr("'c', found seed, paint_rgb"));
  EXPECT_THAT(error("", "a"), HasSubstr("no row"));
  EXPECT_THAT(error("a,1,2,3\n", "a"), HasSubstr("number 4"));
  EXPECT_THAT(error("a,1,2,3,4,5,6,nan\n", "a"), HasSubstr("number 7"));
  EXPECT_THAT(error("a,1,2,3,4,5,6,1e9\n", "a"), HasSubstr("test.file: code: number 7"));
  EXPECT_THAT(error("a,1,2,3,4,5,6,7,8\n", "a"), HasSubstr("end of the line"));
}

TEST(Np, EveryDamagedCodeThrowsClearlyOrIsAnother) {
  const auto decoder = random_np_decoder(1);
  std::size_t thrown = 0;
  for (std::size_t at = 0; at < seeds::kNpCode.size(); ++at)
    for (const char damage : {'\0', '\xff', '-', ',', 'n', '\n'}) {
      std::string damaged = seeds::kNpCode;
      damaged[at] = damage;
      const std::string message = error_of([&] { parse_np(memory_file(damaged), {}, decoder); });
      thrown += !message.empty();
      EXPECT_TRUE(message.empty() || message.find("expected") != message.npos) << message;
    }
  EXPECT_GT(thrown, seeds::kNpCode.size());
}

TEST(Np, RefusesDecodersOfAnotherSizeOrWithoutNumbers) {
  std::string bytes = decoder_bytes();
  EXPECT_NO_THROW(parse_np_decoder(memory_file(bytes)));
  for (const std::size_t size : {std::size_t{0}, std::size_t{4}, bytes.size() - 4})
    EXPECT_THAT(error_of([&] { parse_np_decoder(memory_file(bytes.substr(0, size))); }),
                HasSubstr(fmt::format(
                    "test.file: expected 3232012 bytes, 808003 weights of a decoder, found {}", size)));
  bytes[4 * 99 + 2] = bytes[4 * 99 + 3] = '\x7f';
  EXPECT_THAT(error_of([&] { parse_np_decoder(memory_file(bytes)); }),
              HasSubstr("test.file: decoder: weight 100"));
}

TEST(Np, OpensAFolderOrAFileOfIt) {
  const fs::path folder = fs::path(testing::TempDir()) / fmt::format("burnish_np_{}", ::getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "codes.csv") << kCodes;
  EXPECT_THAT(error_of([&] { open_source("np:" + folder.string() + "#seed", {}); }),
              HasSubstr("decoder.f32"));
  std::ofstream(folder / "decoder.f32", std::ios::binary) << decoder_bytes();
  for (const std::string& place : {folder.string(), (folder / "codes.csv").string()}) {
    const Source source = open_source("np:" + place + "#paint_rgb", {});
    EXPECT_EQ(source.bytes(), 28u);
    EXPECT_THAT(source.findings.conventions,
                testing::Contains(HasSubstr("808003 weights that all materials share")));
  }
  EXPECT_THAT(error_of([&] { open_source((folder / "codes.csv").string(), {}); }), HasSubstr("np:FILE#NAME"));
  fs::remove_all(folder);
}

TEST(Np, BecomesAMerlTableOfItsOwnValues) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source{"seed", parse_np(memory_file(kCodes), "seed", random_np_decoder(1)).brdf, {}};
  const Converted made = convert(source, "merl", {.cells = 6});
  const Source back = parse_source(memory_file(made.bytes), {});
  const auto& table = std::get<HalfDiffTable>(back.brdf);
  std::vector<double> f(3);
  for (int h = 0; h < 6; ++h)
    for (int d = 0; d < 6; ++d)
      for (int p = 0; p < 12; ++p) {
        if (!table.above_horizon(h, d, p)) continue;
        const auto [wi, wo] = from_half_diff(table.centre(h, d, p));
        source.ref().eval(wi, wo, f);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(table.values[table.offset(h, d, p) + c], f[c], 1e-6 * (1 + f[c]));
      }
}

TEST(Np, EncodingsOfMeasuredMaterialsMeetThem) {
  BURNISH_SKIP_WHERE_SANITIZED();
  BURNISH_NEEDS_DATA();
  for (const std::string name : {"aurora_white_rgb", "acrylic_felt_green_rgb"}) {
    const Source measured = open_source((data_folder() / "rgl" / (name + ".bsdf")).string(), {});
    const Source np = open_source("np:" + (data_folder() / "np").string() + "#" + name, {});
    const SymmetrizedBrdf reference(measured.ref());
    const ErrorFigures figures = error_figures(reference, np.ref(), {.count = 2000, .image_size = 32});
    EXPECT_LT(figures.relative, 0.3) << name;
    EXPECT_LT(figures.log_cos, 0.01) << name;
  }
}

}  // namespace
}  // namespace burnish
