// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <limits>

#include <fmt/format.h>

#include <burnish/io/tensor_file.h>

namespace burnish {
namespace {

constexpr std::string_view kSignature("tensor_file\0", 12);
constexpr std::uint64_t kAlignment = 8;
// The smallest field has a name's length, one byte of name, dimensions, type and offset.
constexpr std::uint64_t kMinField = 2 + 1 + 2 + 1 + 8;

struct TypeInfo {
  std::string_view name;
  std::size_t size;
};
constexpr TypeInfo kTypes[] = {{"u8", 1},  {"i8", 1},  {"u16", 2}, {"i16", 2}, {"u32", 4}, {"i32", 4},
                               {"u64", 8}, {"i64", 8}, {"f16", 2}, {"f32", 4}, {"f64", 8}};

const TypeInfo& info_of(TensorType type) noexcept {
  return kTypes[static_cast<std::size_t>(type) - 1];
}

std::string field_name(std::string_view name) {
  std::string result(name.substr(0, 40));
  std::replace_if(
      result.begin(), result.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return result;
}

Tensor parse_field(const FileBytes& file, ByteReader& reader) {
  Tensor tensor;
  const auto name_length = reader.number<std::uint16_t>("a name's length");
  if (name_length == 0) reader.fail("a field's name", "an empty name");
  const auto name = reader.take(name_length, "a field's name");
  tensor.name.assign(reinterpret_cast<const char*>(name.data()), name.size());

  const auto dimensions = reader.number<std::uint16_t>("a number of dimensions");
  const auto type = reader.number<std::uint8_t>("a type");
  if (type < 1 || type > std::size(kTypes))
    reader.fail(fmt::format("a type from 1 to {} for {}", std::size(kTypes), field_name(tensor.name)),
                std::to_string(type));
  tensor.type = static_cast<TensorType>(type);
  tensor.offset = reader.number<std::uint64_t>("a data offset");

  // The product of lengths may neither overflow nor exceed the file.
  reader.require(std::uint64_t{8} * dimensions, "shape");
  std::uint64_t bytes = size_of(tensor.type);
  for (int d = 0; d < dimensions; ++d) {
    const auto length = reader.number<std::uint64_t>("shape");
    if (length > 0 && bytes > reader.size() / length)
      reader.fail(fmt::format("a shape of {} that fits in {} bytes", field_name(tensor.name), reader.size()),
                  fmt::format("{} entries in dimension {}", length, d));
    bytes *= length;
    tensor.shape.push_back(length);
  }
  if (tensor.offset > reader.size() || bytes > reader.size() - tensor.offset)
    reader.fail(fmt::format("{} bytes of {} within {} bytes", bytes, field_name(tensor.name), reader.size()),
                fmt::format("offset {}", tensor.offset));
  tensor.data = std::span(file.bytes).subspan(tensor.offset, bytes);
  return tensor;
}

}  // namespace

std::string_view name_of(TensorType type) noexcept {
  return info_of(type).name;
}
std::size_t size_of(TensorType type) noexcept {
  return info_of(type).size;
}

bool looks_like_tensor_file(std::span<const std::byte> head) noexcept {
  return head.size() >= kSignature.size() &&
         std::string_view(reinterpret_cast<const char*>(head.data()), kSignature.size()) == kSignature;
}

std::vector<Tensor> parse_tensor_file(const FileBytes& file) {
  ByteReader reader(file);
  if (!looks_like_tensor_file(reader.take(kSignature.size(), "a tensor file's signature")))
    throw Error(file.name, 0, "a tensor file's signature", "other bytes");
  const auto major = reader.number<std::uint8_t>("a version"),
             minor = reader.number<std::uint8_t>("a version");
  // One of the two numbers is enough, as in Mitsuba.
  if (major != 1 && minor != 0) reader.fail("version 1.0", fmt::format("{}.{}", major, minor));
  const auto count = reader.number<std::uint32_t>("a number of fields");
  if (count > reader.remaining() / kMinField)
    reader.fail("fields within the file", fmt::format("{} fields", count));

  std::vector<Tensor> tensors;
  tensors.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) tensors.push_back(parse_field(file, reader));

  // Sorting by name shows a repeated one.
  std::vector<const Tensor*> order;
  for (const Tensor& tensor : tensors) order.push_back(&tensor);
  std::sort(order.begin(), order.end(), [](auto* a, auto* b) { return a->name < b->name; });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (order[i]->name == order[i - 1]->name)
      throw Error::in_file(file.name, "each field once", "two fields named " + field_name(order[i]->name));

  // From front to back, each tensor's data start at or behind the end of the header and of the data before.
  std::sort(order.begin(), order.end(), [](auto* a, auto* b) {
    return std::pair(a->offset, a->data.size()) < std::pair(b->offset, b->data.size());
  });
  std::uint64_t end = reader.offset();
  for (const Tensor* tensor : order) {
    if (tensor->offset < end)
      throw Error(file.name, tensor->offset,
                  fmt::format("data of {} from offset {} on", field_name(tensor->name), end),
                  "the header's or another field's bytes");
    end = tensor->offset + tensor->data.size();
  }
  return tensors;
}

std::string format_tensor_file(std::span<const Tensor> tensors) {
  const auto align = [](std::uint64_t offset) { return (offset + kAlignment - 1) / kAlignment * kAlignment; };
  std::string bytes(kSignature);
  const auto put = [&](auto number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof(number)); };
  put(std::uint8_t{1});
  put(std::uint8_t{0});
  put(static_cast<std::uint32_t>(tensors.size()));

  // The data begin behind the header.
  std::uint64_t offset = bytes.size();
  for (const Tensor& tensor : tensors) offset += kMinField - 1 + tensor.name.size() + 8 * tensor.shape.size();

  // The fields follow.
  std::vector<std::uint64_t> offsets;
  for (const Tensor& tensor : tensors) {
    assert(!tensor.name.empty() && tensor.name.size() <= std::numeric_limits<std::uint16_t>::max());
    offset = align(offset);
    offsets.push_back(offset);
    put(static_cast<std::uint16_t>(tensor.name.size()));
    bytes += tensor.name;
    put(static_cast<std::uint16_t>(tensor.shape.size()));
    put(static_cast<std::uint8_t>(tensor.type));
    put(offset);
    std::uint64_t size = size_of(tensor.type);
    for (std::uint64_t length : tensor.shape) {
      put(length);
      size *= length;
    }
    assert(size == tensor.data.size());
    offset += size;
  }

  // The data follow, each at its offset.
  bytes.reserve(offset);
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    bytes.resize(offsets[i]);
    bytes.append(reinterpret_cast<const char*>(tensors[i].data.data()), tensors[i].data.size());
  }
  return bytes;
}

}  // namespace burnish
