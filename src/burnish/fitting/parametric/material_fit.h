// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <burnish/fitting/fit_summary.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/gltf_material.h>
#include <burnish/source.h>

namespace burnish {

/// The effects of a BRDF that a material lacks: 1, 1, 0 and 1 for an identical one. Empty where the BRDF is known at
/// none of the directions; unknown directions are left out.
struct Unexplained {
  /// Light that returns to where it came from (wi = wo, 20 to 60 degrees), of the source over that of the material.
  std::optional<double> backscatter;
  /// By what factor values rise again away from the highlight (theta_h to 60 degrees, theta_d 15 and 40), the greatest
  /// of the source over the greatest of the material, at least 1.
  std::optional<double> rings;
  /// Greatest distance of the highlight's chromaticities (r, g, b over their sum; theta_h 0, theta_d to 75 degrees).
  std::optional<double> colour_shift;
  /// The ratio of f where half vectors lean across the tangent to f where they lean along it (theta_h 10 to 40
  /// degrees, theta_d 15), of the source over that of the material.
  std::optional<double> grain;
};

/// Compares the luminances, of all but grain means over four azimuths unless both are isotropic.
Unexplained unexplained(BrdfRef source, BrdfRef material);

/// Figures of a factored model beside a material.
struct FactoredBeside {
  std::size_t bytes = 0;
  ErrorFigures figures;
};

/// A renderer's material that looks like a BRDF, and how well.
struct MaterialFit {
  std::string target, source;  ///< one of material_targets(); the source's name
  std::variant<OpenPbr, GltfMaterial> material;
  FitSummary summary;  ///< errors as OpenPbrFit has them
  int starts = 0;      ///< minimizations run
  ErrorFigures figures;
  Unexplained beyond;
  /// The score of the same fit with coat, fuzz and film, where a simple OpenPBR was asked for.
  std::optional<ErrorFigures> layered;
  /// The fit of the source's function by DefaultBudget, scored alike.
  std::optional<FactoredBeside> factored;
  double seconds = 0;  ///< of the material's fit alone, by the wall clock

  /// Refers to this object, which must outlive it and stay where it is.
  BrdfRef ref() const noexcept;
};

/// "openpbr" (fit_openpbr) and "gltf" (fit_gltf).
std::span<const std::string_view> material_targets();

struct MaterialFitOptions {
  bool beside = true;          ///< fit a factored model too, for its figures
  bool simple = false;         ///< openpbr of base and specular alone; the fit with layers stands beside it
  FigureOptions figures = {};  ///< of the scores
  /// Called from the calling thread with what is done and a rising share of it, as FitOptions::progress.
  std::function<void(std::string_view stage, double fraction)> progress = {};
};

/// Fits a material as `burnish fit --to TARGET` does: to the reciprocal part of a measurement (SymmetrizedBrdf), to
/// anything else as it is. The same bits for every number of threads. Throws Error for another target, and for a
/// source of other than 1 or 3 channels, and where glTF shall be simple.
MaterialFit fit_material(const Source& source, std::string_view target,
                         const MaterialFitOptions& options = {});

/// The file of it: of openpbr JSON that open_source reads (format_baseline), of gltf a glTF asset of one material. The
/// report stands in it as notes or extras.
std::string format_material(const MaterialFit& fit);

/// The JSON that `burnish fit --to TARGET --json` prints, indented by two: target, source, parameters, psnr, ssim,
/// relative, rms_log, log_cos, layered (of a simple OpenPBR), beyond (null what is not known), factored, starts and
/// iterations, of openpbr spec (see parse_analytic), then output and seconds.
std::string summary_json(const MaterialFit& fit, const std::string& output);

}  // namespace burnish
