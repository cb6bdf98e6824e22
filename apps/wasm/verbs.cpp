// SPDX-License-Identifier: Apache-2.0
#include "verbs.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/export/export_model.h>
#include <burnish/export/export_openpbr.h>
#include <burnish/export/export_surface.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/edit.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/fitting/fit_request.h>
#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/math/closest_name.h>
#include <burnish/metrics/albedo.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/report/compare_report.h>
#include <burnish/shaders/cost_json.h>
#include <burnish/shaders/shader.h>
#include <burnish/shaders/spatial_shader.h>
#include <burnish/surface/surface_file.h>

#include "comparison.h"
#include "info_json.h"
#include "opened.h"
#include "options.h"
#include "surface_info.h"

namespace burnish::wasm {

namespace {

std::map<int, Opened>& materials() {
  static std::map<int, Opened> opened;
  return opened;
}

const Opened& opened(const Json& arguments, const char* key = "id") {
  const auto found = materials().find(arguments.at(key).get<int>());
  if (found == materials().end()) throw Error("expected an open material, found one that was closed");
  return found->second;
}

const Source& material(const Json& arguments, const char* key = "id") {
  return opened(arguments, key).source;
}

const SurfaceModel& surface_of(const Json& arguments) {
  const Opened& found = opened(arguments);
  if (!found.surface)
    throw Error(fmt::format("{}: expected a surface, found another material", found.source.name));
  return *found.surface;
}

const FactoredBrdf& model_of(const Json& arguments) {
  const Source& source = material(arguments);
  const auto* model = std::get_if<FactoredBrdf>(&source.brdf);
  if (!model) throw Error(fmt::format("{}: expected a factored BRDF, found another material", source.name));
  return *model;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::vector<float> floats_of(const std::vector<std::byte>& bytes) {
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

/// Returns the facts that need no report.
Json summary_of(const Opened& opened) {
  const Source& source = opened.source;
  const BrdfRef ref = source.ref();
  const auto* model = std::get_if<FactoredBrdf>(&source.brdf);
  Json json{{"name", source.name},          {"channels", ref.channels()},
            {"isotropic", ref.isotropic()}, {"target", to_string(default_target(source, {}))},
            {"model", model != nullptr},    {"measurement", is_measurement(source)}};
  if (const auto bytes = source.bytes()) json["bytes"] = *bytes;
  if (model) {
    json["expression"] = model_expression(*model);
    json["fetches"] = fetch_count(*model);
  }
  if (!opened.entries.empty()) json["entries"] = opened.entries;
  if (const auto& surface = opened.surface) {
    json["surface"] = {{"width", surface->brdf.width()}, {"height", surface->brdf.height()}};
    json["bytes"] = surface->brdf.bytes();
  }
  return json;
}

Reply open(Request request) {
  const Json& a = request.arguments;
  const Options given("open", a,
                      {"spectral", "illuminant", "hasCosine", "hasCosineO", "brf", "clampNegatives", "back",
                       "part", "band", "scaleToTis", "entry"},
                      {"verb", "id", "spec", "name", "decoderAt"});
  OpenOptions options;
  given.read("spectral", options.keep_spectral);
  given.read("illuminant", options.illuminant);
  given.read("hasCosine", options.has_cosine);
  given.read("hasCosineO", options.has_cosine_o);
  given.read("brf", options.brf);
  given.read("clampNegatives", options.clamp_negatives);
  given.read("back", options.back_side);
  given.read("scaleToTis", options.scale_to_tis);
  given.read("band", options.band);
  if (const std::string part = given.text("part"); !part.empty()) {
    options.part = find_bsdf_part(part);
    if (!options.part)
      throw Error(fmt::format("open: expected a part such as transmission-front, found {}", in_quotes(part)));
  }
  given.text("entry");  // read by open_bytes: a text here
  // The caller has no files of lights, so only the names serve.
  constexpr std::array<std::string_view, 4> kLights{"E", "D50", "D65", "A"};
  if (std::ranges::find(kLights, options.illuminant) == kLights.end())
    throw Error(
        fmt::format("illuminant: expected E, D50, D65 or A, found {}", in_quotes(options.illuminant)));
  const auto open_it = [&]() -> Opened {
    if (a.contains("spec")) {
      const std::string spec = a.at("spec").get<std::string>();
      if (!is_analytic_spec(spec))
        throw Error(fmt::format(
            "expected a file's bytes or an analytic BRDF such as ggx:alpha_x=0.2,alpha_y=0.2, found '{}'",
            spec.substr(0, 80)));
      return {open_source(spec, options), {}, {}};
    }
    return open_bytes({a.value("name", "file"), std::move(request.bytes)}, a, options);
  };
  const auto [place, added] = materials().insert_or_assign(a.at("id").get<int>(), open_it());
  // Names may be other than UTF-8, so bad bytes are replaced.
  return {.json = summary_of(place->second).dump(-1, ' ', false, Json::error_handler_t::replace),
          .blobs = {}};
}

Reply info(const Request& request) {
  if (const Opened& found = opened(request.arguments); found.surface)
    return {.json = cli::surface_info_json(*found.surface, found.source.name)};
  const Source& source = material(request.arguments);
  return {.json = cli::info_json(report_on(source), cli::nodes_of(source)), .blobs = {}};
}

// Evaluates f. `bytes` are directions n x 3, all wi before all wo. Returns values n x channels, NaN where unknown.
Reply evaluate(const Request& request) {
  const Source& source = material(request.arguments);
  const BrdfRef brdf = source.ref();
  const double side = source.findings.transmits() ? -1 : 1;  // wo of a transmission lies below the surface
  const std::vector<float> directions = floats_of(request.bytes);
  if (directions.size() % 6 != 0)
    throw Error("evaluate: expected as many wi as wo, three numbers each, found another count");
  const std::size_t n = directions.size() / 6, channels = static_cast<std::size_t>(brdf.channels());
  constexpr std::size_t kChunk = 4096;
  std::vector<float> result;
  result.reserve(n * channels);
  std::vector<DirectionPair> pairs;
  std::vector<double> values(kChunk * channels);
  std::vector<std::uint8_t> known(kChunk);
  const auto direction = [&](std::size_t i) {
    const Vec3 w{directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]};
    const double size = std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
    if (!(std::abs(size - 1) < 1e-3))
      throw Error(fmt::format("evaluate: expected unit vectors, found one of length {:.4g}", size));
    return Vec3{w.x / size, w.y / size, w.z / size};
  };
  for (std::size_t begin = 0; begin < n; begin += kChunk) {
    const std::size_t count = std::min(kChunk, n - begin);
    pairs.clear();
    for (std::size_t i = begin; i < begin + count; ++i) {
      pairs.push_back({direction(i), direction(n + i)});
      pairs.back().wo.z *= side;
    }
    brdf.eval(pairs, std::span(values).first(count * channels), std::span(known).first(count));
    for (std::size_t i = 0; i < count * channels; ++i)
      result.push_back(known[i / channels] ? static_cast<float>(values[i])
                                           : std::numeric_limits<float>::quiet_NaN());
  }
  return {.json = Json{{"channels", channels}}.dump(), .blobs = {bytes_of(result)}};
}

// The albedo of light from theta_i (radians) at azimuth phi is NaN where more of the hemisphere than this share is
// unknown.
constexpr double kAllUnknown = 0.999;

Reply albedo(const Request& request) {
  const Source& source = material(request.arguments);
  double phi = 0;
  Options("albedo", request.arguments, {"phi"}, {"verb", "id"}).read("phi", phi);
  std::vector<float> result;
  for (const float theta : floats_of(request.bytes)) {
    if (!(theta >= 0 && theta < kHalfPi))
      throw Error(fmt::format("albedo: expected theta_i in [0, pi/2) radians, found {}", theta));
    const Vec3 wi{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const DirectionalAlbedo found = directional_albedo(source.ref(), wi);
    for (const double value : found.albedo)
      result.push_back(found.unknown_fraction > kAllUnknown ? std::numeric_limits<float>::quiet_NaN()
                                                            : static_cast<float>(value));
  }
  return {.json = Json{{"channels", source.ref().channels()}}.dump(), .blobs = {bytes_of(result)}};
}

// Fills values beyond the horizon or unknown with the nearest known value, along a row of theta_d.
void fill_unknown(std::span<float> values, std::span<const std::uint8_t> known, std::size_t channels,
                  std::size_t stride) {
  const std::size_t count = known.size();
  std::size_t last = count;
  const auto copy = [&](std::size_t from, std::size_t to) {
    std::copy_n(&values[from * stride], channels, &values[to * stride]);
  };
  for (std::size_t d = 0; d < count; ++d) {
    if (!known[d]) {
      if (last < count) copy(last, d);
      continue;
    }
    for (std::size_t before = last < count ? d : 0; before < d; ++before) copy(d, before);
    last = d;
  }
}

// Returns the pairs at the centres of cells of one phi_d: [theta_d][theta_h].
std::vector<DirectionPair> layer_pairs(std::size_t thetas_h, std::size_t thetas_d, double phi_h,
                                       double phi_d) {
  std::vector<DirectionPair> pairs;
  for (std::size_t d = 0; d < thetas_d; ++d)
    for (std::size_t h = 0; h < thetas_h; ++h) {
      const double x = (static_cast<double>(h) + 0.5) / static_cast<double>(thetas_h);
      const double theta_d = (static_cast<double>(d) + 0.5) / static_cast<double>(thetas_d) * kHalfPi;
      const auto [wi, wo] =
          from_half_diff({.theta_h = x * x * kHalfPi, .phi_h = phi_h, .theta_d = theta_d, .phi_d = phi_d});
      pairs.push_back({wi, wo});
    }
  return pairs;
}

// Evaluates at centres of cells: theta_h = ((x + 1/2) / thetaH)^2 pi/2, theta_d = (y + 1/2) / thetaD pi/2, phi_d = (z +
// 1/2) / phiD 2 pi.
Reply volume(const Request& request, const Progress& progress) {
  const BrdfRef brdf = material(request.arguments).ref();
  const Options given("volume", request.arguments, {"thetaH", "thetaD", "phiD", "phiH"}, {"verb", "id"});
  constexpr std::uint64_t kMinCells = 2, kMaxCells = 512;  // along a side
  std::array<std::size_t, 3> size{90, 90, 180};
  given.read("thetaH", size[0], kMinCells, kMaxCells);
  given.read("thetaD", size[1], kMinCells, kMaxCells);
  given.read("phiD", size[2], kMinCells, kMaxCells);
  double phi_h = 0;
  given.read("phiH", phi_h);
  const auto channels = brdf.channels();
  const auto [nh, nd, np] = size;
  std::vector<float> data;
  data.reserve(nh * nd * np * channels);
  std::vector<double> values(nh * nd * channels);
  std::vector<std::uint8_t> known(nh * nd), column(nd);
  for (std::size_t p = 0; p < np; ++p) {
    const double phi_d = (static_cast<double>(p) + 0.5) / static_cast<double>(np) * 2 * kPi;
    const std::vector<DirectionPair> pairs = layer_pairs(nh, nd, phi_h, phi_d);
    brdf.eval(pairs, values, known);
    const std::size_t first = data.size();
    data.insert(data.end(), values.begin(), values.end());
    for (std::size_t h = 0; h < nh; ++h) {
      for (std::size_t d = 0; d < nd; ++d) {
        const auto& [wi, wo] = pairs[d * nh + h];
        column[d] = known[d * nh + h] && wi.z > 0 && wo.z > 0;
      }
      fill_unknown(std::span(data).subspan(first + h * channels), column, channels, nh * channels);
    }
    progress("sampling", (static_cast<double>(p) + 1) / static_cast<double>(np));
  }
  return {.json = Json{{"size", {nh, nd, np}}, {"channels", channels}}.dump(), .blobs = {bytes_of(data)}};
}

Json size_of(const RglGrid& grid) {
  return {grid.width, grid.height};
}

// Returns the table that a measurement is interpolated from, so that a GPU can do the same. Returns null for other
// sources.
Reply table(const Request& request) {
  const Source& source = material(request.arguments);
  if (const auto* cells = std::get_if<HalfDiffTable>(&source.brdf))
    return {.json = Json{{"kind", "half_diff"},
                         {"size", {cells->theta_h_count, cells->theta_d_count, cells->phi_d_count}},
                         {"fullCircle", cells->full_circle},
                         {"channels", cells->channel_count}}
                        .dump(),
            .blobs = {bytes_of(cells->values)}};
  if (const auto* rgl = std::get_if<RglTable>(&source.brdf)) {
    const RglData& data = rgl->data();
    return {
        .json = Json{{"kind", "rgl"},
                     {"channels", data.channels},
                     {"isotropic", rgl->isotropic()},
                     {"reduction", rgl->reduction()},
                     {"jacobian", data.jacobian},
                     {"ndf", size_of(data.ndf)},
                     {"sigma", size_of(data.sigma)},
                     {"vndf", size_of(data.vndf)},
                     {"spectra", size_of(data.spectra)}}
                    .dump(),
        .blobs = {bytes_of(data.phi_i), bytes_of(data.theta_i), bytes_of(data.ndf.values),
                  bytes_of(data.sigma.values), bytes_of(data.vndf.values), bytes_of(data.spectra.values)}};
  }
  return {};
}

// Fits a model and returns its file, which the caller opens.
Reply fit_material(const Request& request, const Progress& progress) {
  const Source& source = material(request.arguments);
  FitOptions options =
      fit_options(request_of_json(request.arguments.at("options"), FitFront::page), source.ref().isotropic());
  options.progress = progress;
  const auto start = std::chrono::steady_clock::now();
  Fit found = fit(source, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string file = format_compact(to_model(found), CompactContent::model_and_notes);
  std::string report = summary_json(found, request.arguments.value("name", "model"), seconds, file.size());
  return {.json = std::move(report), .blobs = {std::move(file)}};
}

// Returns the numbers of a number or of a list.
std::vector<double> numbers(const Json& value) {
  const std::vector<Json> list = value.is_array() ? value.get<std::vector<Json>>() : std::vector{value};
  std::vector<double> result;
  for (const Json& number : list) {
    if (!number.is_number())
      throw Error(fmt::format("edit: expected a number, found {}", number.dump().substr(0, 40)));
    result.push_back(number.get<double>());
  }
  return result;
}

// Multiplies the scale by a number, or by one number for each channel.
void multiply(std::vector<double>& scale, const Json& by) {
  const std::vector<double> factors = numbers(by);
  if (factors.size() != 1 && factors.size() != scale.size())
    throw Error(fmt::format("edit: expected 1 or {} factors, found {}", scale.size(), factors.size()));
  for (std::size_t c = 0; c < scale.size(); ++c) scale[c] *= factors[factors.size() == 1 ? 0 : c];
}

// Changes a model's colours, widths and scales, and adds a Lambertian part. Returns its file, as a fit does.
Reply edit(const Request& request) {
  const Json& how = request.arguments.at("edit");
  const Options given("edit", how, {"scale", "hue", "roughness", "diffuse"});
  double roughness = 1;
  given.read("roughness", roughness);
  const FactoredBrdf model = edited(model_of(request.arguments),
                                    {.hue = numbers(how.value("hue", Json(0))), .roughness = roughness});
  std::vector<Lobe> lobes(model.lobes().begin(), model.lobes().end());
  if (const auto scale = how.find("scale"); scale != how.end()) {
    // A list of lists has an element for each lobe.
    const bool each =
        scale->is_array() && std::ranges::any_of(*scale, [](const Json& s) { return s.is_array(); });
    if (each && scale->size() != lobes.size())
      throw Error(fmt::format("edit: expected scales of {} lobes, found {}", lobes.size(), scale->size()));
    for (std::size_t l = 0; l < lobes.size(); ++l) multiply(lobes[l].scale, each ? (*scale)[l] : *scale);
  }
  if (const auto diffuse = how.find("diffuse"); diffuse != how.end()) {
    Lobe lambertian{.scale = std::vector<double>(static_cast<std::size_t>(model.channels()), 1 / kPi),
                    .factors = {}};
    multiply(lambertian.scale, *diffuse);
    lobes.push_back(std::move(lambertian));
  }
  const Model result{.brdf = FactoredBrdf(model.channels(), {model.tables().begin(), model.tables().end()},
                                          std::move(lobes)),
                     .lambda_nm = material(request.arguments).findings.lambda_nm};
  return {.json = "{}", .blobs = {format_compact(result, CompactContent::model_and_notes)}};
}

Reply compare(const Request& request) {
  const Json& a = request.arguments;
  const Options given("compare", a, {"target", "only", "symmetrize", "count", "seed"},
                      {"verb", "id", "models"});
  bool symmetrize = true;
  given.read("symmetrize", symmetrize);
  const bool nodes_only = parse_fit_target(given.text("target", "function")) == FitTarget::nodes;
  FigureOptions figures;
  given.read("count", figures.count, 1, 100'000'000);
  given.read("seed", figures.seed);
  const cli::Candidate reference(material(a), symmetrize);
  std::list<cli::Candidate> candidates;
  std::vector<ComparedModel> models;
  for (const Json& id : a.at("models")) {
    const Source& source = material(Json{{"id", id}});
    models.push_back(candidates.emplace_back(source, symmetrize).compared(source.name));
  }
  const auto measurement = cli::measurement_of(reference, nodes_only, given.text("only"));
  if (nodes_only) return {.json = nodes_json(*measurement, models), .blobs = {}};
  const Measurement* const measured = measurement ? &*measurement : nullptr;
  const Scorer scorer(reference.ref(), figures);
  return {.json = to_json(compare_models(scorer, models, measured), measured), .blobs = {}};
}

// Returns the scored pictures in RGB bytes: the reference's, then the model's under the reference's exposure.
Reply images(const Request& request) {
  const Json& a = request.arguments;
  const Options given("images", a, {"symmetrize", "size"}, {"verb", "id", "model"});
  bool symmetrize = true;
  int size = kSphereSize;
  given.read("symmetrize", symmetrize);
  given.read("size", size, 16, 8192);
  const cli::Candidate reference(material(a), symmetrize), model(material(a, "model"), symmetrize);
  const Scorer scorer(reference.ref(), {.count = 1, .image_size = size});
  Reply reply{.json = Json{{"size", size}, {"exposure", scorer.exposure()}}.dump(), .blobs = {}};
  const SpherePictures of_model = scorer.pictures(model.ref());
  for (const SpherePictures* pictures : {&scorer.reference_pictures(), &of_model})
    for (const Image& shown : pictures->shown) reply.blobs.push_back(bytes_of(to_image8(shown).pixels));
  return reply;
}

ShaderLanguage language_named(const std::string& name) {
  std::vector<std::string_view> names;
  for (const ShaderLanguage language : kShaderLanguages) {
    if (to_string(language) == name) return language;
    names.push_back(to_string(language));
  }
  throw Error(fmt::format("shader: expected {}, found '{}'", listed(names), name));
}

void add_textures(std::span<const ShaderTexture> textures, Json& list, Reply& reply) {
  for (const ShaderTexture& t : textures) {
    list.push_back({{"name", t.name},
                    {"width", t.width},
                    {"height", t.height},
                    {"depth", t.depth},
                    {"channels", t.channels},
                    {"format", to_string(t.format)}});
    // Floats are packed to rgb9e5 here, since browsers pack them in different ways, some wrongly.
    reply.blobs.push_back(bytes_of(t.format == TableFormat::rgb9e5
                                       ? pack(t.format, t.channels, t.values)
                                       : pack(TableFormat::single, t.channels, t.values)));
  }
}

// Returns the shader of a surface and its textures. Its maps, four components of bytes or halves, follow with a blob
// for each level.
Reply surface_shader_of(const Request& request, const ShaderOptions& options) {
  const SpatialShader made = generate_shader(surface_of(request.arguments).brdf, options);
  Reply reply;
  Json textures = Json::array(), maps = Json::array();
  add_textures(made.textures, textures, reply);
  for (const MapTexture& map : made.maps.textures) {
    maps.push_back({{"name", map.name},
                    {"width", map.width},
                    {"height", map.height},
                    {"levels", map.levels.size()},
                    {"format", to_string(map.format)}});
    for (const std::vector<std::byte>& level : map.levels) reply.blobs.push_back(bytes_of(level));
  }
  reply.json = Json{{"code", made.text},
                    {"language", to_string(options.language)},
                    {"filter", options.filter == ShaderFilter::exact ? "exact" : "hardware"},
                    {"function", fmt::format("burnish_{}", options.name)},
                    {"functionWorld", fmt::format("burnish_{}_world", options.name)},
                    {"framed", made.maps.normals.has_value() || made.maps.tangents.has_value()},
                    {"cost", cost_json(made.light_cost)},
                    {"placeCost", cost_json(made.place_cost)},
                    {"costText", burnish::to_string(made.light_cost)},
                    {"textures", std::move(textures)},
                    {"maps", std::move(maps)}}
                   .dump();
  return reply;
}

// Returns the file of the uniform model at a surface's place.
Reply place(const Request& request) {
  const Json& a = request.arguments;
  const Options given("place", a, {"lod"}, {"verb", "id", "u", "v"});
  double u = std::numeric_limits<double>::quiet_NaN(), v = u, lod = 0;
  given.read("u", u);
  given.read("v", v);
  given.read("lod", lod);
  if (!std::isfinite(u + v + lod)) throw Error("place: expected finite numbers u, v and lod, found others");
  const SpatialBrdf& surface = surface_of(a).brdf;
  return {.json = "{}",
          .blobs = {format_compact({.brdf = surface.at(u, v, lod), .lambda_nm = {}, .notes = "{}"},
                                   CompactContent::model_and_notes)}};
}

// Returns a shader. Its textures follow as blobs of floats, [z][y][x][channel], or of rgb9e5's words.
Reply shader(const Request& request) {
  const Json& a = request.arguments;
  const Options given("shader", a, {"name", "exact", "halfProducts", "linesAre1d"},
                      {"verb", "id", "language"});
  const ShaderLanguage language = language_named(given.text("language"));
  ShaderOptions options{.language = language, .name = given.text("name", "brdf")};
  bool exact = language == ShaderLanguage::cpp;
  given.read("exact", exact);
  options.filter = exact ? ShaderFilter::exact : ShaderFilter::hardware;
  given.read("halfProducts", options.half_products);
  given.read("linesAre1d", options.lines_are_1d);
  if (opened(a).surface) return surface_shader_of(request, options);
  const Shader made = generate_shader(model_of(a), options);
  Reply reply;
  Json textures = Json::array();
  add_textures(made.textures, textures, reply);
  reply.json = Json{{"code", made.text},
                    {"language", to_string(language)},
                    {"filter", exact ? "exact" : "hardware"},
                    {"function", fmt::format("burnish_{}", options.name)},
                    {"functionWorld", fmt::format("burnish_{}_world", options.name)},
                    {"cost", cost_json(made.cost)},
                    {"costText", burnish::to_string(made.cost)},
                    {"textures", std::move(textures)}}
                   .dump();
  return reply;
}

Reply reply_of(std::span<const std::pair<std::string, std::string>> files, Json losses) {
  Reply reply;
  Json names = Json::array();
  for (const auto& [name, bytes] : files) {
    names.push_back(name);
    reply.blobs.push_back(bytes);
  }
  reply.json = Json{{"names", std::move(names)}, {"losses", std::move(losses)}}.dump();
  return reply;
}

Reply reply_of(ExportedFiles exported) {
  std::vector<std::pair<std::string, std::string>> files;
  for (ExportedFile& file : exported.files) files.emplace_back(std::move(file.name), std::move(file.bytes));
  return reply_of(files, exported.losses);
}

Reply export_surface_of(const SurfaceModel& surface, const std::string& kind, const std::string& name) {
  if (kind == "burnish") {
    const std::pair<std::string, std::string> file{name, format_surface(surface)};
    return reply_of(std::span(&file, 1), Json::array());
  }
  return reply_of(export_surface(
      surface.brdf, {.to = {export_target(kind)}, .name = export_name(name), .compressed = false}));
}

// Writes a format of the verb convert, or a target of the verb export.
Reply export_material(const Request& request) {
  const Json& a = request.arguments;
  const Options given("export", a,
                      {"name", "exact", "half", "mips", "cells", "count", "seed", "entries", "notes"},
                      {"verb", "id", "kind"});
  const std::string kind = given.text("kind"), name = given.text("name", "brdf");
  if (const auto& surface = opened(a).surface) return export_surface_of(*surface, kind, name);
  const Source& source = material(a);
  const bool is_model = std::holds_alternative<FactoredBrdf>(source.brdf);
  const std::vector<std::string_view> formats = convert_formats();
  std::vector<std::string_view> kinds = formats;
  for (const std::string_view target : export_target_names())
    if (std::ranges::find(kinds, target) == kinds.end()) kinds.push_back(target);
  if (std::ranges::find(kinds, kind) == kinds.end())
    throw Error(fmt::format("export: {}", expected_one_of(kinds, kind)));
  if (std::ranges::find(formats, kind) != formats.end()) {
    ConvertOptions options;
    given.read("count", options.count, 1, 100'000'000);
    given.read("seed", options.seed);
    given.read("entries", options.entries);
    given.read("cells", options.cells, 1);
    given.read("notes", options.notes);
    Converted converted = convert(source, is_model && kind == "exr" ? "model" : kind, options);
    const std::pair<std::string, std::string> file{name, std::move(converted.bytes)};
    return reply_of(std::span(&file, 1), converted.losses);
  }
  ExportOptions options{.to = {export_target(kind)}, .name = name, .compressed = false};
  given.read("exact", options.exact);
  given.read("half", options.half);
  given.read("mips", options.mips);
  // OpenPBR is exported by its formulas, without a fit.
  if (const auto* const brdf = std::get_if<AnalyticBrdf>(&source.brdf);
      brdf && brdf->model().name == "openpbr")
    return reply_of(export_openpbr(*brdf, options));
  return reply_of(export_model(model_of(a), options));
}

Reply close(const Request& request) {
  materials().erase(request.arguments.at("id").get<int>());
  return {};
}

}  // namespace

Reply run(Request request, const Progress& progress) {
  const std::string verb = request.arguments.at("verb").get<std::string>();
  if (verb == "open") return open(std::move(request));
  if (verb == "info") return info(request);
  if (verb == "evaluate") return evaluate(request);
  if (verb == "albedo") return albedo(request);
  if (verb == "volume") return volume(request, progress);
  if (verb == "table") return table(request);
  if (verb == "place") return place(request);
  if (verb == "fit") return fit_material(request, progress);
  if (verb == "compare") return compare(request);
  if (verb == "images") return images(request);
  if (verb == "shader") return shader(request);
  if (verb == "export") return export_material(request);
  if (verb == "edit") return edit(request);
  if (verb == "close") return close(request);
  throw Error(fmt::format("expected a verb of the package, found '{}'", verb));
}

}  // namespace burnish::wasm
