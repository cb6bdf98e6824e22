// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <burnish/eval/factored_eval.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sampling.h>

namespace burnish {

/// Directions to the viewer and uniform numbers in [0, 1), one array a component, all of one length.
struct DrawSpans {
  std::span<const float> wo_x, wo_y, wo_z, u_x, u_y;

  std::size_t size() const noexcept { return wo_x.size(); }
};

/// The directions that are drawn, with their densities.
struct DrawnSpans {
  std::span<float> wi_x, wi_y, wi_z, pdf;
};

/// Sizes of a sampler's tables.
struct SamplerOptions {
  int wo_thetas = 16;  ///< polar angles of wo, 2 to 256
  int wo_phis = 16;    ///< azimuths of wo, 2 to 256; 1 for isotropic BRDFs
  int rows = 16;       ///< cells along the azimuth of the half vector, a power of two, 8 to 256
  int columns = 16;    ///< cells along its polar angle, a power of two, 8 to 256
};

/// Returns the sizes that docs/guide/evaluation.md recommends.
SamplerOptions default_sampler_options(bool isotropic) noexcept;

/// A sampler's tables, for programs that draw directions themselves (a shader, a tracer that compiles its own code).
/// eval/sampler_expression.h gives the formulas as graphs. Valid as long as the sampler or a copy of it.
struct SamplerTables {
  bool isotropic = true;
  double sharpness = 0, share = 0, xx = 1, xy = 0, yy = 1;  ///< see VisibleHalfMap
  int thetas = 0, phis = 0, rows = 0, columns = 0;          ///< see SamplerOptions
  double theta_scale = 0, ring_reach = 0;  ///< rings of wo per t / (ring_reach - t), t = tan(theta_o / 2)
  /// Cumulative masses in 1/65536: of the rows of a slice, and of the cells of a row. Slices and rows follow each
  /// other; an entry 0 ends each table.
  std::span<const std::uint16_t> row_edges, cell_edges;
};

/// Draws directions nearly in proportion to f_r cos(theta_i), for all lobes at once. The constructor finds the root
/// mean square of the light reflected towards wo in cells of half vectors. This mass minimizes the second moment of
/// the weights. A draw is two searches in 16-bit tables and a map in closed form. Cells cover exactly the half
/// vectors that are visible from wo and whose mirror direction lies above the horizon, so no draw is wasted. They are
/// narrow at the material's highlights. Densities are interpolated between the wo of the tables. Satisfies
/// DirectionSampler.
///
/// Takes any BRDF, factored or measured. If its isotropic() is true, both sides of the plane of wo and the normal are
/// drawn alike, by their mean. If the sides differ, draws stay unbiased, but weights are as uneven as the sides.
/// Never allocates after construction. Copies share the tables, and threads may share a copy. u.x turns the half
/// vector about the normal and u.y tilts it, both without jumps, so that stratified points stay stratified.
class TabulatedSampler {
 public:
  explicit TabulatedSampler(BrdfRef brdf);
  /// Throws Error for sizes out of range.
  TabulatedSampler(BrdfRef brdf, const SamplerOptions& options);

  /// Computes in float: directions are within 1e-4, and densities within 1e-3, of the formulas in double. Draws that
  /// rounding moves across the border of a cell are exceptions.
  DrawnDirection sample_wi(Vec3 wo, Point2 u) const noexcept;
  double pdf(Vec3 wi, Vec3 wo) const noexcept;

  /// Draws many directions at a time in float, with the widest vectors of the processor; all spans have one length.
  void sample_wi(const DrawSpans& in, const DrawnSpans& out) const noexcept;
  /// Finds pdf[i] of pair i; directions are unit vectors.
  void pdf(const DirectionSpans& directions, std::span<float> pdf) const noexcept;

  SamplerTables tables() const noexcept;
  /// Bytes of the tables.
  std::size_t bytes() const noexcept;

 private:
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

static_assert(DirectionSampler<TabulatedSampler>);

}  // namespace burnish
