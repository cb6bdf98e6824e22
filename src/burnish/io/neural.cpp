// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/named_row.h>
#include <burnish/io/neural.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

bool looks_like_neural(std::string_view text) noexcept {
  const std::string_view line = first_content_line(text);
  return std::count(line.begin(), line.end(), ',') == static_cast<std::ptrdiff_t>(NeuralBrdf::kWeights);
}

NeuralFile parse_neural(const FileBytes& file, std::string_view name) {
  NamedRow row = parse_named_row(file, name, {NeuralBrdf::kWeights, "weight", "encoding", "nbrdf:FILE#NAME"});
  Findings findings;
  findings.format = "neural encoding";
  findings.description = row.name;
  findings.conventions = {"675 weights, 1,350 bytes as half floats"};
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  try {
    return {std::move(row.name), NeuralBrdf(row.numbers), std::move(findings)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  }
}

}  // namespace burnish
