// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <burnish/fitting/fit_report.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/source.h>

namespace burnish {

/// The budgets in bytes that are tried if none is given.
inline constexpr std::array<std::uint64_t, 8> kBudgetLadder{700,    1'350,  2'700,  5'400,
                                                            10'800, 16'384, 32'768, 65'536};

/// Relative errors below this value do not matter, whatever the source.
inline constexpr double kMinRelative = 0.005;
/// The least share by which twice the bytes must lower the error.
inline constexpr double kMinBudgetGain = 0.1;

/// Compares the errors of models with the error of the measurement itself.
class NoiseScale {
 public:
  /// Measures the errors of models of `fitted`; `source` is the data that it was made from. If a measurement is made
  /// reciprocal, the noise is the difference between exchanged directions (exchanged_figures). For isotropic sources
  /// its relative error is at most the error of KrigedNodes at held-out nodes (held_out_figures). Other sources have
  /// no noise. Both must outlive the scale. Throws Error as Scorer and measured_nodes do.
  NoiseScale(const Source& source, BrdfRef fitted, bool symmetrized, const FigureOptions& figures);
  /// Measures errors at the fitted nodes; the noise is the error at held-out nodes, if it is known.
  NoiseScale(const MeasuredNodes& nodes, const std::optional<NodeFigures>& held_out);

  const std::optional<ErrorLevel>& noise() const noexcept { return noise_; }
  ErrorLevel error_of(BrdfRef model) const;
  /// Returns the largest ratio of an error to the noise, among the errors that are known of both. A relative noise
  /// below kMinRelative counts as kMinRelative. Without noise it returns the relative error over kMinRelative.
  double excess(const ErrorLevel& error) const noexcept;

 private:
  std::optional<Scorer> scorer_;
  std::optional<MeasuredNodes> nodes_;
  std::optional<ErrorLevel> noise_;
};

/// Returns the reason to try no more bytes after these trials, whose bytes rise; nothing: continue. Precondition: at
/// least one trial. The reasons are:
/// - noise, or floor without a known noise: the last excess is at most 1;
/// - gain: neither the excess nor the relative error fell by kMinBudgetGain per doubling of the bytes since the trial
///   before;
/// - largest: the ladder ends.
std::optional<BudgetStop> stop_after(std::span<const BudgetTrial> trials, bool noise_known);

}  // namespace burnish
