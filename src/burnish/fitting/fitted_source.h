// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <burnish/factors/table_format.h>
#include <burnish/fitting/choosing/budget_ladder.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fit_report.h>
#include <burnish/fitting/refinement/training_set.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/sample_source.h>
#include <burnish/source.h>

namespace burnish {

/// Tells FitOptions::progress how far a stage of a fit is. The options must outlive it.
class Stages {
 public:
  explicit Stages(const FitOptions& options) : options_(&options) {}

  /// The progress of the stage; empty where nobody listens.
  std::function<void(double)> of(std::string stage) const;
  /// The same, with `what` after the name of every stage: " to 700 bytes".
  Stages with(std::string_view what) const;

 private:
  const FitOptions* options_;
  std::string what_;
};

/// The target of a fit: the function that its owner makes of it, or its nodes, see FitTarget. Training sets, and
/// what tells how good a model can be, are drawn from it. Source and options must outlive it.
class FittedSource {
 public:
  /// If nodes are fitted, takes them and finds the function between them, which takes seconds. Throws Error for
  /// options that exclude each other, and as measured_nodes and choose_covariance do.
  FittedSource(const Source& source, const FitOptions& options, const Stages& stages);
  FittedSource(const FittedSource&) = delete;

  // ---- What it is

  const Source& source() const noexcept { return source_; }
  std::size_t channels() const noexcept { return brdf_.channels(); }
  bool isotropic() const noexcept { return brdf_.isotropic(); }
  /// The function that is fitted, if the target is one, and that models are scored against.
  BrdfRef reference() const;
  /// Samples that are fitted as they are; null for a function.
  const Samples* samples() const noexcept;
  /// Returns true if those are scattered samples of the source.
  bool scattered() const noexcept { return samples() && !nodes_; }
  /// The nodes that are the target, if they are.
  const std::optional<MeasuredNodes>& nodes() const noexcept { return nodes_; }
  /// The function between the nodes of an isotropic source, where nodes are the target.
  const std::optional<KrigedNodes>& between() const noexcept { return between_; }
  /// The facts that are known of the nodes before a model is; none where they are not the target.
  const std::optional<NodesReport>& nodes_report() const noexcept { return nodes_report_; }
  /// Returns true if a fit follows the function between nodes most where these are: a table's crowd where highlights are.
  /// Scattered samples stand anywhere, and their function is fitted as any other.
  bool judged_at_nodes() const noexcept { return between_ && !source_.samples(); }
  /// The source's table of half and difference angles, if it is one and not its nodes are fitted.
  const HalfDiffTable* table() const noexcept;

  // ---- What models are fitted to

  /// Pairs drawn as `drawn` says from what is fitted, with pixels lit from the viewer and with the nodes that are the
  /// target; or the scattered samples themselves, of very many a part.
  TrainingSet drawn_set(TrainingOptions drawn, const Stages& stages) const;
  /// Pairs for lobes that are given, their azimuths spread if `spread_phi_h`; or the samples themselves, all of them.
  TrainingSet training_set(bool spread_phi_h) const;
  /// The source's own samples where it has some, the entries of `table` where that is not null, else pairs drawn: as many
  /// as the options say, or `drawn`.
  SampleSource sample_source(std::size_t drawn, bool spread_phi_h,
                             const HalfDiffTable* table = nullptr) const;

  // ---- How models are stored and judged

  /// The format of tables: the options', or of three channels rgb9e5, which takes a third fewer bytes for hardly any
  /// error, else half. Throws Error if the source's channels do not go with it.
  TableFormat format() const;
  /// Throws Error unless the format holds as many channels as the source has.
  void check_format(TableFormat format) const;
  /// Pairs that no fit sees, for the errors that are reported of factors.
  FigureOptions held_out() const;
  /// The same of baselines.
  FigureOptions held_out_of_baselines() const;
  /// The scorer of its models, and the noise of the measurement itself where something tells it.
  NoiseScale noise_scale() const;

 private:
  void take_nodes(const Stages& stages);
  void add_nodes(TrainingSet& set) const;

  const Source& source_;
  const FitOptions& options_;
  BrdfRef brdf_;
  std::optional<SymmetrizedBrdf> symmetrized_;
  std::optional<MeasuredNodes> nodes_;
  std::optional<KrigedNodes> between_;
  std::optional<NodesReport> nodes_report_;
};

}  // namespace burnish
