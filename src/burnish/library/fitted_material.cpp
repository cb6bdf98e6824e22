// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/image/png.h>
#include <burnish/io/open_source.h>
#include <burnish/library/fit_settings.h>
#include <burnish/library/fitted_material.h>
#include <burnish/library/sha256.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

namespace fs = std::filesystem;

namespace {

constexpr int kPictureSize = 96;   // pixels
constexpr int kExposureSize = 32;  // pixels of the spheres that the exposure is of
constexpr double kAlbedoBound = 0.02;
constexpr std::array<double, 4> kAlbedoAngles = {radians(0), radians(30), radians(60), radians(80)};
constexpr std::size_t kReciprocityPairs = 2000;
constexpr double kAsymmetric = 0.3, kManyNegative = 0.01, kLowAngle = radians(70.0), kMuchReflected = 1.01;
constexpr std::size_t kFewSamples = 100;

FitOptions fit_options(const BatchOptions& options, bool isotropic) {
  return options.fit ? options.fit(isotropic) : FitOptions{};
}

// The sphere at an exposure of its own.
std::string picture(BrdfRef brdf) {
  std::array<LitSphere, kSphereLights.size()> spheres;
  for (std::size_t k = 0; k < spheres.size(); ++k)
    spheres[k] = render_sphere(brdf, kSphereLights[k], kExposureSize);
  return encode_png(
      lit_sphere(brdf, {.size = kPictureSize, .exposure = sphere_exposure(spheres), .supersampling = 2}));
}

double largest_albedo(BrdfRef brdf) {
  double largest = 0;
  for (const double theta : kAlbedoAngles) {
    const Vec3 wi{std::sin(theta), 0, std::cos(theta)};
    largest = std::max(largest, std::ranges::max(directional_albedo(brdf, wi, kAlbedoBound).albedo));
  }
  return largest;
}

std::vector<std::string> warnings(const Source& source, double albedo) {
  const Findings& found = source.findings;
  std::vector<std::string> said = found.warnings;
  const auto values = static_cast<double>(found.sample_count * source.ref().channels());
  if (values > 0 && static_cast<double>(found.negative_count) > kManyNegative * values)
    said.push_back(fmt::format("{:.0f} % of the measured values are below zero",
                               100 * static_cast<double>(found.negative_count) / values));
  if (is_measurement(source)) {
    if (const double top = std::min(found.theta_i_max, found.theta_o_max); top < kLowAngle)
      said.push_back(fmt::format("measured up to {:.0f} degrees only", degrees(top)));
    if (const Samples* samples = source.samples(); samples && found.sample_count < kFewSamples)
      said.push_back(fmt::format("only {} samples", found.sample_count));
    if (const double error = reciprocity_error(source.ref(), kReciprocityPairs, 1).mean; error > kAsymmetric)
      said.push_back(fmt::format("exchanged directions differ by {:.0f} %", 100 * error));
  }
  if (albedo > kMuchReflected)
    said.push_back(fmt::format("the model reflects {:.2f} times what it receives", albedo));
  return said;
}

// Figures as fit measured them; of scattered samples what it has instead.
void set_figures(const FitReport& report, MaterialRecord& record) {
  const auto finite = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
  if (report.held_out) {
    record.psnr = finite(report.held_out->psnr);
    record.ssim = finite(report.held_out->ssim);
    record.relative = finite(report.held_out->relative);
    record.rms_log = finite(report.held_out->rms_log);
    record.log_cos = finite(report.held_out->log_cos);
  } else if (const auto* one_lobe = std::get_if<OneLobeReport>(&report.how)) {
    record.relative =
        one_lobe->relative_cross_validated ? one_lobe->relative_cross_validated : one_lobe->relative;
    record.rms_log = finite(one_lobe->summary.error_after);
  } else if (const auto* completion = std::get_if<CompletionReport>(&report.how)) {
    record.relative = finite(completion->relative_left_out);
  }
}

std::vector<fs::path> files_of(const std::string& argument) {
  const auto address = [&](std::string_view prefix) {
    const std::string rest = argument.substr(prefix.size());
    return fs::path(rest.substr(0, rest.rfind('#')));
  };
  for (const std::string_view prefix : {"nbrdf:", "book:"})
    if (argument.starts_with(prefix)) return {address(prefix)};
  if (!argument.starts_with("np:")) return {argument};
  std::error_code error;
  fs::path codes = address("np:");
  if (fs::is_directory(codes, error)) codes /= "codes.csv";
  return {codes, codes.parent_path() / "decoder.f32"};
}

}  // namespace

FittedMaterial fit_material(const LibraryEntry& entry, const std::string& key, const BatchOptions& options,
                            const FitWatch& watch) {
  const auto start = std::chrono::steady_clock::now();
  FittedMaterial made{.record = {.name = entry.name, .argument = entry.argument, .key = key}};
  MaterialRecord& record = made.record;
  const auto add = [&](const std::string& path, std::string bytes) {
    record.files.push_back({.path = path, .staged = {}, .sha256 = sha256(bytes)});
    made.bytes.push_back(std::move(bytes));
  };

  // the model
  const Source source = open_source(entry.argument, options.open);
  FitOptions how = fit_options(options, source.ref().isotropic());
  how.progress = [&watch](std::string_view, double) { watch.stop(); };
  watch.reserve(fit_memory(how, source.ref().isotropic()));
  const Fit fit = burnish::fit(source, how);
  const auto* model = std::get_if<FactoredBrdf>(&fit.brdf);
  const std::string ending = !model ? ".json" : options.compact ? ".burnish" : ".exr";
  const std::string path = "models/" + entry.name + ending;
  add(path, format_fit(fit, path));
  watch.stop();

  // what is said of it
  record.format = source.findings.format;
  record.model = model ? model_expression(*model) : baseline_expression(std::get<BaselineBrdf>(fit.brdf));
  record.bytes = fit.bytes();
  if (model) record.fetches = fetch_count(*model);
  set_figures(fit.report, record);
  record.albedo = largest_albedo(fit.ref());
  record.warnings = warnings(source, *record.albedo);

  // what is shown of it
  add("pictures/" + entry.name + ".png", picture(fit.ref()));
  if (!options.exports.to.empty()) {
    ExportOptions exports = options.exports;
    exports.name = export_name(entry.name);
    exports.notes = to_json(fit.report);
    for (ExportedFile& file : export_model(fit.model(), exports).files)
      add(fmt::format("exports/{}/{}", entry.name, file.name), std::move(file.bytes));
  }
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return made;
}

std::uint64_t fit_memory(const FitOptions& options, bool isotropic) {
  constexpr std::uint64_t kMinMemory = std::uint64_t{48} << 20, kAnisotropicPairs = std::uint64_t{208} << 20,
                          kForEachByte = 6600, kUsual = 16384, kMaxAutoBytes = 65536;
  const FitForm form = options.form.value_or(DefaultBudget{});
  if (std::holds_alternative<OneLobe>(form) || std::holds_alternative<FromBook>(form)) return kMinMemory;
  const auto* budget = std::get_if<Budget>(&form);
  return kMinMemory + (isotropic ? 0 : kAnisotropicPairs) +
         kForEachByte * (budget ? budget->bytes.value_or(kMaxAutoBytes) : kUsual);
}

InputDigests::InputDigests(const BatchOptions& options) : options_(options) {
  std::string text = library_version() + '\n' + settings_text(options.open) + '\n' +
                     settings_text(options.exports) + '\n' + (options.compact ? "burnish" : "exr");
  for (const bool isotropic : {false, true}) text += '\n' + settings_text(fit_options(options, isotropic));
  settings_ = std::move(text);
}

std::string InputDigests::key(const LibraryEntry& entry) {
  Sha256 hash;
  hash.add(settings_);
  // the argument of a model with notes is part of it; of others the place within the file
  const std::size_t mark = entry.argument.rfind('#');
  const bool analytic = is_analytic_spec(entry.argument);
  if (analytic || !options_.compact)
    hash.add('\n' + entry.argument);
  else if (mark != std::string::npos)
    hash.add('\n' + entry.argument.substr(mark));
  if (!analytic)
    for (const fs::path& file : files_of(entry.argument)) hash.add('\n' + of_file(file));
  if (std::error_code error; fs::is_regular_file(options_.open.illuminant, error))
    hash.add('\n' + of_file(options_.open.illuminant));
  return hash.hex();
}

std::string InputDigests::of_file(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  const fs::file_time_type time = error ? fs::file_time_type{} : fs::last_write_time(path, error);
  if (error)
    throw Error::in_file(path.string(), "a readable file",
                         fs::exists(path, error) ? "something else" : "no such file");
  {
    const std::lock_guard lock(mutex_);
    const auto known = files_.find(path.string());
    if (known != files_.end() && std::get<0>(known->second) == size && std::get<1>(known->second) == time)
      return std::get<2>(known->second);
  }
  // in parts: the file may be larger than what memory is left
  std::ifstream in(path, std::ios::binary);
  Sha256 hash;
  std::vector<char> part(std::size_t{1} << 20);
  while (in.read(part.data(), static_cast<std::streamsize>(part.size())), in.gcount() > 0)
    hash.add(std::string_view(part.data(), static_cast<std::size_t>(in.gcount())));
  if (in.bad() || !in.eof()) throw Error::in_file(path.string(), "a readable file", "a read error");
  std::string digest = hash.hex();
  const std::lock_guard lock(mutex_);
  files_[path.string()] = {size, time, digest};
  return digest;
}

std::uint64_t input_size(const LibraryEntry& entry) noexcept {
  if (is_analytic_spec(entry.argument)) return 0;
  std::uint64_t sum = 0;
  for (const fs::path& file : files_of(entry.argument)) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error) sum += size;
  }
  return sum;
}

}  // namespace burnish
