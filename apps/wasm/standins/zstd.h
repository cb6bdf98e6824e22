// SPDX-License-Identifier: Apache-2.0
#pragma once

// This header stands in for Zstandard. Its frames hold the input uncompressed, which every reader of the format
// accepts.
// Source: RFC 8878, 3.1.1.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

constexpr std::size_t kZstdBlock = std::size_t{1} << 17, kZstdHead = 13;

inline std::size_t ZSTD_compressBound(std::size_t size) {
  return kZstdHead + size + 3 * (size / kZstdBlock + 1);
}

inline std::size_t ZSTD_compress(void* to, std::size_t, const void* from, std::size_t size, int) {
  unsigned char* out = static_cast<unsigned char*>(to);
  const unsigned char* in = static_cast<const unsigned char*>(from);
  // The frame's head has the magic number, then one segment with its size in eight bytes.
  for (const unsigned char byte : {0x28, 0xB5, 0x2F, 0xFD, 0xE0}) *out++ = byte;
  for (int i = 0; i < 8; ++i) *out++ = static_cast<unsigned char>(std::uint64_t{size} >> (8 * i));
  // The data follow in raw blocks.
  std::size_t left = size;
  do {
    const std::size_t block = std::min(left, kZstdBlock);
    left -= block;
    const std::size_t head = (block << 3) | (left == 0 ? 1 : 0);
    for (int i = 0; i < 3; ++i) *out++ = static_cast<unsigned char>(head >> (8 * i));
    std::memcpy(out, in, block);
    out += block;
    in += block;
  } while (left > 0);
  return static_cast<std::size_t>(out - static_cast<unsigned char*>(to));
}

inline unsigned ZSTD_isError(std::size_t) {
  return 0;
}

inline const char* ZSTD_getErrorName(std::size_t) {
  return "";
}
