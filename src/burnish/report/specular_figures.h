// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/image/image.h>
#include <burnish/image/svg_plot.h>
#include <burnish/power/power.h>

namespace burnish {

// Figures of the approximations of cos^exponent. All throw Error for an exponent outside a member's range or
// an empty list.

/// The paper's figure 2a for any members and exponents: the power and its approximations over the angle in
/// degrees, from 0 to where every power has fallen to 1/1000.
Plot lobe_figure(std::span<const PowerMethod> methods, std::span<const double> exponents);

/// Figure 2b: relative error approximation / power - 1 in percent over the same angles, cut at +-`limit`
/// percent.
Plot relative_error_figure(std::span<const PowerMethod> methods, std::span<const double> exponents,
                           double limit = 20);

/// Figure 3: largest relative error in percent where the power is at least `level`, over exponents 1 to
/// max_exponent.
Plot max_relative_error_figure(std::span<const PowerMethod> methods, double max_exponent = 512,
                               double level = 0.56);

/// exponent |a(e) - (2 (1 - e^(-1/2)) e - 1/2)| over exponents 1 to 1000, which stays below 0.15 from 2 on.
Plot coefficient_figure();

/// Every member as a point: largest absolute error at this exponent over its cost weight; those that another
/// beats in both are grey.
Plot front_figure(double exponent);

/// Specular lobes on a sphere and their error, grey.
struct SphereFigure {
  Image8 image;           ///< RGB; columns one a method, rows: sphere, centre of the highlight, difference
  double max_difference;  ///< largest |approximation - power| in the pictures: white or black in the last row
};

/// The sphere is lit from 30 degrees right of the viewer, Blinn's cosine at every pixel; the second row
/// magnifies the highlight and raises it to the power 1/2.2 so that its rim, and the Mach band
/// where a clamped lobe meets zero, can be seen; the third shows approximation - power there as grey about
/// 1/2, scaled so that `max_difference` is white. Tiles are `size` pixels wide, 32 to 1024.
SphereFigure sphere_figure(std::span<const PowerMethod> methods, double exponent, int size = 256);

}  // namespace burnish
