// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/factors/byte_count.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

/// A model of the spec with the same value everywhere.
FactoredBrdf level_model(const ModelSpec& spec, std::size_t channels, TableFormat format) {
  LogModel model{.spec = spec, .channels = channels, .log_values = {}};
  for (const ModelSpec::TableSpec& table : spec.tables)
    model.log_values.emplace_back((table.shared ? 1 : channels) * table.layout.node_count());
  return to_brdf(model, format);
}

TEST(ByteCount, OfASpecIsThatOfItsModels) {
  for (const ModelCase& model : kModelCases) {
    const ModelSpec spec = parse_model_spec(model.expression, model.options, true);
    for (const TableFormat format :
         {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8}) {
      if (!holds_channels(format, model.channels)) continue;
      const std::size_t bytes = level_model(spec, model.channels, format).bytes();
      EXPECT_EQ(model_bytes(spec, model.channels, format), bytes) << model.name << ' ' << to_string(format);
      EXPECT_EQ(model_bytes(spec, model.channels, texel_bytes(format, model.channels)), bytes)
          << model.name << ' ' << to_string(format);
    }
  }
}

TEST(ByteCount, CountsEachTableInItsOwnFormat) {
  const std::vector<std::string> options = {"p=9,float", "q=7x7,rational:0.2,rgb9e5", "v=6x5x4,shared,unorm8",
                                            "s=5"};
  const ModelSpec spec =
      parse_model_spec("p(wo) p(wi) q(h) v(theta_h,theta_d,phi_d) s(wi+wo+0.5n)", options, true);
  for (const TableFormat format : {TableFormat::half, TableFormat::rgb9e5})
    EXPECT_EQ(level_model(spec, 3, format).bytes(), model_bytes(spec, 3, format));
  // One table follows the general format.
  EXPECT_EQ(model_bytes(spec, 3, TableFormat::half) - model_bytes(spec, 3, TableFormat::rgb9e5), 5 * 2u);
}

TEST(ByteCount, TablesWithoutNodesLeaveTheNumbers) {
  ModelSpec spec =
      parse_model_spec("q(h) s(wi+wo+0.5n) + r(theta_d)", std::vector<std::string>{"q=8,power:0.7"}, true);
  const std::size_t whole = model_bytes(spec, 3, TableFormat::half);
  std::size_t texels = 0;
  for (ModelSpec::TableSpec& table : spec.tables) {
    texels += table.layout.node_count();
    table.layout.width = 0;
  }
  EXPECT_EQ(model_bytes(spec, 3, TableFormat::half), whole - 6 * texels);
}

}  // namespace
}  // namespace burnish
