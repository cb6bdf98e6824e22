// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/image/image.h>
#include <burnish/math/rgb.h>

namespace burnish {

/// The ways to turn linear values into bytes:
/// - srgb: clamped to [0, 1] and encoded by the transfer function of [IEC61966];
/// - aces: before that the filmic curve x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) [Narkowicz 2016].
enum class Tone { srgb, aces };

/// Three channels of linear Rec. 709, times `exposure`, as bytes. Throws Error for other channels.
Image8 to_bytes(const Image& image, double exposure, Tone tone);

/// The exposure that makes the 97th percentile of the values, pixels of the background left out, 1; 1 where
/// that percentile is 0 or nothing is left. Throws Error for other channels than three.
double automatic_exposure(const Image& image, Rgb background);

/// An OpenEXR file of floats R, G, B. Throws Error for other channels than three.
std::string encode_exr(const Image& image);

}  // namespace burnish
