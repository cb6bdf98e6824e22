#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/baselines/evaluation_cost.h>
#include <burnish/image/image.h>
#include <burnish/io/open_source.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/brdf.h>

#include "markdown.h"

namespace burnish::reports {

/// What a measurement would score itself (exchanged_figures) is called so. It is no model: tables never have it in bold.
inline constexpr std::string_view kMeasurement = "the measurement";

/// One representation of one material.
struct Score {
  std::string
      method;  ///< "ours", one of baseline_methods(), what a published model is called, or kMeasurement
  std::size_t budget = 0;
  ErrorFigures errors;
  std::size_t bytes = 0;
  std::optional<EvaluationCost> cost;
  double seconds = 0;  ///< of the fit; 0: not fitted here
  int fetches = 0;     ///< that the fit was given or chose; 0: none of ours, or lobes in whatever number
  Image8 picture;      ///< a lit sphere, light at 30 degrees, under the reference's exposure; may be none
};

/// A method at the budgets it is tried at; none: whatever it takes.
struct Attempt {
  std::string_view method;
  std::vector<std::size_t> budgets;
};

/// What methods are tried on; stays where it is.
struct Material {
  std::string name;
  Source source;
  SymmetrizedBrdf reference;
  Scorer scorer;
  std::vector<Attempt> attempts = {};
  std::optional<std::size_t> shown_budget = {};  ///< scores up to it have pictures

  /// Throws Error as Scorer does.
  Material(std::string called, Source opened, const FigureOptions& options = {})
      : name(std::move(called)),
        source(std::move(opened)),
        reference(source.ref()),
        scorer(reference, options) {}
  Material(const Material&) = delete;
  Material& operator=(const Material&) = delete;
};

/// A sphere lit at 30 degrees.
Image8 picture(BrdfRef brdf, double exposure);

/// Fits and scores each material's attempts, in their order; those that are not "ours" side by side.
std::vector<std::vector<Score>> run(const std::deque<Material>& materials);

/// Scores a model that others published, made reciprocal; `method` is what it is called.
Score run_published(const Material& material, std::string_view method, const Source& model);

/// The mean of some scores of a method at a budget.
struct MeanScore {
  Score score;
  int materials = 0;
};
/// In the order the methods and budgets came first.
std::vector<MeanScore> means_of(const std::vector<std::vector<Score>>& scores);

/// Means, a row each. Where the figure of another method is ahead of that of "ours" over as many materials,
/// and took no more bytes than ours was given, both figures are bold.
Table table_of(const std::vector<MeanScore>& means);
/// Every score, a row each, scores[i] those of materials[i].
Table table_of(const std::deque<Material>& materials, const std::vector<std::vector<Score>>& scores);

}  // namespace burnish::reports
