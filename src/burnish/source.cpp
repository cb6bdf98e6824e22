// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/source.h>

namespace burnish {

namespace {

// Returns what `use` makes of the table or samples that a measurement is.
template <class Found, class Use>
Found of_measurement(const Source& source, const Use& use) {
  return std::visit(
      [&](const auto& any) -> Found {
        if constexpr (std::same_as<std::decay_t<decltype(any)>, ScatteredBrdf>)
          return use(any.samples());
        else if constexpr (requires { measured_nodes(any); })
          return use(any);
        else
          throw Error(fmt::format("{}: expected a measurement, whose nodes are known, found {}", source.name,
                                  source.findings.format));
      },
      source.brdf);
}

/// The part and band that notes name; nothing where they name none.
std::optional<BsdfBlock> block_of(const std::string& notes) {
  const auto json = nlohmann::json::parse(notes, nullptr, false);
  const auto text_at = [&](const char* key) {
    const auto found = json.is_object() ? json.find(key) : json.end();
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const auto part = find_bsdf_part(text_at("part"));
  return part ? std::optional(BsdfBlock{*part, text_at("band")}) : std::nullopt;
}

void expect_nodes(const Source& source, std::size_t found) {
  if (found == 0) throw Error(fmt::format("{}: expected nodes above the horizon, found none", source.name));
}

}  // namespace

BrdfRef Source::ref() const noexcept {
  // An analytic BRDF's own reference skips the choice of its model.
  if (const auto* analytic = std::get_if<AnalyticBrdf>(&brdf)) return analytic->ref();
  const BrdfRef measured = std::visit([](const auto& any) -> BrdfRef { return any; }, brdf);
  return clamp_negatives ? measured : measured.unclamped();
}

const Samples* Source::samples() const noexcept {
  const auto* scattered = std::get_if<ScatteredBrdf>(&brdf);
  return scattered ? &scattered->samples() : nullptr;
}

std::optional<std::size_t> Source::bytes() const noexcept {
  return std::visit(
      [](const auto& any) -> std::optional<std::size_t> {
        if constexpr (requires { any.bytes(); })
          return any.bytes();
        else
          return std::nullopt;
      },
      brdf);
}

bool is_measurement(const Source& source) noexcept {
  return std::visit(
      [](const auto& any) {
        return std::same_as<std::decay_t<decltype(any)>, ScatteredBrdf> || requires {
          measured_nodes(any);
        };
      },
      source.brdf);
}

MeasuredNodes measured_nodes(const Source& source) {
  MeasuredNodes nodes =
      of_measurement<MeasuredNodes>(source, [](const auto& any) { return measured_nodes(any); });
  expect_nodes(source, nodes.size());
  return nodes;
}

NodeCount count_nodes(const Source& source) {
  const NodeCount count = of_measurement<NodeCount>(source, [](const auto& any) { return count_nodes(any); });
  expect_nodes(source, count.nodes);
  return count;
}

Source to_source(const std::string& name, FunctionBrdf brdf, std::vector<double> lambda_nm) {
  const std::size_t channels = brdf.channels();
  if (lambda_nm.empty() ? channels != 1 && channels != 3 : lambda_nm.size() != channels)
    throw Error::in_file(name, lambda_nm.empty() ? "wavelengths, or grey or RGB" : "a wavelength a channel",
                         fmt::format("{} channels and {} wavelengths", channels, lambda_nm.size()));
  if (!lambda_nm.empty() &&
      (!(lambda_nm.front() > 0) || !std::isfinite(lambda_nm.back()) ||
       std::adjacent_find(lambda_nm.begin(), lambda_nm.end(), std::not_fn(std::less<>{})) != lambda_nm.end()))
    throw Error::in_file(name, "positive, increasing wavelengths",
                         fmt::format("{} ... {} nm out of order", lambda_nm.front(), lambda_nm.back()));
  Findings findings;
  findings.format = "function";
  findings.lambda_nm = std::move(lambda_nm);
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return {name, std::move(brdf), std::move(findings)};
}

Source to_source(const std::string& name, Model model) {
  Findings findings;
  findings.format = "burnish model";
  findings.description = model_expression(model.brdf);
  findings.lambda_nm = std::move(model.lambda_nm);
  findings.notes = std::move(model.notes);
  findings.block = block_of(findings.notes);
  for (const Table& table : model.brdf.tables()) findings.sample_count += table.layout.node_count();
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return {name, std::move(model.brdf), std::move(findings)};
}

Source to_source(const std::string& name, Baseline baseline) {
  Findings findings;
  findings.format = fmt::format("{} baseline", baseline.kind);
  findings.description = baseline_expression(baseline.brdf);
  findings.notes = std::move(baseline.notes);
  findings.block = block_of(findings.notes);
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return std::visit(
      [&](auto& brdf) -> Source {
        return {name, std::move(brdf), std::move(findings)};
      },
      baseline.brdf);
}

Model to_model(const Source& source) {
  const auto* brdf = std::get_if<FactoredBrdf>(&source.brdf);
  if (!brdf)
    throw Error::in_file(source.name, "a model, which `burnish fit` makes of it", source.findings.format);
  return {*brdf, source.findings.lambda_nm, source.findings.notes};
}

}  // namespace burnish
