// SPDX-License-Identifier: Apache-2.0
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

/// The method's name for a measurement's own score (exchanged_figures). It is no model: tables never have it in bold.
inline constexpr std::string_view kMeasurement = "the measurement";

/// One representation of one material.
struct Score {
  std::string
      method;  ///< "ours", one of baseline_methods(), the name of a published model, or the name kMeasurement
  std::size_t budget = 0;
  ErrorFigures errors;
  std::size_t bytes = 0;
  std::optional<EvaluationCost> cost;
  double seconds = 0;  ///< the fit's time; 0: not fitted here
  int fetches = 0;     ///< given to the fit or chosen by it; 0: not ours, or as many as the lobes take
  Image8 picture;      ///< a lit sphere, light at 30 degrees, under the reference's exposure; may be empty
};

/// A method and its budgets in bytes. Without a budget, the method takes as many bytes as it needs.
struct Attempt {
  std::string_view method;
  std::vector<std::size_t> budgets;
};

/// A material that methods are tried on. It must not move.
struct Material {
  std::string name;
  Source source;
  SymmetrizedBrdf reference;
  Scorer scorer;
  std::vector<Attempt> attempts = {};
  std::optional<std::size_t> shown_budget = {};  ///< scores within it have pictures

  /// Throws Error as Scorer does.
  Material(std::string called, Source opened, const FigureOptions& options = {})
      : name(std::move(called)),
        source(std::move(opened)),
        reference(source.ref()),
        scorer(reference, options) {}
  Material(const Material&) = delete;
  Material& operator=(const Material&) = delete;
};

/// Draws a sphere lit at 30 degrees.
Image8 picture(BrdfRef brdf, double exposure);

/// Fits and scores each material's attempts, in their order. Methods other than "ours" run side by side.
std::vector<std::vector<Score>> run(const std::deque<Material>& materials);

/// Scores a published model, made reciprocal, under the name `method`.
Score run_published(const Material& material, std::string_view method, const Source& model);

/// The mean of a method's scores at a budget.
struct MeanScore {
  Score score;
  int materials = 0;
};
/// Returns the means in the order in which methods and budgets first appear.
std::vector<MeanScore> means_of(const std::vector<std::vector<Score>>& scores);

/// Returns a table with a row for each mean. Both figures are bold where another method's is better than that of "ours"
/// over as many materials. The other method must have taken no more bytes than ours was given.
Table table_of(const std::vector<MeanScore>& means);
/// Returns a table with a row for each score. scores[i] are those of materials[i].
Table table_of(const std::deque<Material>& materials, const std::vector<std::vector<Score>>& scores);

}  // namespace burnish::reports
