#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <burnish/baselines/evaluation_cost.h>
#include <burnish/image/image.h>
#include <burnish/io/open_source.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// One representation of one material.
struct Score {
  std::string method;  ///< "ours", "network" or one of baseline_methods()
  std::size_t budget = 0;
  ErrorFigures errors;
  std::size_t bytes = 0;
  std::optional<EvaluationCost> cost;
  double seconds = 0;  ///< of the fit; 0: not fitted here
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

  /// Throws Error as open_source and Scorer do.
  Material(std::string called, const std::string& place, const FigureOptions& options = {})
      : name(std::move(called)),
        source(open_source(place, {})),
        reference(source.ref()),
        scorer(reference, options) {}
  Material(const Material&) = delete;
  Material& operator=(const Material&) = delete;
};

/// A sphere lit at 30 degrees.
Image8 picture(BrdfRef brdf, double exposure);

/// Fits and scores each material's attempts, in their order; those that are not "ours" side by side.
std::vector<std::vector<Score>> run(const std::deque<Material>& materials);

/// Scores a network of 675 weights.
Score run_network(const Material& material, BrdfRef network);

/// Table head and rows; a row's first column is the material.
void print_head();
void print_row(const std::string& material, const Score& score);

/// Means of scores by method and budget, in the order they came first.
class Means {
 public:
  void add(const std::vector<Score>& scores);
  std::vector<Score> means() const;

 private:
  std::vector<std::pair<Score, double>> sums_;
};

}  // namespace burnish
