// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/rgl_table.h>

namespace burnish {

/// Sizes of a table that make_rgl_table makes. Counts are at least 2 (phi_i of an isotropic source: ignored).
struct RglOptions {
  int theta_i_count = 16;  ///< incident polar angles, evenly from 0 to pi/2
  int phi_i_count = 17;    ///< incident azimuths of anisotropic sources, evenly, both ends included
  int reduction = 1;       ///< anisotropic sources that repeat: 2 by rotation by pi, 4 by two mirror planes
  int ndf_theta = 128;     ///< columns of the normal distribution and of the visible normals
  int ndf_phi = 128;       ///< rows of the normal distribution (2 if isotropic) and of the visible normals
  int resolution = 32;     ///< rows and columns of the spectra
  int iterations = 8;      ///< of the power iteration
  std::vector<double> lambda_nm;  ///< of the source's channels; empty for RGB or grey
  std::string description;
};

/// Samples `source` in the adaptive parameterization of the RGL database.
/// The normal distribution D follows from retro-reflection, f(w, w) = D(w) / (4 sigma(w) cos theta) up to
/// Fresnel's factor, with sigma(w) = integral of D(m) max(0, m.w) dm: the power iteration
/// D <- f(w, w) cos theta sigma(w), scaled to integral of D cos theta = 1, floored at 1e-6 of its peak.
/// D decides where the samples lie, not what they are: at the table's nodes eval returns the source's values
/// (to single precision). Where the source knows nothing or wo is below the horizon, nodes take the mean of
/// their neighbours and are marked not valid. Incident angles above 89 degrees are sampled at 89. Throws
/// Error for sizes below their least, a reduction other than 1, 2, 4, or a source with other than 1, 3 or
/// lambda_nm.size() channels. Source: [Dupuy 2018, sec. 4].
RglTable make_rgl_table(BrdfRef source, const RglOptions& options = {});

}  // namespace burnish
