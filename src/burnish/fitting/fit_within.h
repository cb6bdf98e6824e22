// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/choosing/cost_limit.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fitted_model.h>
#include <burnish/fitting/fitted_source.h>

namespace burnish {

/// Fits models of at most so many bytes to what is no scattered sample set. Everything that it is made of must outlive
/// it, but the stages.
class WithinBytes {
 public:
  WithinBytes(const FittedSource& source, const FitOptions& options, const Budget& budget,
              std::uint64_t bytes, const Stages& stages);

  /// Returns true if the bytes hold every table of the plan that they give.
  bool holds() const { return holds(bytes_); }
  /// Throws Error, which names the least bytes, unless they do.
  void check() const;

  /// Lobes of lines or hemispheres, as many as the budget says or as serve.
  FittedLobes fit_lobes() const { return fit_lobes(choose_lobes()); }
  /// Models of the number of fetches that trials of several find.
  FittedLobes fit_at_knee() const {
    return source_.isotropic() ? fit_at_isotropic_knee() : fit_at_hemispheres_knee();
  }
  /// At most so many fetches: lobes of lines or hemispheres, one lobe with a volume, or hemispheres.
  FittedLobes fit_with(int fetches) const;
  /// Models of nodes at the budget's fetches, or of one more, where fewer leave a model farther from the nodes than what
  /// is measured predicts nodes that it has not seen, and where it helps. Precondition: the budget has fetches, the
  /// source nodes and a function between them.
  FittedLobes fit_nodes() const;

 private:
  /// Which lobes of lines or hemispheres, and the pairs that they are fitted to.
  struct ChosenLobes {
    TrainingOptions drawn;
    TrainingSet set;
    RefineOptions refine;
    LobePlan plan;
  };

  bool holds(std::size_t bytes) const;
  CostLimit limit_of(std::size_t bytes, int fetches) const;
  std::size_t texel() const;
  double smooth_of(const LobePlan& plan) const;
  ChosenLobes choose_lobes() const;
  FittedLobes fit_lobes(ChosenLobes lobes) const;
  SearchReport search(ChosenLobes& lobes) const;
  FittedLobes fit_lobes_within(const CostLimit& limit) const;
  FittedLobes fit_volumes_within(const CostLimit& limit) const;
  double volume_smoothness(CostLimit limit) const;
  RefineOptions options_of_hemispheres() const;
  FittedLobes fit_hemispheres_to(int fetches, TrainingSet set, const auto& from) const;
  FittedLobes fit_at_isotropic_knee() const;
  FittedLobes fit_at_hemispheres_knee() const;

  const FittedSource& source_;
  const FitOptions& options_;
  const Budget& budget_;
  std::uint64_t bytes_;
  Stages stages_;
};

}  // namespace burnish
