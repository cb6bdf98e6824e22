// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/io/byte_reader.h>

namespace burnish {

/// Element type of a tensor, numbered as in the file.
enum class TensorType : std::uint8_t { u8 = 1, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 };

/// Return the name of a type ("f32") and the bytes of one element.
std::string_view name_of(TensorType type) noexcept;
std::size_t size_of(TensorType type) noexcept;

/// One named array of a tensor file, last index fastest. It refers to the bytes that it was read from.
struct Tensor {
  std::string name;
  TensorType type = TensorType::u8;
  std::vector<std::uint64_t> shape;  ///< the product of the lengths times size_of(type) is data.size()
  std::span<const std::byte> data;   ///< little-endian, not aligned
  std::uint64_t offset = 0;          ///< place of the data in the file; ignored when writing
};

/// Returns true if `head`, the first bytes of a file, starts a tensor file.
bool looks_like_tensor_file(std::span<const std::byte> head) noexcept;

/// Reads the container of the RGL material database, version 1.0: the signature, then for each field its
/// name, type, offset and shape. The tensors refer to `file`. Throws Error for another version, an unknown
/// type, an empty or repeated name and a shape whose size overflows. Throws Error too for data that reach
/// into the header, beyond the end of the file or into other data.
std::vector<Tensor> parse_tensor_file(const FileBytes& file);

/// Returns the file that holds `tensors`, each aligned to 8 bytes. Domain: what parse_tensor_file accepts (asserted).
std::string format_tensor_file(std::span<const Tensor> tensors);

}  // namespace burnish
