// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <burnish/factors/byte_count.h>
#include <burnish/factors/factored_brdf.h>

namespace burnish {

namespace {

/// Counts a spec whose tables have texels of texel_bytes_of(table).
template <class TexelBytes>
std::size_t counted(const ModelSpec& spec, std::size_t channels, const TexelBytes& texel_bytes_of) noexcept {
  ByteCount count;
  for (const ModelSpec::TableSpec& table : spec.tables) count.add_table(table.layout, texel_bytes_of(table));
  for (const std::vector<FactorUse>& lobe : spec.lobes) {
    count.add_lobe(channels);
    for (const FactorUse& use : lobe) count.add_use(use, spec.tables[use.table].layout.shape);
  }
  return count.bytes();
}

}  // namespace

void ByteCount::add_table(const TableLayout& layout, std::size_t texel_bytes) noexcept {
  const int axes = projection_count(layout.shape);
  texels_ += layout.node_count() * texel_bytes;
  numbers_ += layout.warp.kind != WarpKind::identity;
  numbers_ += axes > 1 && layout.warp_y.kind != WarpKind::identity;
  numbers_ += axes > 2 && layout.warp_z.kind != WarpKind::identity;
}

void ByteCount::add_use(const FactorUse& use, TableShape shape) noexcept {
  const int axes = projection_count(shape);
  numbers_ += coefficient_count(use.projection);
  if (axes > 1) numbers_ += coefficient_count(use.projection_y);
  if (axes > 2) numbers_ += coefficient_count(use.projection_z);
}

std::size_t model_bytes(const ModelSpec& spec, std::size_t channels, TableFormat general) noexcept {
  return counted(spec, channels, [&](const ModelSpec::TableSpec& table) {
    return texel_bytes(format_of(table, general), table.shared ? 1 : channels);
  });
}

std::size_t model_bytes(const ModelSpec& spec, std::size_t channels, std::size_t texel_bytes) noexcept {
  return counted(spec, channels, [&](const ModelSpec::TableSpec& table) {
    return table.shared ? shared_texel_bytes(channels, texel_bytes) : texel_bytes;
  });
}

std::size_t shared_texel_bytes(std::size_t channels, std::size_t texel_bytes) noexcept {
  const bool shared_exponent = channels == 3 && texel_bytes == 4;
  return shared_exponent ? 2 : texel_bytes / channels;
}

}  // namespace burnish
