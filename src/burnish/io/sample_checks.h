// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Warns if, at most incidences, the largest value lies near phi_o = phi_i and is twice the largest value of the other
/// side. The file may then count azimuths the other way, or the material sends light back. Incidences of fewer than
/// eight samples are passed over.
void check_azimuths(const Samples& samples, Findings& findings);

/// Decides whether samples at several phi_i are isotropic, if the file does not say so. Takes the symmetry under which
/// samples predict each other better, see isotropy_errors. Fewer than two dozen samples stay anisotropic. Returns one
/// sentence with the reason.
std::string settle_isotropy(Samples& samples);

/// Decides the sign of polar angles of samples in the plane of incidence, read as if both were counted towards one
/// side. Turns all wo by half a circle if the largest values lie at theta_o = theta_i. Returns one sentence that
/// states the mirror direction.
std::string settle_plane(Samples& samples);

}  // namespace burnish
