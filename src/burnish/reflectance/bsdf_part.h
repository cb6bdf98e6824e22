// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace burnish {

/// One of the four functions of a surface that reflects and transmits. The side is the one that the light comes from,
/// in the words of the file: "Transmission Front" is the share of light on the front that passes through.
///
/// All parts have the directions of a reflection: z points to the light's side, x and y are the file's on both sides.
///
/// The direction wo of a transmission is mirrored through the surface: (x, y, -z) in the place of (x, y, z). Light that
/// passes straight on then has wo = mirror(wi).
enum class BsdfPart { reflection_front, reflection_back, transmission_front, transmission_back };

/// All of them, in the order in which they are chosen where none is asked for.
inline constexpr std::array kBsdfParts{BsdfPart::reflection_front, BsdfPart::reflection_back,
                                       BsdfPart::transmission_front, BsdfPart::transmission_back};

/// "reflection-front" and so on: the words of `--part`.
std::string_view to_string(BsdfPart part) noexcept;
/// The part of such a name; nothing for another text.
std::optional<BsdfPart> find_bsdf_part(std::string_view name) noexcept;

constexpr bool is_transmission(BsdfPart part) noexcept {
  return part == BsdfPart::transmission_front || part == BsdfPart::transmission_back;
}

constexpr bool is_back(BsdfPart part) noexcept {
  return part == BsdfPart::reflection_back || part == BsdfPart::transmission_back;
}

/// A part in one band of wavelengths: "Visible", "Solar", "NIR", "CIE-XYZ", ...; empty where a file names none.
struct BsdfBlock {
  BsdfPart part = BsdfPart::reflection_front;
  std::string band;

  friend bool operator==(const BsdfBlock&, const BsdfBlock&) = default;
};

/// "transmission-front (Visible)", without a band "transmission-front".
std::string to_string(const BsdfBlock& block);

}  // namespace burnish
