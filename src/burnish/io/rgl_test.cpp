// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/io/rgl.h>
#include <burnish/io/tensor_file.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/math/spectrum.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/testing/directions.h>
#include <burnish/testing/files.h>

namespace burnish {
namespace {

const std::vector<double> kBands{420, 500, 580, 700};

/// A smooth lobe, wider across than along, whose channels differ.
struct RglLobe {
  std::size_t count;
  bool brushed;

  std::size_t channels() const noexcept { return count; }
  bool isotropic() const noexcept { return !brushed; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const Vec3 h = half_vector(wi, wo);
    const double spread = h.x * h.x + (brushed ? 3 : 1) * h.y * h.y;
    for (std::size_t c = 0; c < f.size(); ++c)
      f[c] = wi.z > 0 && wo.z > 0 ? std::exp(-3 * spread) * (0.3 + 0.1 * static_cast<double>(c)) : 0;
    return true;
  }
};
static_assert(Brdf<RglLobe>);

RglTable small_table(std::size_t channels, bool brushed) {
  RglOptions options;
  options.theta_i_count = 4;
  options.phi_i_count = 5;
  options.ndf_theta = options.ndf_phi = 16;
  options.resolution = 8;
  options.description = "a lobe";
  if (channels == 4) options.lambda_nm = kBands;
  return make_rgl_table(RglLobe{channels, brushed}, options);
}

RglFile parsed(std::string_view bytes, const OpenOptions& options = {}) {
  return parse_rgl(memory_file(bytes), options);
}

std::vector<double> values_of(const RglTable& table, std::uint64_t seed = 1) {
  Pcg32 random(seed);
  std::vector<double> all, f(table.channels());
  for (int i = 0; i < 300; ++i) {
    const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
    table.eval(wi, wo, f);
    all.insert(all.end(), f.begin(), f.end());
  }
  return all;
}

/// A field of a written table. Tests change fields before they write them again.
struct Field {
  TensorType type;
  std::vector<std::uint64_t> shape;
  std::vector<std::byte> data;

  void set_float(std::size_t i, float value) { std::memcpy(data.data() + 4 * i, &value, 4); }
};

class EditedFile {
 public:
  explicit EditedFile(const RglTable& table) {
    const FileBytes file = memory_file(format_rgl(table));
    for (const Tensor& t : parse_tensor_file(file))
      fields_.emplace_back(t.name, Field{t.type, t.shape, {t.data.begin(), t.data.end()}});
  }

  Field& operator[](std::string_view name) { return find(name)->second; }
  void remove(std::string_view name) { fields_.erase(find(name)); }
  void rename(std::string_view name, const std::string& to) { find(name)->first = to; }

  std::string bytes() const {
    std::vector<Tensor> tensors;
    for (const auto& [name, field] : fields_)
      tensors.push_back({name, field.type, field.shape, field.data, 0});
    return format_tensor_file(tensors);
  }

 private:
  std::vector<std::pair<std::string, Field>>::iterator find(std::string_view name) {
    const auto at = std::find_if(fields_.begin(), fields_.end(), [&](auto& f) { return f.first == name; });
    if (at == fields_.end()) throw std::out_of_range(std::string(name));
    return at;
  }
  std::vector<std::pair<std::string, Field>> fields_;
};

TEST(Rgl, RoundTripsIsotropicAndAnisotropicRgb) {
  for (bool brushed : {false, true}) {
    const RglTable table = small_table(3, brushed);
    const std::string bytes = format_rgl(table);
    EXPECT_TRUE(looks_like_rgl(std::as_bytes(std::span(bytes)).first(16)));
    const RglFile file = parsed(bytes);
    EXPECT_EQ(file.table.isotropic(), !brushed);
    EXPECT_EQ(file.findings.description, "a lobe");
    EXPECT_EQ(file.findings.negative_count, 0u);
    EXPECT_EQ(file.findings.sample_count, (brushed ? 5u : 1u) * 4 * 8 * 8);
    EXPECT_GT(file.findings.hole_count, 0u);  // directions below the horizon
    EXPECT_EQ(file.table.data().valid, table.data().valid);
    EXPECT_EQ(values_of(file.table), values_of(table));
    EXPECT_EQ(format_rgl(file.table), bytes);
  }
}

TEST(Rgl, TurnsAMaskThatStandsTheOtherWayRound) {
  const RglTable table = small_table(3, false);
  RglData data = table.data();
  for (std::uint8_t& byte : data.valid) byte = static_cast<std::uint8_t>(~byte);
  const RglFile right = parsed(format_rgl(table)), turned = parsed(format_rgl(RglTable(std::move(data))));
  ASSERT_LT(4 * right.findings.hole_count, right.findings.sample_count);
  EXPECT_EQ(turned.findings.hole_count, right.findings.hole_count);
  EXPECT_EQ(turned.table.data().valid, right.table.data().valid);
  EXPECT_EQ(turned.findings.conventions.size(), right.findings.conventions.size() + 1);
}

TEST(Rgl, RoundTripsSpectra) {
  for (bool brushed : {false, true}) {
    const RglTable table = small_table(4, brushed);
    OpenOptions options;
    options.keep_spectral = true;
    const RglFile file = parsed(format_rgl(table), options);
    EXPECT_EQ(file.table.channels(), 4);
    EXPECT_EQ(file.findings.lambda_nm, kBands);
    EXPECT_EQ(file.findings.illuminant, "");
    EXPECT_EQ(values_of(file.table), values_of(table));
  }
}

TEST(Rgl, SpectraBecomeRec709UnderTheChosenLight) {
  const RglTable table = small_table(4, true);
  const auto spectra = values_of(table);
  for (const char* light : {"E", "D65"}) {
    OpenOptions options;
    options.illuminant = light;
    const RglFile file = parsed(format_rgl(table), options);
    EXPECT_EQ(file.table.channels(), 3);
    EXPECT_TRUE(file.findings.lambda_nm.empty());
    EXPECT_EQ(file.findings.illuminant, light == std::string("E") ? "equal energy" : "D65");
    const auto weights = rec709_weights(kBands, light);
    const auto rgb = values_of(file.table);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      double expected = 0;
      for (std::size_t k = 0; k < 4; ++k) expected += weights[k][i % 3] * spectra[i / 3 * 4 + k];
      EXPECT_NEAR(rgb[i], expected, 1e-5 * (1 + expected));
    }
  }
  OpenOptions unknown;
  unknown.illuminant = "candle";
  EXPECT_THROW(parsed(format_rgl(table), unknown), Error);
}

TEST(Rgl, GreyTablesAreWrittenAsRgb) {
  const RglTable table = small_table(1, false);
  const auto grey = values_of(table), rgb = values_of(parsed(format_rgl(table)).table);
  ASSERT_EQ(rgb.size(), 3 * grey.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) EXPECT_EQ(rgb[i], grey[i / 3]);
}

TEST(Rgl, NegativeValuesAreCountedAndCutAfterInterpolation) {
  EditedFile edited(small_table(3, false));
  const std::size_t slice = 1, nodes = 8 * 8, red = slice * 3 * nodes;
  for (std::size_t i = 0; i < nodes; ++i) edited["rgb"].set_float(red + i, -0.25f);
  const RglFile file = parsed(edited.bytes());
  EXPECT_EQ(file.findings.negative_count, nodes);
  EXPECT_LT(file.findings.most_negative, 0);
  const Vec3 wi = spherical_direction(kHalfPi / 3, 0), wo = spherical_direction(0.4, 1);
  std::vector<double> cut(3), raw(3);
  file.table.eval(wi, wo, cut);
  file.table.eval_raw(wi, wo, raw);
  EXPECT_EQ(cut[0], 0);
  EXPECT_LT(raw[0], 0);
  EXPECT_GE(raw[0], file.findings.most_negative);
  EXPECT_EQ(cut[1], raw[1]);
}

TEST(Rgl, EveryTruncatedHeaderThrows) {
  const std::string bytes = format_rgl(small_table(3, false));
  const std::uint64_t header = parse_tensor_file(memory_file(bytes)).front().offset;
  for (std::size_t n = 0; n <= header; ++n) EXPECT_THROW(parsed(bytes.substr(0, n)), Error) << n;
  for (std::size_t n = header; n < bytes.size(); n += 101)
    EXPECT_THROW(parsed(bytes.substr(0, n)), Error) << n;
}

TEST(Rgl, MissingFieldsThrow) {
  for (const char* name : {"phi_i", "theta_i", "sigma", "ndf", "vndf", "luminance", "rgb", "jacobian"}) {
    EditedFile edited(small_table(3, false));
    edited.remove(name);
    EXPECT_THROW(parsed(edited.bytes()), Error) << name;
  }
  for (const char* name : {"version", "description", "valid"}) {
    EditedFile edited(small_table(3, false));
    edited.remove(name);
    EXPECT_NO_THROW(parsed(edited.bytes())) << name;
  }
  for (const char* name : {"wavelengths", "spectra"}) {
    EditedFile edited(small_table(4, false));
    edited.remove(name);
    EXPECT_THROW(parsed(edited.bytes()), Error) << name;
  }
}

// A change of a file, and a phrase of the message that it causes.
struct BadField {
  std::function<void(EditedFile&)> change;
  const char* what;
};

void expect_errors(std::span<const BadField> cases) {
  for (const auto& [change, what] : cases) {
    EditedFile edited(small_table(3, true));
    change(edited);
    const std::string message = error_of([&bytes = edited] { parsed(bytes.bytes()); });
    EXPECT_NE(message.find(what), std::string::npos) << what << ": " << message;
  }
}

TEST(Rgl, WrongTypesAndShapesThrow) {
  using enum TensorType;
  const auto type = [](const char* name, TensorType value) {
    return [=](EditedFile& f) { f[name].type = value; };
  };
  const auto shape = [](const char* name, std::vector<std::uint64_t> value) {
    return [=](EditedFile& f) { f[name].shape = value; };
  };
  const BadField cases[] = {
      {type("ndf", u32), "ndf of type f32"},
      {type("jacobian", i8), "jacobian of type u8"},
      {shape("theta_i", {2, 2}), "theta_i of type f32 with 1 dimensions"},
      {shape("vndf", {5, 4, 16 * 16}), "vndf of type f32 with 4"},
      {shape("vndf", {4, 5, 16, 16}), "vndf of shape [5, 4,"},
      {shape("rgb", {5, 4, 6, 8, 4}), "rgb of shape [5, 4, 3,"},
      {shape("rgb", {5, 4, 3, 64, 1}), "spectra"},
      {[](EditedFile& f) {
         f["luminance"] = {f32, {5, 4, 0, 8}, {}};
       },
       "luminance"},
      {[](EditedFile& f) {
         f["theta_i"] = {f32, {0}, {}};
       },
       "theta_i"},
      {[](EditedFile& f) {
         f["jacobian"] = {u8, {0}, {}};
       },
       "jacobian"},
  };
  expect_errors(cases);
}

TEST(Rgl, WrongNumbersThrow) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const auto number = [](const char* name, std::size_t i, float value) {
    return [=](EditedFile& f) { f[name].set_float(i, value); };
  };
  const BadField cases[] = {
      {number("theta_i", 2, 0.1f), "increasing theta_i"},
      {number("theta_i", 3, 2.0f), "pi/2"},
      {number("phi_i", 1, -4.0f), "increasing phi_i"},
      {number("phi_i", 0, -1e30f), "cover the circle"},
      {number("phi_i", 0, kNan), "finite numbers in phi_i"},
      {number("ndf", 7, kInf), "finite numbers in ndf"},
      {number("sigma", 7, -kInf), "finite numbers in sigma"},
      {number("vndf", 7, kNan), "finite numbers in vndf"},
      {number("rgb", 7, kNan), "finite numbers in rgb"},
      {number("luminance", 7, kInf), "finite numbers in luminance"},
      {number("ndf", 7, -1), "ndf finite and >= 0"},
      {number("vndf", 7, -1), "values >= 0"},
      {[](EditedFile& f) { std::fill_n(f["vndf"].data.begin(), 4 * 16 * 16, std::byte{0}); }, "positive"},
  };
  expect_errors(cases);
  EditedFile closed(small_table(3, true));  // a circle that closes by itself
  closed["phi_i"].set_float(4, 2.0f);
  EXPECT_NO_THROW(parsed(closed.bytes()));
}

TEST(Rgl, ChangedHeaderBytesThrowOrReadWithinTheFile) {
  const std::string bytes = format_rgl(small_table(3, false));
  const std::uint64_t header = parse_tensor_file(memory_file(bytes)).front().offset;
  int thrown = 0;
  for (std::size_t at = 0; at < header; ++at)
    for (char value : {'\x00', '\x01', '\x7f', '\xff'}) {
      std::string lie = bytes;
      lie[at] = value;
      try {
        values_of(parsed(lie).table);
      } catch (const Error&) {
        ++thrown;
      }
    }
  EXPECT_GT(thrown, 1000);
}

class RglMeasurements : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("BURNISH_DATA");
    if (!folder) GTEST_SKIP() << "BURNISH_DATA is not set";
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(folder) / "rgl"))
      files_.push_back(parse_rgl(read_file(entry.path()), {}));
    ASSERT_EQ(files_.size(), 8u);
  }
  std::vector<RglFile> files_;
};

TEST_F(RglMeasurements, AreReadAsDescribed) {
  for (const RglFile& file : files_) {
    EXPECT_TRUE(file.table.isotropic());
    EXPECT_EQ(file.table.channels(), 3);
    EXPECT_EQ(file.findings.sample_count, 8u * 32 * 32);
    EXPECT_NE(file.findings.description, "");
    EXPECT_EQ(file.findings.negative_count > 0, file.findings.most_negative < 0);
    for (double value : values_of(file.table)) EXPECT_TRUE(std::isfinite(value) && value >= 0);
  }
}

TEST_F(RglMeasurements, AreNearlyReciprocalAndDoNotCreateLight) {
  std::vector<double> asymmetry;
  for (const RglFile& file : files_) {
    Pcg32 random(5);
    std::vector<double> f(3), g(3);
    double difference = 0, size = 0, albedo = 0;
    constexpr int kPairs = 4000;
    for (int i = 0; i < kPairs; ++i) {
      // wo is fixed and wi drawn by the cosine, so the mean of f is albedo / pi.
      const double u = random.uniform();
      const Vec3 wi = spherical_direction(std::acos(std::sqrt(u)), random.uniform() * kTwoPi);
      const Vec3 wo = spherical_direction(0.6, 0.3);
      file.table.eval(wi, wo, f);
      for (double value : f) albedo += kPi * value / 3 / kPairs;
      if (wi.z < 0.2) continue;
      file.table.eval(wo, wi, g);
      for (std::size_t c = 0; c < 3; ++c) {
        difference += std::abs(std::log1p(f[c]) - std::log1p(g[c]));
        size += std::log1p(f[c]);
      }
    }
    asymmetry.push_back(difference / size);
    EXPECT_LT(albedo, 1.1) << file.findings.description;
    EXPECT_GT(albedo, 0.01) << file.findings.description;
  }
  // Dull materials show whether cosine and Jacobian are right; sharp ones carry the noise of the measurement.
  std::sort(asymmetry.begin(), asymmetry.end());
  EXPECT_LT(asymmetry[1], 0.05);
  EXPECT_LT(asymmetry.back(), 0.4);
}

TEST_F(RglMeasurements, SurviveWriting) {
  const RglTable& table = files_.front().table;
  EXPECT_EQ(values_of(parsed(format_rgl(table)).table), values_of(table));
}

}  // namespace
}  // namespace burnish
