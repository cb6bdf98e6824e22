// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <burnish/baselines/baseline_file.h>
#include <burnish/baselines/dgf_brdf.h>
#include <burnish/baselines/neural_brdf.h>
#include <burnish/baselines/np_brdf.h>
#include <burnish/baselines/separable_brdf.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_file.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/function_brdf.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/patch_table.h>
#include <burnish/reflectance/rgl_table.h>
#include <burnish/reflectance/scattered_brdf.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {

/// Everything a BRDF argument can be. Files become one by open_source (io/open_source.h), functions of one's own by
/// to_source.
using AnyBrdf =
    std::variant<HalfDiffTable, RglTable, ScatteredBrdf, AngleTable, PatchTable, TensorTree, AnalyticBrdf,
                 FunctionBrdf, NeuralBrdf, NpBrdf, SeparableBrdf, DgfBrdf, FactoredBrdf>;

/// An opened BRDF and what was found in it.
struct Source {
  std::string name;
  AnyBrdf brdf;
  Findings findings;
  bool clamp_negatives = true;  ///< values below zero become zero once they are interpolated

  /// Refers to this object, which must outlive it and stay where it is. BrdfRef::unclamped() has its values as
  /// they were measured.
  BrdfRef ref() const noexcept;
  /// The scattered measurements, or nullptr where the source is none.
  const Samples* samples() const noexcept;
  /// Size of a compressed BRDF as its type counts it; nothing for measurements.
  std::optional<std::size_t> bytes() const noexcept;
};

/// Returns true if measured_nodes has an answer.
bool is_measurement(const Source& source) noexcept;

/// Returns the measured nodes of a source that is a measurement. Throws Error naming the source where it is a formula
/// or a model, or has no node above the horizon.
MeasuredNodes measured_nodes(const Source& source);

/// Returns the number of these nodes and of their incident angles, in little memory. Throws as measured_nodes does.
NodeCount count_nodes(const Source& source);

/// A function of one's own as a source of that name. lambda_nm: wavelengths of its channels in nm, as many as they are,
/// positive and increasing, or none for grey and RGB. Throws Error for others.
Source to_source(const std::string& name, FunctionBrdf brdf, std::vector<double> lambda_nm = {});

/// A model or a baseline as a source of that name.
Source to_source(const std::string& name, Model model);
Source to_source(const std::string& name, Baseline baseline);

/// The model that a source is. Throws Error, naming it, where it is none.
Model to_model(const Source& source);

}  // namespace burnish
