#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_file.h>
#include <burnish/factors/model_spec.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

// A model with random tables: log values uniform in [-span, 0].
FactoredBrdf random_model(const char* expression, std::vector<std::string> options, int channels,
                          TableFormat format, double span = 3) {
  Pcg32 random(17);
  const ModelSpec spec = parse_model_spec(expression, options, true);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = t.shared ? 1 : channels};
    for (std::size_t i = 0; i < t.layout.node_count() * static_cast<std::size_t>(table.channels); ++i)
      table.values.push_back(static_cast<float>(-span * random.uniform()));
    table.format = format_of(t, format);
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes)
    lobes.push_back(
        {.scale = std::vector<double>(static_cast<std::size_t>(channels), 0.3), .factors = factors});
  return from_log_tables(channels, std::move(tables), std::move(lobes));
}

const char* const kEverything =
    "p(wo) q(h) p(wi) r(theta_d) + s(wi+wo+0.4n) t(wi) t(wo) u(theta_h,theta_d) + v(0.3wi+0.9wo) "
    "v(0.9wi+0.3wo)";
const std::vector<std::string> kEverySize{
    "p=8", "q=16x16,rational:0.2", "r=5,power:0.5,shared", "s=9x9", "t=4,shared", "u=6x7", "v=11"};

TEST(FactoredBrdf, IsReciprocalToTheLastBit) {
  const FactoredBrdf brdf = random_model(kEverything, kEverySize, 3, TableFormat::half);
  ASSERT_TRUE(brdf.reciprocal());
  std::array<double, 3> f, g;
  auto pairs = draw_pairs(5000, 2, false);
  pairs.push_back({{0, 0, 1}, normalize({1, 0, 1e-7})});
  pairs.push_back({normalize({1, 2, 3}), normalize({1, 2, 3})});
  for (const auto& [wi, wo] : pairs) {
    brdf.eval(wi, wo, f);
    brdf.eval(wo, wi, g);
    EXPECT_EQ(f, g);
    for (const double v : f) EXPECT_GT(v, 0);
  }
}

TEST(FactoredBrdf, KnowsWhatIsNotReciprocalOrIsotropic) {
  EXPECT_FALSE(random_model("a(wi)", {}, 1, TableFormat::half).reciprocal());
  EXPECT_FALSE(random_model("a(d)", {"a=8x8"}, 1, TableFormat::half).reciprocal());
  EXPECT_FALSE(random_model("a(m+wo)", {}, 1, TableFormat::half).reciprocal());
  EXPECT_FALSE(random_model("a(wi) a(wo) b(wi)", {}, 1, TableFormat::half).reciprocal());
  EXPECT_TRUE(random_model("a(wi) a(wo) b(h)", {}, 1, TableFormat::half).isotropic());
  EXPECT_FALSE(random_model("a(wi) a(wo) b(h)", {"b=8x8"}, 1, TableFormat::half).isotropic());
}

TEST(FactoredBrdf, IsTheProductOfItsLookups) {
  // At the nodes of p and r, and with h at the normal, the product is that of the stored values.
  const FactoredBrdf brdf =
      random_model("p(wo) q(h) r(theta_d) p(wi)", {"p=5", "q=7", "r=5"}, 3, TableFormat::single);
  for (int node = 0; node < 4; ++node) {
    const Vec3 wi = node_direction(brdf.tables()[0].layout, node, 0);
    std::array<double, 3> f;
    brdf.eval(wi, mirror(wi), f);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(node) * 3 + c;
      const double p = brdf.tables()[0].values[i], q = brdf.tables()[1].values[c],
                   r = brdf.tables()[2].values[i];
      EXPECT_NEAR(f[c], brdf.lobes()[0].scale[c] * p * p * q * r, 1e-6 * f[c]);
    }
  }
}

TEST(FactoredBrdf, InterpolatesLinearlyBetweenNodes) {
  Table table{.name = "q", .layout = {.shape = TableShape::disk, .width = 3, .height = 3}, .channels = 1};
  table.values = {1, 0.9f, 0.8f, 0.7f, 0.6f, 0.5f, 0.4f, 0.3f, 0.2f};
  const FactoredBrdf brdf(1, {table}, {{.scale = {2}, .factors = {{.table = 0, .projection = kProjectWi}}}},
                          TableFormat::single);
  double f;
  for (const auto& [wi, wo] : draw_pairs(500, 8, false)) {
    brdf.eval(wi, wo, {&f, 1});
    // these nine values lie on the plane 0.6 - 0.1 x - 0.3 y of the parabolic map
    EXPECT_NEAR(f, 2 * (0.6 - 0.1 * wi.x / (1 + wi.z) - 0.3 * wi.y / (1 + wi.z)), 1e-6);
  }
}

TEST(FactoredBrdf, IsZeroBelowTheHorizon) {
  const FactoredBrdf brdf = random_model("pqp", {}, 3, TableFormat::half);
  std::array<double, 3> f;
  EXPECT_TRUE(brdf.eval({0, 0, -1}, {0, 0, 1}, f));
  EXPECT_EQ(f, (std::array<double, 3>{}));
  EXPECT_TRUE(brdf.eval({0, 0, 1}, {1, 0, 0}, f));
  EXPECT_EQ(f, (std::array<double, 3>{}));
}

TEST(FactoredBrdf, ScalesTablesToOneAndKeepsThemAboveTheFloor) {
  const FactoredBrdf brdf = random_model("pqp", {}, 3, TableFormat::half, 40);
  EXPECT_GE(brdf.smallest_factor(), kTableFloor);
  for (const Table& table : brdf.tables())
    for (std::size_t c = 0; c < 3; ++c) {
      float largest = 0;
      for (std::size_t i = c; i < table.values.size(); i += 3) largest = std::max(largest, table.values[i]);
      EXPECT_EQ(largest, 1);
    }
}

TEST(FactoredBrdf, ScalesTablesToOneInEveryFormat) {
  for (const TableFormat format : {TableFormat::rgb9e5, TableFormat::unorm8}) {
    const FactoredBrdf brdf = random_model("pqp", {}, 3, format, 40);
    for (const Table& table : brdf.tables()) {
      EXPECT_EQ(*std::ranges::max_element(table.values), 1);
      EXPECT_GE(*std::ranges::min_element(table.values),
                format == TableFormat::unorm8 ? 1.0f / 255 : 0x1p-24f);
    }
  }
}

TEST(FactoredBrdf, OneSpikeCostsTheOtherNodesNoPrecisionInRgb9e5) {
  Pcg32 random(8);
  Table table{.name = "q", .layout = {.width = 32}, .channels = 3};
  for (int i = 0; i < 96; ++i) table.values.push_back(static_cast<float>(0.5 * random.uniform() - i % 3));
  table.values[4] += 9;  // node 1, channel 1
  const Lobe lobe{.scale = {0, 0, 0}, .factors = {{.table = 0, .projection = kProjectWi}}};
  const FactoredBrdf brdf = from_log_tables(3, {table}, {lobe}, TableFormat::rgb9e5);
  // the means are moved by 9 / 32: channels of a texel differ by at most e^(0.5 + 9 / 32)
  const double bound = std::exp(0.5 + 9.0 / 32) / 511 + 1e-6;
  for (std::size_t i = 6; i < 96; ++i)
    EXPECT_NEAR(brdf.lobes()[0].scale[i % 3] * brdf.tables()[0].values[i] / std::exp(table.values[i]), 1,
                bound);
}

TEST(FactoredBrdf, CountsEachTableInItsFormat) {
  std::vector<Table> tables;
  for (const TableFormat format :
       {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8})
    tables.push_back({.name = std::string(to_string(format)),
                      .layout = {.width = 10},
                      .channels = 3,
                      .values = std::vector<float>(30, -1.0f),
                      .format = format});
  const Lobe lobe{.scale = {0, 0, 0}, .factors = {{.table = 0, .projection = kProjectWi}}};
  const FactoredBrdf brdf = from_log_tables(3, tables, {lobe});
  EXPECT_EQ(brdf.table_bytes(), 60u + 120 + 40 + 30);
  EXPECT_EQ(from_log_tables(3, tables, {lobe}, TableFormat::rgb9e5).table_bytes(), 160u);
}

TEST(FactoredBrdf, CountsItsBytes) {
  const FactoredBrdf pqp = random_model("pqp", {"p=32", "q=64"}, 3, TableFormat::half);
  EXPECT_EQ(pqp.table_bytes(), 576u);
  EXPECT_EQ(pqp.bytes(), 576u + 4 * 3 + 4);  // three scales, one warp parameter
  EXPECT_EQ(random_model("pqpr", {"p=32", "q=64", "r=32"}, 3, TableFormat::half).table_bytes(), 768u);
  EXPECT_EQ(random_model("a(wi+wo+0.5n)", {"a=10"}, 1, TableFormat::single).bytes(), 40u + 4 + 12);
}

TEST(FactoredBrdf, RefusesWhatDoesNotFit) {
  const Table good{.name = "p", .layout = {.width = 2}, .channels = 1, .values = {1, 0.5f}};
  const Lobe lobe{.scale = {1}, .factors = {{.table = 0, .projection = kProjectWi}}};
  EXPECT_NO_THROW(FactoredBrdf(1, {good}, {lobe}, TableFormat::half));
  const auto refused = [&](auto change_table, auto change_lobe) {
    Table table = good;
    Lobe l = lobe;
    change_table(table);
    change_lobe(l);
    EXPECT_THROW(FactoredBrdf(1, {table}, {l}, TableFormat::half), Error);
  };
  const auto keep = [](auto&) {};
  refused([](Table& t) { t.values = {1, 0}; }, keep);
  refused([](Table& t) { t.values = {1, NAN}; }, keep);
  refused([](Table& t) { t.values = {1}; }, keep);
  refused([](Table& t) { t.values = {1, 0.1f}; }, keep);  // not a half
  refused([](Table& t) { t.name = ""; }, keep);
  refused([](Table& t) { t.layout.width = 1; }, keep);
  refused([](Table& t) { t.layout.height = 3; }, keep);
  refused([](Table& t) { t.channels = 2; }, keep);
  refused(keep, [](Lobe& l) { l.scale = {-1}; });
  refused(keep, [](Lobe& l) { l.scale = {1, 1}; });
  refused(keep, [](Lobe& l) { l.factors[0].table = 1; });
  EXPECT_THROW(FactoredBrdf(1, {good}, {lobe}, TableFormat::rgb9e5), Error);
  EXPECT_THROW(FactoredBrdf(1, {good}, {lobe}, TableFormat::unorm8), Error);
  EXPECT_THROW(from_log_tables(1, {good}, {lobe}, TableFormat::rgb9e5), Error);
  EXPECT_THROW(FactoredBrdf(1, {good, good}, {lobe}, TableFormat::half), Error);
  EXPECT_THROW(FactoredBrdf(1, {good}, {}, TableFormat::half), Error);
}

TEST(ModelSpec, ReadsWhatModelExpressionPrints) {
  for (const char* expression : {"pqp", "pqpr", kEverything}) {
    const FactoredBrdf brdf = random_model(expression, {}, 1, TableFormat::half);
    const FactoredBrdf again = random_model(model_expression(brdf).c_str(), {}, 1, TableFormat::half);
    EXPECT_EQ(model_expression(again), model_expression(brdf));
  }
}

TEST(ModelSpec, ReadsFormats) {
  const std::vector<std::string> options{"p=8,unorm8", "q=8,rational:0.5,shared"};
  const ModelSpec spec = parse_model_spec("pqpr", options, true);
  EXPECT_EQ(format_of(spec.tables[0], TableFormat::half), TableFormat::unorm8);
  EXPECT_EQ(format_of(spec.tables[1], TableFormat::rgb9e5), TableFormat::half);  // shared: one channel
  EXPECT_EQ(format_of(spec.tables[2], TableFormat::rgb9e5), TableFormat::rgb9e5);
}

TEST(ModelSpec, RefusesWhatItDoesNotKnow) {
  for (const char* expression :
       {"", "p", "p(", "p(wi", "p(wi)+", "p()", "(wi)", "p(wi) q", "p(theta_q)", "p(h,)"})
    EXPECT_THROW(parse_model_spec(expression, {}, true), Error) << expression;
  for (const char* option :
       {"p", "=3", "p=", "p=1", "p=4x", "p=4x5", "p=4,what", "p=99999", "z=4", "p=4,rational:0"})
    EXPECT_THROW(parse_model_spec("pqp", std::vector<std::string>{option}, true), Error) << option;
  EXPECT_THROW(parse_model_spec("pqp", std::vector<std::string>{"p=4", "p=5"}, true), Error);
  EXPECT_THROW(parse_model_spec("pqpr", std::vector<std::string>{"r=8x8"}, true), Error);
}

// The text with one part replaced by another, padded with spaces to the same length.
std::string replaced(std::string text, const std::string& from, std::string to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  EXPECT_LE(to.size(), from.size());
  to.resize(from.size(), ' ');
  return text.replace(at, from.size(), to);
}

TEST(ModelFile, RestoresModelsToTheLastBit) {
  for (const TableFormat format :
       {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8})
    for (const int channels : {1, 3, 31}) {
      if (format == TableFormat::rgb9e5 && channels != 3) continue;
      Model model{.brdf = random_model(kEverything, kEverySize, channels, format),
                  .lambda_nm = {},
                  .notes = R"({"source":"random","error":0.1})"};
      for (int c = 0; channels == 31 && c < channels; ++c) model.lambda_nm.push_back(400 + 10 * c);
      const std::string bytes = format_model(model);
      const FileBytes file = memory_file(bytes);
      EXPECT_TRUE(looks_like_exr(file.bytes));
      const Model again = parse_model(file);
      EXPECT_EQ(again.brdf.tables().size(), model.brdf.tables().size());
      EXPECT_TRUE(again.brdf == model.brdf);
      EXPECT_EQ(again.lambda_nm, model.lambda_nm);
      EXPECT_EQ(format_model(again), bytes);
    }
}

TEST(ModelFile, RestoresMixedFormats) {
  std::vector<Table> tables;
  Pcg32 random(5);
  for (const TableFormat format :
       {TableFormat::unorm8, TableFormat::single, TableFormat::half, TableFormat::rgb9e5}) {
    Table table{.name = std::string(to_string(format)), .layout = {.width = 9}, .channels = 3};
    for (int i = 0; i < 27; ++i) table.values.push_back(static_cast<float>(-20 * random.uniform()));
    table.format = format;
    tables.push_back(std::move(table));
  }
  const Lobe lobe{.scale = {0, 0, 0}, .factors = {{.table = 3, .projection = kProjectWi}}};
  const Model model{.brdf = from_log_tables(3, tables, {lobe})};
  EXPECT_EQ(parse_model(memory_file(format_model(model))), model);
}

TEST(ModelFile, ReadsFilesOfVersionOne) {
  const Model model{.brdf = random_model("a(h)", {}, 3, TableFormat::half),
                    .notes = R"({"room":"for the format"})"};
  std::string bytes = format_model(model);
  bytes = replaced(bytes, "\"version\":2", "\"version\":1");
  bytes = replaced(bytes, "\"format\":\"half\",", "");
  bytes = replaced(bytes, "\"notes\":" + model.notes, "\"notes\":{},\"format\":\"half\"");
  EXPECT_EQ(parse_model(memory_file(bytes)).brdf, model.brdf);
}

TEST(ModelFile, RefusesFormatsThatTheValuesContradict) {
  const auto with_format = [](TableFormat truth, const std::string& stated) {
    const std::string bytes = format_model({.brdf = random_model("pqp", {}, 3, truth)});
    return memory_file(replaced(bytes, "\"" + std::string(to_string(truth)) + "\"", "\"" + stated + "\""));
  };
  EXPECT_NO_THROW(parse_model(with_format(TableFormat::rgb9e5, "half")));  // true, if not all of the truth
  EXPECT_NO_THROW(parse_model(with_format(TableFormat::unorm8, "float")));
  EXPECT_THROW(parse_model(with_format(TableFormat::single, "half")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::unorm8, "half")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::unorm8, "rgb9e5")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::rgb9e5, "unorm8")), Error);
  EXPECT_THROW(parse_model(with_format(TableFormat::rgb9e5, "byte")), Error);
}

TEST(ModelFile, RefusesDamagedFiles) {
  const std::string bytes =
      format_model({.brdf = random_model("pqp", {"p=8", "q=8x8"}, 3, TableFormat::half)});
  const auto parse = [](const std::string& text) { return parse_model(memory_file(text)); };
  for (std::size_t n = 1; n < bytes.size(); n += n < 64 ? 1 : 61)
    EXPECT_THROW(parse(bytes.substr(0, n)), Error) << n;
  EXPECT_THROW(parse(replaced(bytes, "\"version\":2", "\"version\":7")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"channels\":3", "\"channels\":9")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"width\":8", "\"width\":9")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"shape\":\"disk\"", "\"shape\":\"disc\"")), Error);
  EXPECT_THROW(parse(replaced(bytes, "\"projection\":\"wo\"", "\"projection\":\"ww\"")), Error);
}

}  // namespace
}  // namespace burnish
