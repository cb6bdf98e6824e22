#pragma once

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sample_source.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// What is expected about wi = wo where an instrument did not stand, of a source that has samples there at few
/// incidences: pairs whose wi lies in the middle of the gaps between these, or between the normal and the first, and
/// whose wo lies up to 10 degrees from it. Their values are those of `fitted`, a model of the source, at the same
/// distance from wi and on the same side at the next incidences: logarithms linear in theta_i between two, constant up
/// to the normal. None in gaps of less than 5 degrees. Isotropic sources only. Without it a product of factors is free
/// there, each of which is told where others are not: a tape was 3 times as high half way to the normal as at the first.
Samples between_incidences(const SampleSource& source, BrdfRef fitted);

/// The source's samples, then some others of a weight of their own. Both must outlive the result.
SampleSource with_expected(const SampleSource& source, const Samples& expected, double weight);

}  // namespace burnish
