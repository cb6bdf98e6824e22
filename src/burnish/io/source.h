#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include <burnish/baselines/dgf_brdf.h>
#include <burnish/baselines/neural_brdf.h>
#include <burnish/baselines/separable_brdf.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/patch_table.h>
#include <burnish/reflectance/rgl_table.h>
#include <burnish/reflectance/scattered_brdf.h>

namespace burnish {

/// Everything a BRDF argument can be.
using AnyBrdf = std::variant<HalfDiffTable, RglTable, ScatteredBrdf, AngleTable, PatchTable, AnalyticBrdf,
                             NeuralBrdf, SeparableBrdf, DgfBrdf, FactoredBrdf>;

/// An opened BRDF and what was found in it.
struct Source {
  std::string name;
  AnyBrdf brdf;
  Findings findings;

  /// Refers to this object, which must outlive it and stay where it is.
  BrdfRef ref() const noexcept;
  /// The scattered measurements, or nullptr where the source is none.
  const Samples* samples() const noexcept;
  /// Size of a compressed BRDF as its type counts it; nothing for measurements.
  std::optional<std::size_t> bytes() const noexcept;
};

/// Opens an analytic BRDF such as "ggx:alpha_x=0.1" (see parse_analytic), a neural encoding
/// "nbrdf:FILE#NAME" (see parse_neural) or a file, whose kind is found by content, never by its name. Throws
/// Error if it cannot be read or is of no known kind, and whatever its reader throws.
Source open_source(const std::string& spec, const OpenOptions& options);

/// The same for bytes in memory.
Source parse_source(const FileBytes& file, const OpenOptions& options);

/// A model as a source of that name.
Source to_source(const std::string& name, Model model);

}  // namespace burnish
