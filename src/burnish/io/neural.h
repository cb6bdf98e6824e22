// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <burnish/baselines/neural_brdf.h>
#include <burnish/file.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// A neural encoding read from a file.
struct NeuralFile {
  std::string name;  ///< name of the material
  NeuralBrdf brdf;
  Findings findings;
};

/// Returns true if the first line holds as many commas as a name and the weights of a NeuralBrdf need.
bool looks_like_neural(std::string_view text) noexcept;

/// Reads one encoding of a CSV file whose rows are a name and NeuralBrdf::kWeights weights. The row is the
/// one named `name`, or the only one if `name` is empty. Throws Error if a row up to it is anything else.
/// Throws Error if there is no such row (the message lists names), or if there are several and `name` is
/// empty. Layout: [Sztrajman 2021].
NeuralFile parse_neural(const FileBytes& file, std::string_view name = {});

}  // namespace burnish
