// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// Compares the integrals of a table's values over the hemisphere with the totals that its file states, which are one
/// for each azimuth and polar angle of the light, azimuths slowest. The luminance of colours is compared, at a few
/// incidences up to 85 degrees. A difference of more than 5 % is a warning.
void check_totals(const AngleTable& table, std::span<const double> stated, Findings& findings);

/// Scales the values at each incidence to the stated total, as Ansys does. Some incidences take the factor of the
/// incidence before: those without a positive total or integral, and those beyond 85 degrees.
void scale_to_totals(AngleTable& table, std::span<const double> stated, Findings& findings);

/// Scales each channel at each incidence to its own stated total, in the same way. `stated` has the channels of an
/// incidence together; Integra calls them kbdf.
void scale_channels_to_totals(AngleTable& table, std::span<const double> stated, Findings& findings);

}  // namespace burnish
