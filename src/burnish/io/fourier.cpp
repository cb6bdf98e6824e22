// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/io/fourier.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/math/luminance.h>

namespace burnish {

namespace {

constexpr std::string_view kFourierMagic = "SCATFUN";
constexpr std::uint32_t kMaxCosines = 8192, kIsBsdf = 1, kExtrapolated = 2;
constexpr double kEndTolerance = 1e-5;  // tolerance of the cosines -1 and 1

/// The place of the coefficients of one pair of cosines, channel after channel.
struct Series {
  std::uint32_t offset, length;
};

struct FourierTable {
  std::vector<float> mu;
  std::vector<Series> series;  ///< [mu_o][mu_i]
  std::vector<float> coefficients;
  std::size_t channels = 1, longest = 0;

  const Series& at(std::size_t i, std::size_t o) const noexcept { return series[o * mu.size() + i]; }
};

/// Weights of the nodes first - 1 to first + 2; nodes that do not exist have weight 0.
struct SplineWeights {
  std::size_t first;
  std::array<double, 4> weights;
};

/// Returns Catmull-Rom weights at x, which is moved into the nodes' range. The slope at a node is that between its
/// two neighbours, at an end that of its interval.
SplineWeights spline_weights(const std::vector<float>& nodes, double x) noexcept {
  x = std::clamp<double>(x, nodes.front(), nodes.back());
  // The interval holds x. Nodes may stand twice at 0; an interval of no length is never chosen.
  const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
  const auto k = static_cast<std::size_t>(after - nodes.begin()) - 1;
  const double x0 = nodes[k], x1 = nodes[k + 1], width = x1 - x0, t = (x - x0) / width, t2 = t * t,
               t3 = t2 * t;
  SplineWeights result{k, {0, 2 * t3 - 3 * t2 + 1, 3 * t2 - 2 * t3, 0}};
  auto& w = result.weights;

  // Hermite's basis is multiplied by the slope at x0, then by the slope at x1.
  const double before = t3 - 2 * t2 + t, behind = t3 - t2;
  const double slope0 = k > 0 ? width / (x1 - nodes[k - 1]) : 1;
  w[k > 0 ? 0 : 1] -= before * slope0;
  w[2] += before * slope0;
  const bool has_next = k + 2 < nodes.size();
  const double slope1 = has_next ? width / (nodes[k + 2] - x0) : 1;
  w[1] -= behind * slope1;
  w[has_next ? 3 : 2] += behind * slope1;
  return result;
}

/// Returns the cosine of the azimuth between -wi and wo; 1 if one of them has none.
double cos_azimuth(Vec3 wi, Vec3 wo) noexcept {
  const double length2 = (wi.x * wi.x + wi.y * wi.y) * (wo.x * wo.x + wo.y * wo.y);
  return length2 > 0 ? std::clamp(-(wi.x * wo.x + wi.y * wo.y) / std::sqrt(length2), -1.0, 1.0) : 1;
}

/// Returns the sum of a_k cos(k phi).
double cosine_series(std::span<const double> a, double cos_phi) noexcept {
  double sum = 0, previous = cos_phi, current = 1;
  for (const double a_k : a) {
    sum += a_k * current;
    previous = std::exchange(current, 2 * cos_phi * current - previous);
  }
  return sum;
}

/// Evaluates f_r of one pair. `a` has room for the longest series of each channel.
void eval_pair(const FourierTable& table, const DirectionPair& pair, std::span<double> a,
               std::span<double> f) noexcept {
  // The pair's series is interpolated from the sixteen nearest ones.
  std::ranges::fill(a, 0.0);
  const SplineWeights in = spline_weights(table.mu, -pair.wi.z), out = spline_weights(table.mu, pair.wo.z);
  for (std::size_t o = 0; o < 4; ++o)
    for (std::size_t i = 0; i < 4; ++i) {
      const double weight = in.weights[i] * out.weights[o];
      if (weight == 0) continue;
      const Series& series = table.at(in.first + i - 1, out.first + o - 1);
      for (std::size_t c = 0; c < table.channels; ++c)
        for (std::size_t k = 0; k < series.length; ++k)
          a[c * table.longest + k] += weight * table.coefficients[series.offset + c * series.length + k];
    }

  // The series is evaluated at the azimuth and divided by the cosine that it is stored with.
  const double cos_phi = cos_azimuth(pair.wi, pair.wo);
  std::array<double, 3> stored{};
  for (std::size_t c = 0; c < table.channels; ++c)
    stored[c] = cosine_series(a.subspan(c * table.longest, table.longest), cos_phi) / pair.wi.z;
  if (table.channels == 3) {
    // The channels are luminance, red and blue: [Jakob 2014] stores no green.
    const double y = std::max(stored[0], 0.0), red = stored[1], blue = stored[2];
    const Rgb& shares = kLuminanceShares;
    stored = {red, (y - shares.r * red - shares.b * blue) / shares.g, blue};
  }
  for (std::size_t c = 0; c < table.channels; ++c)
    f[c] = std::isfinite(stored[c]) ? std::max(stored[c], 0.0) : 0.0;
}

struct FourierHeader {
  std::uint32_t mu_count, coefficient_count, longest, channels, remark_bytes;
  float eta;
};

FourierHeader read_fourier_header(ByteReader& reader) {
  reader.take(kFourierMagic.size(), "SCATFUN");
  if (const int version = reader.number<std::uint8_t>("a version"); version != 1)
    reader.fail("version 1", fmt::format("{}", version));
  const auto number = [&](const char* what) { return reader.number<std::uint32_t>(what); };
  if (const std::uint32_t flags = number("flags"); flags != kIsBsdf)
    reader.fail("flags 1, a BSDF as it is",
                flags == (kIsBsdf | kExtrapolated) ? "3, harmonic extrapolation" : fmt::format("{}", flags));
  FourierHeader header{};
  header.mu_count = number("the number of cosines");
  if (header.mu_count < 2 || header.mu_count > kMaxCosines)
    reader.fail(fmt::format("2 to {} cosines", kMaxCosines), fmt::format("{}", header.mu_count));
  header.coefficient_count = number("the number of coefficients");
  header.longest = number("the length of the longest series");
  header.channels = number("the number of channels");
  if (header.channels != 1 && header.channels != 3)
    reader.fail("1 or 3 channels", fmt::format("{}", header.channels));
  if (std::uint64_t{header.longest} * header.channels > header.coefficient_count)
    reader.fail(fmt::format("series within {} coefficients", header.coefficient_count),
                fmt::format("one of {}", header.longest));
  if (const std::uint32_t bases = number("the number of bases"); bases != 1)
    reader.fail("1 basis, no textures", fmt::format("{}", bases));
  header.remark_bytes = number("the length of remarks");
  if (const auto parameters =
          std::uint64_t{number("the number of textures")} + number("the number of texture values");
      parameters != 0)
    reader.fail("no textures", "some");
  header.eta = reader.number<float>("the index of refraction");
  reader.take(4 * sizeof(float), "the end of the header");
  return header;
}

std::vector<float> read_finite(ByteReader& reader, std::uint64_t count, const char* what) {
  const std::uint64_t start = reader.offset();
  const auto bytes = reader.take(count * sizeof(float), what);
  std::vector<float> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  const auto wrong = std::ranges::find_if(values, [](float v) { return !std::isfinite(v); });
  if (wrong != values.end()) {
    reader.seek(start + static_cast<std::uint64_t>(wrong - values.begin()) * sizeof(float));
    reader.fail(fmt::format("a finite number among {}", what), fmt::format("{}", *wrong));
  }
  return values;
}

/// Reads cosines that rise from -1 to 1. Each but the ends may stand twice.
std::vector<float> read_cosines(ByteReader& reader, std::uint64_t count) {
  std::vector<float> mu = read_finite(reader, count, "cosines");
  if (std::abs(mu.front() + 1.0) > kEndTolerance || std::abs(mu.back() - 1.0) > kEndTolerance)
    reader.fail("cosines from -1 to 1", fmt::format("{:g} to {:g}", mu.front(), mu.back()));
  if (!std::is_sorted(mu.begin(), mu.end()) || mu[count - 2] == mu[count - 1])
    reader.fail("cosines that rise", "others");
  return mu;
}

std::vector<Series> read_series(ByteReader& reader, const FourierHeader& header) {
  std::vector<Series> series(std::size_t{header.mu_count} * header.mu_count);
  for (Series& s : series) {
    s.offset = reader.number<std::uint32_t>("the offset of a series");
    s.length = reader.number<std::uint32_t>("the length of a series");
    const std::uint64_t end = s.offset + std::uint64_t{s.length} * header.channels;
    if (s.length > header.longest || (s.length > 0 && end > header.coefficient_count))
      reader.fail(fmt::format("a series of at most {} within {} coefficients", header.longest,
                              header.coefficient_count),
                  fmt::format("{} at {}", s.length, s.offset));
  }
  return series;
}

/// Counts the coefficients of series that reflect above, and names the rest.
void count_series(const FourierTable& table, Findings& findings) {
  bool transmits = false, reflects_below = false;
  for (std::size_t o = 0; o < table.mu.size(); ++o)
    for (std::size_t i = 0; i < table.mu.size(); ++i) {
      const double mu_i = table.mu[i], mu_o = table.mu[o];
      const std::uint32_t length = table.at(i, o).length;
      if (length == 0) continue;
      if (mu_i < 0 && mu_o > 0) findings.sample_count += length;
      transmits |= mu_i * mu_o > 0;
      reflects_below |= mu_i > 0 && mu_o < 0;
    }
  if (transmits) findings.left_out.push_back("transmission");
  if (reflects_below) findings.left_out.push_back("the reflection of the lower side");
}

}  // namespace

bool looks_like_fourier(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= kFourierMagic.size() &&
         std::memcmp(bytes.data(), kFourierMagic.data(), kFourierMagic.size()) == 0;
}

FourierFile parse_fourier(const FileBytes& file) {
  ByteReader reader(file);
  const FourierHeader header = read_fourier_header(reader);
  // All sizes are known. The file has to be as long as they say before anything is allocated.
  const std::uint64_t pairs = std::uint64_t{header.mu_count} * header.mu_count;
  const std::uint64_t expected =
      reader.offset() + 4 * (header.mu_count + 3 * pairs + header.coefficient_count) + header.remark_bytes;
  if (reader.size() != expected)
    reader.fail(fmt::format("a file of {} bytes", expected), fmt::format("{}", reader.size()));

  const auto table = std::make_shared<FourierTable>();
  table->channels = header.channels;
  table->longest = header.longest;
  table->mu = read_cosines(reader, header.mu_count);
  reader.take(4 * pairs, "the table for sampling");
  table->series = read_series(reader, header);
  table->coefficients = read_finite(reader, header.coefficient_count, "coefficients");

  Findings findings;
  findings.format = "Fourier BSDF";
  const std::string_view remarks = file.text().substr(reader.offset());
  findings.description = printable(trimmed(remarks.substr(0, remarks.find_first_of("\r\n"))), 200);
  count_series(*table, findings);
  if (findings.sample_count == 0) reader.fail("a reflection of the upper side", "none");
  findings.conventions = {
      "Azimuths are between the direction that the light travels in and the viewer: the mirror direction is "
      "at 0.",
      "Values have the cosine of the light's angle, which is divided out; between cosines they are splines.",
      header.channels == 3 ? "Luminance, red and blue, taken as linear Rec. 709." : "Grey."};
  findings.theta_i_max = findings.theta_o_max = kHalfPi;

  auto function = [table](std::span<const DirectionPair> pairs_asked, std::span<double> values) {
    std::vector<double> a(table->channels * table->longest);
    for (std::size_t p = 0; p < pairs_asked.size(); ++p)
      eval_pair(*table, pairs_asked[p], a, values.subspan(p * table->channels, table->channels));
  };
  return {FunctionBrdf(header.channels, true, std::move(function)), std::move(findings)};
}

}  // namespace burnish
