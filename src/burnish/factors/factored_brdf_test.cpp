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
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes)
    lobes.push_back(
        {.scale = std::vector<double>(static_cast<std::size_t>(channels), 0.3), .factors = factors});
  return from_log_tables(channels, std::move(tables), std::move(lobes), format);
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
  refused([](Table& t) { t.name = ""; }, keep);
  refused([](Table& t) { t.layout.width = 1; }, keep);
  refused([](Table& t) { t.layout.height = 3; }, keep);
  refused([](Table& t) { t.channels = 2; }, keep);
  refused(keep, [](Lobe& l) { l.scale = {-1}; });
  refused(keep, [](Lobe& l) { l.scale = {1, 1}; });
  refused(keep, [](Lobe& l) { l.factors[0].table = 1; });
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

TEST(ModelFile, RestoresModelsToTheLastBit) {
  for (const TableFormat format : {TableFormat::half, TableFormat::single})
    for (const int channels : {1, 3, 31}) {
      Model model{.brdf = random_model(kEverything, kEverySize, channels, format),
                  .lambda_nm = {},
                  .notes = R"({"source":"random","error":0.1})"};
      for (int c = 0; channels == 31 && c < channels; ++c) model.lambda_nm.push_back(400 + 10 * c);
      const std::string bytes = format_model(model);
      FileBytes file{"model.exr", {}};
      file.bytes.assign(reinterpret_cast<const std::byte*>(bytes.data()),
                        reinterpret_cast<const std::byte*>(bytes.data()) + bytes.size());
      EXPECT_TRUE(looks_like_exr(file.bytes));
      const Model again = parse_model(file);
      EXPECT_EQ(again.brdf.tables().size(), model.brdf.tables().size());
      EXPECT_TRUE(again.brdf == model.brdf);
      EXPECT_EQ(again.lambda_nm, model.lambda_nm);
      EXPECT_EQ(format_model(again), bytes);
    }
}

TEST(ModelFile, RefusesDamagedFiles) {
  const std::string bytes =
      format_model({.brdf = random_model("pqp", {"p=8", "q=8x8"}, 3, TableFormat::half)});
  const auto parse = [](std::string text) {
    FileBytes file{"model.exr", {}};
    file.bytes.assign(reinterpret_cast<const std::byte*>(text.data()),
                      reinterpret_cast<const std::byte*>(text.data()) + text.size());
    return parse_model(file);
  };
  for (std::size_t n = 1; n < bytes.size(); n += n < 64 ? 1 : 61)
    EXPECT_THROW(parse(bytes.substr(0, n)), Error) << n;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string copy = bytes;
    const auto at = copy.find(from);
    EXPECT_NE(at, copy.npos) << from;
    EXPECT_EQ(from.size(), to.size());
    return copy.replace(at, from.size(), to);
  };
  EXPECT_THROW(parse(replaced("\"version\":1", "\"version\":7")), Error);
  EXPECT_THROW(parse(replaced("\"channels\":3", "\"channels\":9")), Error);
  EXPECT_THROW(parse(replaced("\"width\":8", "\"width\":9")), Error);
  EXPECT_THROW(parse(replaced("\"shape\":\"disk\"", "\"shape\":\"disc\"")), Error);
  EXPECT_THROW(parse(replaced("\"projection\":\"wo\"", "\"projection\":\"ww\"")), Error);
}

}  // namespace
}  // namespace burnish
