// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <limits>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/factors/cbor.h>
#include <burnish/factors/compact_file.h>

namespace burnish {

namespace {

constexpr int kCheckpointVersion = 3;
constexpr std::string_view kName = "burnish fit", kNameOfLobes = "burnish lobes";
constexpr std::size_t kParts = 14, kPartsOfLobes = 13, kErrorItems = 4;
constexpr std::size_t kMaxTables = 1024;
constexpr std::int64_t kMaxInteger = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t kLongestText = 4096;

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

// Writes the items that both kinds of checkpoint begin with.
void put_head(CborWriter& cbor, std::size_t parts, std::string_view name, std::uint64_t key) {
  cbor.list(parts);
  cbor.text(name);
  cbor.integer(kCheckpointVersion);
  cbor.integer(static_cast<std::int64_t>(key >> 1));
}
// Reads the key, after the list's count.
std::uint64_t key_from(CborReader& cbor, std::string_view name, const char* expected) {
  if (cbor.text("its name", name.size()) != name) cbor.fail(0, expected, "another file");
  cbor.integer("its version", kCheckpointVersion, kCheckpointVersion);
  return static_cast<std::uint64_t>(cbor.integer("its key", 0, kMaxInteger)) << 1;
}

// Writes numbers and letters as they lie in memory, after their count. Names of files, and messages with names in
// them, may hold any bytes that the system allows.
template <class T>
void put_values(CborWriter& cbor, std::span<const T> values) {
  cbor.integer(static_cast<std::int64_t>(values.size()));
  cbor.bytes(std::as_bytes(values));
}
template <class T>
std::vector<T> values_from(CborReader& cbor, std::size_t most, const char* what) {
  const auto count = static_cast<std::size_t>(cbor.integer(what, 0, static_cast<std::int64_t>(most)));
  const auto bytes = cbor.bytes(what, std::uint64_t{count} * sizeof(T));
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}
void put_name(CborWriter& cbor, std::string_view name) {
  put_values<char>(cbor, name.substr(0, kLongestText));
}
std::string name_from(CborReader& cbor, const char* what) {
  const std::vector<char> name = values_from<char>(cbor, kLongestText, what);
  return {name.begin(), name.end()};
}

}  // namespace

std::string format_checkpoint(const LobesCheckpoint& checkpoint) {
  CborWriter cbor;
  put_head(cbor, kPartsOfLobes, kNameOfLobes, checkpoint.key);
  cbor.integer(checkpoint.rounds);
  cbor.list(2 * checkpoint.log_values.size());
  for (const std::vector<double>& table : checkpoint.log_values) put_values<double>(cbor, table);
  for (const auto* values : {&checkpoint.fits.weights, &checkpoint.fits.normals, &checkpoint.fits.trust,
                             &checkpoint.normals_of_all})
    put_values<float>(cbor, *values);
  return cbor.written();
}

std::optional<LobesCheckpoint> parse_lobes_checkpoint(const FileBytes& file) {
  CborReader cbor(file);
  if (cbor.list("a checkpoint", kPartsOfLobes, kParts) != kPartsOfLobes) return std::nullopt;
  LobesCheckpoint read;
  read.key = key_from(cbor, kNameOfLobes, "a checkpoint of a surface's lobes");
  read.rounds = static_cast<int>(cbor.integer("rounds", 1, std::numeric_limits<int>::max()));
  for (std::size_t left = cbor.list("tables", 2, 2 * kMaxTables) / 2; left > 0; --left)
    read.log_values.push_back(values_from<double>(cbor, file.bytes.size() / sizeof(double), "a table"));
  for (auto* values : {&read.fits.weights, &read.fits.normals, &read.fits.trust, &read.normals_of_all})
    *values = values_from<float>(cbor, file.bytes.size() / sizeof(float), "what texels were found to be");
  cbor.end();
  return read;
}

std::string format_checkpoint(const FitCheckpoint& checkpoint) {
  CborWriter cbor;
  put_head(cbor, kParts, kName, checkpoint.key);
  cbor.list(4 * checkpoint.damaged.size());
  for (const auto& [file, why] : checkpoint.damaged) {
    put_name(cbor, file);
    put_name(cbor, why);
  }
  cbor.integer(static_cast<std::int64_t>(checkpoint.missing_pixels));
  cbor.integer(static_cast<std::int64_t>(checkpoint.clipped_pixels));
  cbor.number(checkpoint.exposure);
  const std::string lobes = format_compact({.brdf = checkpoint.lobes, .lambda_nm = {}});
  cbor.integer(static_cast<std::int64_t>(lobes.size()));
  cbor.bytes(std::as_bytes(std::span(lobes)));
  cbor.list(checkpoint.scales.size());
  for (const float scale : checkpoint.scales) cbor.number(static_cast<double>(scale));
  cbor.integer(checkpoint.rows);
  // The codes of all lobes come first, then the normals.
  cbor.list(checkpoint.codes.size() + !checkpoint.normals.empty());
  for (const auto& codes : checkpoint.codes) cbor.bytes(codes);
  if (!checkpoint.normals.empty()) cbor.bytes(bytes_of(checkpoint.normals));
  cbor.integer(static_cast<std::int64_t>(checkpoint.texels_without_data));
  cbor.list(kErrorItems * checkpoint.errors.size());
  for (const auto& error : checkpoint.errors)
    for (const std::uint64_t sum : {error.seen, error.all, error.seen_count, error.all_count})
      cbor.integer(static_cast<std::int64_t>(sum));
  return cbor.written();
}

FitCheckpoint parse_checkpoint(const FileBytes& file, int width) {
  CborReader cbor(file);
  FitCheckpoint read;
  cbor.list("a checkpoint", kParts, kParts);
  read.key = key_from(cbor, kName, "a checkpoint of a surface's fit");
  for (std::size_t left = cbor.list("damaged pictures", 0, 4 * kMaxPictures) / 4; left > 0; --left) {
    std::string name = name_from(cbor, "a picture");
    read.damaged.push_back({std::move(name), name_from(cbor, "what is damaged")});
  }
  read.missing_pixels = static_cast<std::uint64_t>(cbor.integer("missing pixels", 0, kMaxInteger));
  read.clipped_pixels = static_cast<std::uint64_t>(cbor.integer("clipped pixels", 0, kMaxInteger));
  read.exposure = cbor.number("the exposure");
  const auto size = static_cast<std::uint64_t>(cbor.integer("the size of the lobes", 0, kMaxInteger));
  const auto lobes = cbor.bytes("the lobes", size);
  read.lobes = parse_compact({file.name + ": its lobes", {lobes.begin(), lobes.end()}}).brdf;
  const std::size_t count = read.lobes.lobes().size();
  read.scales.resize(cbor.list("scales", count, count));
  for (float& scale : read.scales) scale = static_cast<float>(cbor.number("a scale"));
  read.rows = static_cast<int>(cbor.integer("rows", 0, kMaxMapSide));
  const auto texels = static_cast<std::uint64_t>(read.rows) * static_cast<std::uint64_t>(width);
  const std::size_t maps = cbor.list("codes and normals", count, count + 1);
  for (std::size_t j = 0; j < count; ++j) {
    const auto codes = cbor.bytes("a lobe's codes", texels);
    read.codes.emplace_back(codes.begin(), codes.end());
  }
  if (maps > count) {
    const auto normals = cbor.bytes("normals", texels * 2 * sizeof(float));
    read.normals.resize(texels * 2);
    std::memcpy(read.normals.data(), normals.data(), normals.size());
  }
  read.texels_without_data =
      static_cast<std::uint64_t>(cbor.integer("texels without data", 0, static_cast<std::int64_t>(texels)));
  read.errors.resize(cbor.list("errors", 0, kErrorItems * kMaxPictures) / kErrorItems);
  for (auto& error : read.errors)
    for (std::uint64_t* sum : {&error.seen, &error.all, &error.seen_count, &error.all_count})
      *sum = static_cast<std::uint64_t>(cbor.integer("an error", 0, kMaxInteger));
  cbor.end();
  return read;
}

}  // namespace burnish
