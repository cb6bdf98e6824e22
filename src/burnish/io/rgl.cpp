// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include <burnish/io/illuminant.h>
#include <burnish/io/rgl.h>
#include <burnish/io/tensor_file.h>
#include <burnish/math/angles.h>
#include <burnish/math/spectrum.h>

namespace burnish {
namespace {

constexpr std::uint64_t kLongestSide = 1 << 24;

/// The fields of a file. Each is checked when it is read.
class Fields {
 public:
  explicit Fields(const FileBytes& file) : file_(file), tensors_(parse_tensor_file(file)) {}

  const Tensor* find(std::string_view name) const {
    const auto at =
        std::find_if(tensors_.begin(), tensors_.end(), [&](const Tensor& t) { return t.name == name; });
    return at == tensors_.end() ? nullptr : &*at;
  }

  /// Returns a field of `type` with `rank` dimensions, none of them zero. Throws Error if it is missing or differs.
  const Tensor& get(std::string_view name, TensorType type, std::size_t rank) const {
    const Tensor* tensor = find(name);
    if (!tensor) throw Error::in_file(file_.name, fmt::format("a field {}", name), "none");
    if (tensor->type != type || tensor->shape.size() != rank)
      fail(*tensor, fmt::format("{} of type {} with {} dimensions", name, name_of(type), rank),
           fmt::format("{} with {}", name_of(tensor->type), tensor->shape.size()));
    for (std::uint64_t length : tensor->shape)
      if (length == 0 || length > kLongestSide)
        fail(*tensor, fmt::format("1 to {} entries in each dimension of {}", kLongestSide, name),
             std::to_string(length));
    return *tensor;
  }

  std::vector<float> floats(std::string_view name) const { return floats(get(name, TensorType::f32, 1)); }

  std::vector<float> floats(const Tensor& tensor) const {
    std::vector<float> values(tensor.data.size() / sizeof(float));
    std::memcpy(values.data(), tensor.data.data(), tensor.data.size());
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
    if (bad != values.end())
      throw Error(file_.name,
                  tensor.offset + sizeof(float) * static_cast<std::uint64_t>(bad - values.begin()),
                  "finite numbers in " + tensor.name, std::to_string(*bad));
    return values;
  }

  /// Returns a grid of [leading shape][height][width].
  RglGrid grid(std::string_view name, const std::vector<std::uint64_t>& leading) const {
    const Tensor& tensor = get(name, TensorType::f32, leading.size() + 2);
    if (!std::equal(leading.begin(), leading.end(), tensor.shape.begin()))
      fail(tensor, fmt::format("{} of shape [{}, height, width]", name, fmt::join(leading, ", ")),
           fmt::format("[{}]", fmt::join(tensor.shape, ", ")));
    const auto n = leading.size();
    return {static_cast<int>(tensor.shape[n + 1]), static_cast<int>(tensor.shape[n]), floats(tensor)};
  }

 private:
  [[noreturn]] void fail(const Tensor& tensor, const std::string& expected, const std::string& found) const {
    throw Error(file_.name, tensor.offset, expected, found);
  }

  const FileBytes& file_;
  std::vector<Tensor> tensors_;
};

/// Turns [slices][channels][nodes] into [slices][nodes][channels]; with the two counts exchanged it turns them back.
std::vector<float> transpose(const std::vector<float>& values, std::size_t channels, std::size_t nodes) {
  std::vector<float> result(values.size());
  for (std::size_t slice = 0; slice < values.size(); slice += channels * nodes)
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t i = 0; i < nodes; ++i)
        result[slice + i * channels + c] = values[slice + c * nodes + i];
  return result;
}

std::size_t node_count(const RglGrid& grid) noexcept {
  return static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
}

void convert_to_rec709(RglData& data, const std::string& illuminant) {
  const auto weights = rec709_weights(data.lambda_nm, open_illuminant(illuminant));
  const std::size_t bands = weights.size(), count = data.spectra.values.size() / bands;
  std::vector<float> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < bands; ++k)
        sum += weights[k][c] * static_cast<double>(data.spectra.values[i * bands + k]);
      rgb[3 * i + c] = static_cast<float>(sum);
    }
  data.spectra.values = std::move(rgb);
  data.lambda_nm.clear();
  data.channels = 3;
}

std::string one_line(std::span<const std::byte> bytes) {
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

/// Returns the smallest value in 1/sr at nodes with a negative one; 0 if there is none.
double most_negative(const RglTable& table) {
  const RglData& data = table.data();
  const auto channels = data.channels, nodes = node_count(data.spectra);
  const auto width = static_cast<std::size_t>(data.spectra.width);
  std::vector<double> f(channels);
  double result = 0;
  for (std::size_t i = 0; i < data.spectra.values.size() / channels; ++i) {
    const auto values = std::span(data.spectra.values).subspan(i * channels, channels);
    if (std::none_of(values.begin(), values.end(), [](float v) { return v < 0; })) continue;
    const std::size_t slice = i / nodes, node = i % nodes;
    const DirectionPair pair = table.node_directions(
        static_cast<int>(slice / data.theta_i.size()), static_cast<int>(slice % data.theta_i.size()),
        static_cast<int>(node / width), static_cast<int>(node % width));
    table.eval_raw(pair.wi, pair.wo, f);
    result = std::min(result, *std::min_element(f.begin(), f.end()));
  }
  return result;
}

/// Returns all that the file holds, spectral if it is.
RglData read_data(const Fields& fields) {
  RglData data;
  data.phi_i = fields.floats("phi_i");
  data.theta_i = fields.floats("theta_i");
  const std::uint64_t phis = data.phi_i.size(), thetas = data.theta_i.size();
  data.ndf = fields.grid("ndf", {});
  data.sigma = fields.grid("sigma", {});
  data.vndf = fields.grid("vndf", {phis, thetas});
  data.luminance = fields.grid("luminance", {phis, thetas});
  data.jacobian = fields.get("jacobian", TensorType::u8, 1).data[0] != std::byte{0};

  // The channels are wavelengths or RGB, and the file keeps them apart.
  const bool spectral = fields.find("spectra") != nullptr;
  if (spectral) {
    const auto lambda_nm = fields.floats("wavelengths");
    data.lambda_nm.assign(lambda_nm.begin(), lambda_nm.end());
  }
  const std::uint64_t channels = spectral ? data.lambda_nm.size() : 3;
  data.channels = channels;
  data.spectra = fields.grid(spectral ? "spectra" : "rgb", {phis, thetas, channels});
  data.spectra.values = transpose(data.spectra.values, channels, node_count(data.spectra));

  // A file may leave these fields out.
  if (const Tensor* text = fields.find("description"); text && text->type == TensorType::u8)
    data.description = one_line(text->data);
  const std::uint64_t samples = phis * thetas * node_count(data.spectra);
  if (const Tensor* mask = fields.find("valid");
      mask && mask->type == TensorType::u8 && mask->data.size() == (samples + 7) / 8)
    for (std::byte byte : mask->data) data.valid.push_back(static_cast<std::uint8_t>(byte));
  return data;
}

/// Inverts a mask whose bits stand the other way round, which would make holes of nearly all of a measurement.
/// One such file exists: it marks as valid the places where other files have their holes. Returns true if the
/// mask was inverted.
bool turn_mask(std::vector<std::uint8_t>& valid, std::uint64_t samples) noexcept {
  constexpr std::uint64_t kQuarter = 4;
  std::uint64_t measured = 0;
  for (std::uint8_t byte : valid) measured += static_cast<std::uint64_t>(std::popcount(byte));
  if (measured == 0 || measured >= samples / kQuarter) return false;
  for (std::uint8_t& byte : valid) byte = static_cast<std::uint8_t>(~byte);
  // Bits behind the last node are no samples.
  if (const auto rest = samples % 8; rest > 0 && !valid.empty())
    valid.back() = static_cast<std::uint8_t>(valid.back() & (0xff << (8 - rest)));
  return true;
}

/// Returns the number of zero bits of a mask of `samples` bits; 0 if there is no mask.
std::uint64_t count_holes(const std::vector<std::uint8_t>& valid, std::uint64_t samples) noexcept {
  if (valid.empty()) return 0;
  std::uint64_t measured = 0;
  for (std::uint8_t byte : valid) measured += static_cast<std::uint64_t>(std::popcount(byte));
  return samples - std::min(measured, samples);
}

}  // namespace

bool looks_like_rgl(std::span<const std::byte> head) noexcept {
  return looks_like_tensor_file(head);
}

RglFile parse_rgl(const FileBytes& file, const OpenOptions& options) {
  const Fields fields(file);
  RglData data = read_data(fields);
  const std::uint64_t phis = data.phi_i.size(), thetas = data.theta_i.size();
  const std::uint64_t samples = phis * thetas * node_count(data.spectra);
  const bool isotropic = phis <= 2, spectral = fields.find("spectra") != nullptr;

  Findings findings;
  findings.format = fmt::format("RGL tensor file ({}, {})", isotropic ? "isotropic" : "anisotropic",
                                spectral ? fmt::format("{} wavelengths", data.channels) : "RGB");
  findings.description = data.description;
  findings.sample_count = samples;
  const bool turned = turn_mask(data.valid, samples);
  findings.hole_count = count_holes(data.valid, samples);
  findings.theta_i_min = static_cast<double>(data.theta_i.front());
  findings.theta_i_max = std::min(static_cast<double>(data.theta_i.back()), kHalfPi);
  findings.theta_o_max = kHalfPi;
  findings.conventions = {"the file's first direction, theta_i and phi_i, is wi",
                          "stored values contain cos(theta_o): it is divided out"};
  if (!data.jacobian) findings.conventions.push_back("stored values are not scaled by 4 sigma / ndf");
  if (turned)
    findings.conventions.push_back(
        "the bits of valid nodes are in the reverse order of other files: reversed");
  if (findings.hole_count > 0)
    findings.conventions.push_back("nodes that were not measured keep the values the file fills in");

  // The table checks the file's numbers.
  try {
    if (spectral && options.keep_spectral) {
      findings.lambda_nm = data.lambda_nm;
    } else if (spectral) {
      convert_to_rec709(data, options.illuminant);
      findings.illuminant = illuminant_name(options.illuminant);
    }
    RglTable table(std::move(data));
    if (table.reduction() > 1)
      findings.conventions.push_back(
          fmt::format("phi_i covers 1/{} of the circle, completed by {}", table.reduction(),
                      table.reduction() == 2 ? "rotation by 180 degrees" : "two mirror planes"));
    findings.most_negative = most_negative(table);
    const auto& values = table.data().spectra.values;
    findings.negative_count = static_cast<std::uint64_t>(
        std::count_if(values.begin(), values.end(), [](float v) { return v < 0; }));
    return {std::move(table), std::move(findings)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  }
}

std::string format_rgl(const RglTable& table) {
  const RglData& data = table.data();
  const std::uint64_t phis = data.phi_i.size(), thetas = data.theta_i.size();
  const auto nodes = node_count(data.spectra);
  const auto side = [](int length) { return static_cast<std::uint64_t>(length); };

  // The file keeps channels apart, and a grey table becomes three of them.
  std::vector<float> spectra;  // [slice][channel][node]
  const bool grey = data.lambda_nm.empty() && data.channels == 1;
  if (grey)
    for (std::size_t slice = 0; slice < phis * thetas; ++slice)
      for (int c = 0; c < 3; ++c) {
        const auto values = std::span(data.spectra.values).subspan(slice * nodes, nodes);
        spectra.insert(spectra.end(), values.begin(), values.end());
      }
  else
    spectra = transpose(data.spectra.values, nodes, data.channels);

  const std::array<std::uint32_t, 2> version{1, 0};
  const std::array<std::uint8_t, 1> jacobian{data.jacobian};
  const std::vector<float> wavelengths(data.lambda_nm.begin(), data.lambda_nm.end());

  std::vector<Tensor> tensors;
  const auto add = [&](std::string name, TensorType type, std::vector<std::uint64_t> shape, auto& values) {
    tensors.push_back({std::move(name), type, std::move(shape), std::as_bytes(std::span(values)), 0});
  };
  const auto add_grid = [&](std::string name, std::vector<std::uint64_t> shape, const RglGrid& grid,
                            const std::vector<float>& values) {
    shape.insert(shape.end(), {side(grid.height), side(grid.width)});
    add(std::move(name), TensorType::f32, std::move(shape), values);
  };
  add("version", TensorType::u32, {2}, version);
  add("description", TensorType::u8, {data.description.size()}, data.description);
  add("phi_i", TensorType::f32, {phis}, data.phi_i);
  add("theta_i", TensorType::f32, {thetas}, data.theta_i);
  add_grid("sigma", {}, data.sigma, data.sigma.values);
  add_grid("ndf", {}, data.ndf, data.ndf.values);
  add_grid("vndf", {phis, thetas}, data.vndf, data.vndf.values);
  add_grid("luminance", {phis, thetas}, data.luminance, data.luminance.values);
  if (data.lambda_nm.empty()) {
    add_grid("rgb", {phis, thetas, 3}, data.spectra, spectra);
  } else {
    add("wavelengths", TensorType::f32, {wavelengths.size()}, wavelengths);
    add_grid("spectra", {phis, thetas, wavelengths.size()}, data.spectra, spectra);
  }
  add("jacobian", TensorType::u8, {1}, jacobian);
  if (!data.valid.empty()) add("valid", TensorType::u8, {data.valid.size()}, data.valid);
  return format_tensor_file(tensors);
}

}  // namespace burnish
