#pragma once

#include <cstddef>
#include <optional>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// The least bytes that plan_scattered has a model for: one table of the half vector, as coarse as can be.
std::size_t least_scattered_bytes(std::size_t channels, bool isotropic, TableFormat format);

/// A lobe for scattered samples.
struct ScatteredPlan {
  ModelSpec spec;     ///< with the share of the smoothness that each table takes
  double smooth = 0;  ///< of HomomorphicOptions
  /// held_out_error of it; none for more than kManySamples samples.
  std::optional<double> error;
  TableFormat format = TableFormat::half;  ///< of all tables
};

/// What makes an incidence: polar angles of wi as close as this, radians, and so many samples near wi = wo.
inline constexpr double kSameIncidence = kPi / 180;
inline constexpr std::size_t kMinNearby = 3;

/// Whether the samples of a source show a lobe about wi = wo: at most incidences that were measured there
/// (three samples with theta_d up to 1.5 degrees, else up to 3 or 5, their half vectors at least 10 degrees off the
/// normal) they are on the mean more than twice as high as around it (theta_d of 4 to 8 degrees, or that much wider).
bool backscatters(const SampleSource& source);

/// The theta_d below which samples weigh more where a source backscatters, radians; HomomorphicOptions::backscatter.
inline constexpr double kBackscatterReach = 0.03;

/// The lobe of at most `bytes`, see model_bytes, that predicts held-out samples best: p(wo) p(wi) q(h) m(theta_m)
/// r(theta_d), p and q hemispheres where the source is anisotropic, or fewer of these factors where the bytes are few;
/// with options.backscatter also p(wo) p(wi) q(h) k(theta_m,theta_d) b(theta_h,theta_d) a(theta_d,phi_d), or those of
/// its factors that fetches and bytes hold. Smoothness is chosen by choose_smoothness for a coarse model, unless
/// `smooth` says it; finer ones with a smoothness nearby, of isotropic sources also one whose p tells incidences 1.4
/// degrees apart, where a quarter of the texels hold that, are taken where they predict better. More than three
/// channels are represented by three of them in these trials, and all decide in the end. Sources of more than
/// kManySamples samples get the finest that the bytes hold, or with options.backscatter the last of these lobes, smooth
/// 1e-7, where that predicts better. The samples of `source` stand for their swapped pairs too: the models are
/// reciprocal. Tables are in `format`; without one they are half, or rgb9e5 where that predicts better. The same bits
/// for any number of threads. Throws Error if bytes < least_scattered_bytes of the format, and what fit_homomorphic
/// throws. With `fetches` > 0 the lobe has at most so many.
ScatteredPlan plan_scattered(const SampleSource& source, std::size_t bytes, std::optional<double> smooth,
                             std::optional<TableFormat> format, const HomomorphicOptions& options,
                             int fetches = 0);

}  // namespace burnish
