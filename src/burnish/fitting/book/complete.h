// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <burnish/book/material_book.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// The prior of a material before it is measured, on one or two axes of colour, chosen by what the pairs make
/// likeliest.
struct CompletionPrior {
  /// True: the material is near one of the library's materials, unknown which. False: it is near their mean.
  bool near_one = false;
  double spread = 1;    ///< how near: multiplies the deviations of the library's weights
  double residual = 1;  ///< multiplies the variance of what the book's components leave
  double noise =
      1e-3;  ///< variance of a measured logarithm, the larger the nearer a direction is to the horizon

  friend bool operator==(const CompletionPrior&, const CompletionPrior&) = default;
};

/// The result of a completion.
struct CompletionReport {
  std::size_t samples = 0;             ///< pairs above the horizon
  std::size_t used = 0;                ///< of these, evenly: at most kMaxCompletionPairs
  std::size_t materials = 0;           ///< in the book
  CompletionPrior brightness, colour;  ///< the likeliest; what was likely beside these had its share
  std::string nearest;  ///< the likeliest of the library's materials in brightness, where it is near one
  /// exp(mean |ln((f + floor) / (model + floor))|) - 1 at the pairs, and of each one left out in turn, where what is
  /// believed counts for what the others say of it; floor as in the figure `relative`.
  double relative = 0, relative_left_out = 0;
};

inline constexpr std::size_t kMaxCompletionPairs = 1000;

struct Completion {
  FactoredBrdf brdf;  ///< of brdf_of_logs: reciprocal and positive, two fetches
  CompletionReport report;
};

/// Completes a few measured pairs by what a book's materials have in common: the mean of a Gaussian process given
/// the pairs [Rasmussen 2006, eq. 2.23]. A material's logarithm is the book's mean, or that of one of its
/// materials, plus its components with normal weights, plus what is smooth and not in the book, plus noise; how far
/// each may go (CompletionPrior) is weighed by how likely it makes the pairs [Rasmussen 2006, eq. 5.8], of a list of
/// values. Far from pairs the book speaks, near them they do. The same bits whatever the number of threads. Throws
/// Error where the samples are anisotropic, have neither one channel (grey) nor three, or none lies above the horizon,
/// and where the book has no materials.
Completion complete(const MaterialBook& book, const Samples& samples,
                    TableFormat format = TableFormat::rgb9e5);

}  // namespace burnish
