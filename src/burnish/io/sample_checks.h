#pragma once

#include <string>

#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Warns where, at most incidences, the largest value lies near phi_o = phi_i and is twice what the other side has:
/// the file may count azimuths the other way, or the material sends light back. Incidences of fewer than eight samples
/// are passed over.
void check_azimuths(const Samples& samples, Findings& findings);

/// Of samples at several phi_i, of which the file does not say whether they are isotropic: sets what predicts samples by
/// each other better, see isotropy_errors. One sentence says why. Fewer than two dozen stay anisotropic.
std::string settle_isotropy(Samples& samples);

/// Of samples in the plane of incidence, read as if both polar angles were counted towards one side: turns all wo by
/// half a circle where the largest values lie at theta_o = theta_i. One sentence says where the mirror direction is.
std::string settle_plane(Samples& samples);

}  // namespace burnish
