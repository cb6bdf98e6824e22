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

/// The numbers of bytes that are tried where none is asked for.
inline constexpr std::array<std::uint64_t, 8> kBudgetLadder{700,    1'350,  2'700,  5'400,
                                                            10'800, 16'384, 32'768, 65'536};

/// Where relative errors are of no interest any more, whatever the source.
inline constexpr double kMinRelative = 0.005;
/// By what share twice the bytes must lower the error at least.
inline constexpr double kMinBudgetGain = 0.1;

/// Scores models beside what the measurement itself would score.
class NoiseScale {
 public:
  /// Errors of the function that is fitted; `source` is what it was made of. Of a measurement that is made reciprocal
  /// the noise is what exchanged directions tell (exchanged_figures), its relative error at most what KrigedNodes
  /// misses held-out nodes by where the source is isotropic (held_out_figures). Of any other source there is none.
  /// Both must outlive the scale. Throws Error as Scorer and measured_nodes do.
  NoiseScale(const Source& source, BrdfRef fitted, bool symmetrized, const FigureOptions& figures);
  /// Errors at nodes that are fitted, beside what is known of held-out ones.
  NoiseScale(const MeasuredNodes& nodes, const std::optional<NodeFigures>& held_out);

  const std::optional<ErrorLevel>& noise() const noexcept { return noise_; }
  ErrorLevel error_of(BrdfRef model) const;
  /// How many times an error is above the noise, the largest of those that are known of both, no relative
  /// noise counting as less than kMinRelative; without noise the relative error over kMinRelative.
  double excess(const ErrorLevel& error) const noexcept;

 private:
  std::optional<Scorer> scorer_;
  std::optional<MeasuredNodes> nodes_;
  std::optional<ErrorLevel> noise_;
};

/// Why no more bytes are tried after these trials, whose bytes rise; nothing: go on. Noise (or without it the
/// floor) where the last one's excess is at most 1, gain where neither it nor the relative error is lower
/// than that of the trial before by kMinBudgetGain each time the bytes double, largest at the end of the ladder.
/// Precondition: at least one trial.
std::optional<BudgetStop> stop_after(std::span<const BudgetTrial> trials, bool noise_known);

}  // namespace burnish
