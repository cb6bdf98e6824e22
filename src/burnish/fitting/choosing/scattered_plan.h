#pragma once

#include <cstddef>
#include <optional>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// A lobe for scattered samples.
struct ScatteredPlan {
  ModelSpec spec;     ///< with the share of the smoothness that each table takes
  double smooth = 0;  ///< of HomomorphicOptions
  /// held_out_error of it; none for more than kManySamples samples.
  std::optional<double> error;
  TableFormat format = TableFormat::half;  ///< of all tables
};

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
