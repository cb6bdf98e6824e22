// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/byte_reader.h>
#include <burnish/io/named_row.h>
#include <burnish/io/np.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr NamedRowKind kCodes{NpBrdf::kCode, "number", "encoding", "np:FILE#NAME"};
constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;  // limit of each of the two files

}  // namespace

bool looks_like_np(std::string_view text) noexcept {
  std::string_view line = first_content_line(text);
  if (std::count(line.begin(), line.end(), ',') != static_cast<std::ptrdiff_t>(NpBrdf::kCode)) return false;
  bool is_name = true;
  for (;;) {
    const std::size_t comma = std::min(line.find(','), line.size());
    if (parse_number(trimmed(line.substr(0, comma))).has_value() == is_name) return false;
    if (comma == line.size()) return true;
    line.remove_prefix(comma + 1);
    is_name = false;
  }
}

std::shared_ptr<const NpDecoder> parse_np_decoder(const FileBytes& file) {
  if (file.bytes.size() != NpDecoder::bytes())
    throw Error::in_file(
        file.name, fmt::format("{} bytes, {} weights of a decoder", NpDecoder::bytes(), NpDecoder::kWeights),
        fmt::format("{} bytes", file.bytes.size()));
  static_assert(std::endian::native == std::endian::little);
  std::vector<float> weights(NpDecoder::kWeights);
  std::memcpy(weights.data(), file.bytes.data(), file.bytes.size());
  try {
    return std::make_shared<const NpDecoder>(weights);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  }
}

NpFile parse_np(const FileBytes& codes, std::string_view name, std::shared_ptr<const NpDecoder> decoder) {
  NamedRow row = parse_named_row(codes, name, kCodes);
  NpBrdf::Code code;
  std::ranges::copy(row.numbers, code.begin());
  const bool with_cosine = row.name.ends_with("_rgb");

  Findings findings;
  findings.format = "Neural Processes encoding";
  findings.description = row.name;
  findings.conventions = {
      fmt::format("{} numbers, {} bytes; {} weights that all materials share, {} bytes more", NpBrdf::kCode,
                  NpBrdf::bytes(), NpDecoder::kWeights, NpDecoder::bytes()),
      with_cosine ? "decoded values are f_r times the cosine" : "decoded values are f_r"};
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  try {
    NpBrdf brdf(std::move(decoder), code,
                with_cosine ? NpBrdf::Value::with_cosine : NpBrdf::Value::reflectance);
    return {std::move(row.name), std::move(brdf), std::move(findings)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", codes.name, error.what()));
  }
}

NpFile open_np(std::string_view address) {
  const std::size_t mark = std::min(address.rfind('#'), address.size());
  std::filesystem::path place(address.substr(0, mark));
  if (std::error_code none; std::filesystem::is_directory(place, none)) place /= "codes.csv";
  const FileBytes codes = read_file(place, kMaxBytes);
  return parse_np(codes, address.substr(std::min(mark + 1, address.size())),
                  parse_np_decoder(read_file(place.parent_path() / "decoder.f32", kMaxBytes)));
}

}  // namespace burnish
