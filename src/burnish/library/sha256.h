// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace burnish {

/// SHA-256 of bytes that come in parts. Source: [FIPS180-4].
class Sha256 {
 public:
  void add(std::span<const std::byte> bytes) noexcept;
  void add(std::string_view text) noexcept { add(std::as_bytes(std::span(text))); }
  /// The digest of all that was added, 64 lower-case hexadecimal digits. Nothing can be added afterwards.
  std::string hex() noexcept;

 private:
  void block(const std::byte* bytes) noexcept;

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> waiting_{};
  std::uint64_t count_ = 0;  // bytes added
};

/// Sha256 of one text.
std::string sha256(std::string_view text);

}  // namespace burnish
