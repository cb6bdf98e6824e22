// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <burnish/reflectance/bsdf_part.h>

namespace burnish {

std::string_view to_string(BsdfPart part) noexcept {
  constexpr std::string_view kNames[] = {"reflection-front", "reflection-back", "transmission-front",
                                         "transmission-back"};
  return kNames[static_cast<std::size_t>(part)];
}

std::optional<BsdfPart> find_bsdf_part(std::string_view name) noexcept {
  for (const BsdfPart part : kBsdfParts)
    if (to_string(part) == name) return part;
  return std::nullopt;
}

std::string to_string(const BsdfBlock& block) {
  std::string text(to_string(block.part));
  if (!block.band.empty()) text += " (" + block.band + ")";
  return text;
}

}  // namespace burnish
