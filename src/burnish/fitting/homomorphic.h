#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// The weight of a row, log f of one sample and channel, is sample weight * (f / (f + floor))^2 * (1 + image
/// * y^2):
/// - the first makes the error in log f the error in log(f + floor), so that values far below the floor,
/// where
///   instruments see noise, do not bend the factors;
/// - y = min(1, f cos(theta_i) / white)^(1 / 2.2) is the brightness of a lit pixel; `image` moves the fit
/// from equal
///   relative error everywhere (0) to the error seen in a picture.
struct RowWeights {
  double floor = 1e-3;  ///< 1/sr, > 0
  double image = 0;     ///< >= 0
  double white = 0;     ///< radiance shown as 1, > 0; 0: taken from the samples, see fit_homomorphic
};

struct HomomorphicOptions {
  /// Weight of the smoothness term against a unit of data: the mean squared error in log f plus
  /// smooth * (sum over tables of the integrated squared second derivatives of log lambda over the unit
  /// interval or square). >= 0; larger is smoother.
  double smooth = 1e-6;
  RowWeights weights;
  TableFormat format = TableFormat::half;
  int max_iterations = 300;  ///< of conjugate gradients (2-D tables); 1-D tables are solved directly
  double tolerance = 1e-3;   ///< conjugate gradients stop when the preconditioned residual fell to this share
  std::function<void(double fraction)>
      progress;  ///< called with rising shares of the work done, from this thread
};

struct HomomorphicSummary {
  std::size_t samples = 0;   ///< samples with weight
  std::size_t unknowns = 0;  ///< texels of all channels
  double error_before = 0;   ///< weighted rms of log f about its mean: the error of the best constant
  double error_after = 0;   ///< weighted rms of log f - log of the model, before rounding to the table format
  int iterations = 0;       ///< of conjugate gradients; 0 for a direct solution
  std::string stop_reason;  ///< "direct solution", "tolerance reached", "iteration limit"
  double smooth = 0;        ///< as used
  double white = 0;         ///< as used
};

struct HomomorphicFit {
  FactoredBrdf brdf;
  HomomorphicSummary summary;
};

/// Fits one lobe by homomorphic factorization: log f = sum of log lambda_k(pi_k) [homomorphic factorization,
/// eq. 5] is one linear row a sample and channel, with the (bi)linear weights of the texels it touches;
/// weighted least squares with a smoothness term that also fills texels that no sample touches. Values <= 0
/// count as 1e-6 of the floor (their weight is next to nothing). Small 1-D models are solved directly by
/// normal equations gathered in one pass, others by matrix-free conjugate gradients with a diagonal
/// preconditioner. The result depends on neither the number of threads nor their timing. Where weights.white
/// is 0, white is the 97th percentile of f cos(theta_i) over samples with theta_i and theta_o below 60
/// degrees weighted by the solid angle of h, an estimate of what a lit sphere shows. Throws Error if the spec
/// has no or several lobes, or no sample has weight.
HomomorphicFit fit_homomorphic(const SampleSource& source, const ModelSpec& spec,
                               const HomomorphicOptions& options);

}  // namespace burnish
