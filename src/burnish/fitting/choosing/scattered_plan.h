// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// A plan of one lobe for scattered samples.
struct ScatteredPlan {
  ModelSpec spec;     ///< with each table's share of the smoothness
  double smooth = 0;  ///< HomomorphicOptions::smooth
  /// Its held_out_error; none for more than kManySamples samples.
  std::optional<double> error;
  TableFormat format = TableFormat::half;  ///< the format of all tables
};

/// Chooses the lobe of at most `bytes`, see model_bytes, that predicts held-out samples best. Candidates have the
/// factors p(wo) p(wi) q(h) m(theta_m) r(theta_d), or fewer of them if the bytes are few. For an anisotropic source,
/// p and q are hemispheres. With options.backscatter there are also candidates p(wo) p(wi) q(h) k(theta_m,theta_d)
/// b(theta_h,theta_d) a(theta_d,phi_d), or those of these factors that fetches and bytes hold.
///
/// choose_smoothness chooses the smoothness of a coarse model, unless `smooth` is given. Finer models with a similar
/// smoothness are taken if they predict better. For isotropic sources one of them has a p that distinguishes
/// incidences 1.4 degrees apart, if a quarter of the texels hold it. Three channels represent more channels in these
/// trials; all channels decide in the end.
///
/// Sources of more than kManySamples samples get the finest model that the bytes hold. With options.backscatter they
/// get the lobe about wi = wo, with smoothness 1e-7, if it predicts better.
///
/// The samples of `source` represent their swapped pairs too: the models are reciprocal. Tables are in `format`;
/// without one they are in half, or in rgb9e5 if that predicts better. The result has the same bits for any number of
/// threads. With `fetches` > 0 the lobe has at most so many. Throws Error if bytes < least_scattered_bytes of the
/// format, and what fit_homomorphic throws.
ScatteredPlan plan_scattered(const SampleSource& source, std::size_t bytes, std::optional<double> smooth,
                             std::optional<TableFormat> format, const HomomorphicOptions& options,
                             int fetches = 0);

}  // namespace burnish
