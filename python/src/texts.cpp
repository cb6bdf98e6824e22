// SPDX-License-Identifier: Apache-2.0
#include "texts.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/factors/model_spec.h>
#include <burnish/math/closest_name.h>
#include <burnish/short_message.h>

namespace burnish::python {

namespace {

std::string warp_text(const Warp& warp) {
  constexpr const char* kNames[] = {"", "power", "rational"};
  return warp.kind == WarpKind::identity
             ? ""
             : fmt::format(", {} {:g}", kNames[static_cast<std::size_t>(warp.kind)], warp.parameter);
}

std::string projection_text(const Projection& p) {
  return p.kind == Projection::Kind::affine
             ? fmt::format("({:g}, {:g}, {:g}, {:g})", p.wi, p.wo, p.mirror, p.n)
             : std::string(to_string(p.kind));
}

// Returns the errors in a fit's notes, after a comma: ", psnr 41.2 dB, expected relative 0.063".
std::string errors_text(const std::string& notes) {
  const auto json = nlohmann::json::parse(notes, nullptr, false);
  std::string text;
  if (!json.is_object()) return text;
  if (const auto psnr = json.find("psnr"); psnr != json.end() && psnr->is_number())
    text += fmt::format(", psnr {:.1f} dB", psnr->get<double>());
  if (const auto expected = json.find("node_expected"); expected != json.end() && expected->is_object())
    if (const auto relative = expected->find("relative");
        relative != expected->end() && relative->is_number())
      text += fmt::format(", expected relative {:.2g}", relative->get<double>());
  return text;
}

}  // namespace

std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string quoted(const std::string& name) {
  return fmt::format("'{}'", short_message(name, 200));
}

std::string text_of_source(const OpenedBrdf& opened) {
  return fmt::format("<burnish source {}: {}, {}, {}>", quoted(opened.source().name),
                     opened.source().findings.format, counted(opened.ref().channels(), "channel"),
                     opened.ref().isotropic() ? "isotropic" : "anisotropic");
}

std::string text_of_model(const OpenedModel& opened) {
  const FactoredBrdf& brdf = opened.brdf();
  return fmt::format("<burnish model {}: {}, {}, {}{}>", quoted(opened.source().name), model_expression(brdf),
                     counted(brdf.bytes(), "byte"), counted(brdf.channels(), "channel"),
                     errors_text(opened.source().findings.notes));
}

std::string text_of_baseline(const OpenedBaseline& opened) {
  const Baseline& baseline = opened.baseline();
  return fmt::format("<burnish {} baseline {}: {}, {}{}>", baseline.kind, quoted(opened.source().name),
                     baseline_expression(baseline.brdf), counted(baseline_bytes(baseline.brdf), "byte"),
                     errors_text(baseline.notes));
}

std::string text_of_table(const Table& table) {
  const TableLayout& layout = table.layout;
  std::string nodes = fmt::format("{}", layout.width);
  if (layout.height > 1) nodes += fmt::format(" x {}", layout.height);
  if (layout.shape == TableShape::volume) nodes += fmt::format(" x {}", layout.depth);
  return fmt::format("<burnish table '{}': {} of {} nodes{}, {}, {}, {}>", table.name,
                     to_string(layout.shape), nodes, warp_text(layout.warp),
                     counted(table.channels, "channel"), to_string(table.format),
                     counted(table.byte_count(), "byte"));
}

std::string text_of_use(const FactorUse& use) {
  return fmt::format("<burnish factor: table {} over {}>", use.table, projection_text(use.projection));
}

std::string text_of_lobe(const Lobe& lobe) {
  std::vector<std::size_t> tables;
  for (const FactorUse& use : lobe.factors) tables.push_back(use.table);
  return fmt::format("<burnish lobe: scale ({:.4g}), tables {}>", fmt::join(lobe.scale, ", "),
                     fmt::join(tables, " * "));
}

std::string quoted_names(std::span<const std::string_view> names, std::string_view last_by) {
  std::vector<std::string> quotes;
  for (const std::string_view name : names) quotes.push_back(fmt::format("\"{}\"", name));
  return listed(std::vector<std::string_view>(quotes.begin(), quotes.end()), last_by);
}

}  // namespace burnish::python
