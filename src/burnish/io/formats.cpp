// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include <burnish/baselines/baseline_file.h>
#include <burnish/book/book_file.h>
#include <burnish/factors/compact_file.h>
#include <burnish/io/alta.h>
#include <burnish/io/astm.h>
#include <burnish/io/convert_writers.h>
#include <burnish/io/cornell.h>
#include <burnish/io/csv.h>
#include <burnish/io/formats.h>
#include <burnish/io/fourier.h>
#include <burnish/io/fred.h>
#include <burnish/io/integra.h>
#include <burnish/io/klems.h>
#include <burnish/io/lighttools.h>
#include <burnish/io/mbsdf.h>
#include <burnish/io/merl.h>
#include <burnish/io/neural.h>
#include <burnish/io/np.h>
#include <burnish/io/openmaterial.h>
#include <burnish/io/rgl.h>
#include <burnish/io/speos.h>
#include <burnish/io/speos_scattering.h>
#include <burnish/io/ssdd.h>
#include <burnish/io/tensor_tree_xml.h>
#include <burnish/io/utia.h>
#include <burnish/io/window_xml.h>
#include <burnish/io/zemax.h>
#include <burnish/surface/surface_file.h>

namespace burnish {

namespace {

/// Wraps a function of the bytes or of the text as Format::looks_like.
template <auto looks_like>
bool seen(const FileBytes& file) {
  if constexpr (requires { looks_like(file.text()); })
    return looks_like(file.text());
  else
    return looks_like(std::span<const std::byte>(file.bytes));
}

/// Wraps a reader as Format::parse. It returns a table, samples or a function with findings, and takes options or none.
template <auto parse>
Source read_by(const FileBytes& file, const OpenOptions& options) {
  auto parsed = [&] {
    if constexpr (requires { parse(file, options); })
      return parse(file, options);
    else
      return parse(file);
  }();
  if constexpr (requires { parsed.samples; })
    return {file.name, ScatteredBrdf(std::move(parsed.samples), SampleRule::kriged),
            std::move(parsed.findings)};
  else if constexpr (requires { parsed.brdf; })
    return {file.name, std::move(parsed.brdf), std::move(parsed.findings)};
  else
    return {file.name, std::move(parsed.table), std::move(parsed.findings)};
}

Source read_cornell(const FileBytes& file, const OpenOptions& options) {
  SampleFile parsed = parse_cornell(file, options);
  return {file.name, ScatteredBrdf(std::move(parsed.samples), SampleRule::mean_in_half_difference),
          std::move(parsed.findings)};
}

/// Reads a tensor tree. Trees of colour become one function, since each tree has its own cubes.
Source read_tensor_tree(const FileBytes& file, const OpenOptions& options) {
  TensorTreeFile parsed = parse_tensor_tree(file, options);
  Findings findings = parsed.findings;
  if (parsed.colour.empty()) return {file.name, std::move(parsed.table), std::move(findings)};
  return {file.name, colour_of(std::move(parsed)), std::move(findings)};
}

Source read_ssdd(const FileBytes& file, const OpenOptions& options) {
  SsddFile parsed = parse_ssdd(file, options);
  return std::visit(
      [&](auto& brdf) {
        return Source{file.name, std::move(brdf), std::move(parsed.findings)};
      },
      parsed.brdf);
}

Source read_model(const FileBytes& file, const OpenOptions&) {
  return to_source(file.name, parse_model(file));
}

Source read_baseline(const FileBytes& file, const OpenOptions&) {
  return to_source(file.name, parse_baseline(file));
}

Source read_neural(const FileBytes& file, const OpenOptions&) {
  NeuralFile parsed = parse_neural(file, {});
  return {fmt::format("{}#{}", file.name, parsed.name), std::move(parsed.brdf), std::move(parsed.findings)};
}

/// Refuses a file of several BRDFs, because one of them has to be named.
Source refuse_book(const FileBytes& file, const OpenOptions&) {
  throw Error::in_file(file.name,
                       "book:FILE#NAME for one material of a book (`burnish info FILE` names them)",
                       "the book alone");
}

Source refuse_surface(const FileBytes& file, const OpenOptions&) {
  throw Error::in_file(
      file.name, "surface:FILE#COLUMN,ROW for one texel of a surface (`burnish info FILE` says how many)",
      "the surface alone");
}

Source refuse_np(const FileBytes& file, const OpenOptions&) {
  throw Error::in_file(file.name, "np:FILE#NAME for one of its codes, with decoder.f32 in the same folder",
                       "the file alone");
}

/// Returns true for a model's OpenEXR file. A surface's files are a model's with more in them.
bool is_exr_model(const FileBytes& file) {
  return looks_like_model(file.bytes) && !looks_like_compact(file.bytes) && !looks_like_surface(file.bytes);
}

bool is_compact_model(const FileBytes& file) {
  return looks_like_compact(file.bytes) && !looks_like_surface(file.bytes);
}

/// Returns true for a Zemax file. A line of text may stand before the XML of a window system, so that is excluded.
/// LightTools' and Integra's files may begin as Zemax' do. Tensor trees are window systems too, and OpenMATERIAL files
/// are JSON as baselines are.
bool is_zemax(const FileBytes& file) {
  const std::string_view text = file.text();
  return looks_like_zemax(text) && !looks_like_window_xml(text) && !looks_like_lighttools(text) &&
         !looks_like_integra(text);
}

bool is_lighttools(const FileBytes& file) {
  return looks_like_lighttools(file.text()) && !looks_like_window_xml(file.text());
}

bool is_integra(const FileBytes& file) {
  return looks_like_integra(file.text()) && !looks_like_lighttools(file.text()) &&
         !looks_like_window_xml(file.text());
}

bool is_klems(const FileBytes& file) {
  return looks_like_klems(file.text()) && !looks_like_tensor_tree(file.text());
}

bool is_baseline(const FileBytes& file) {
  return looks_like_baseline(file.text()) && !looks_like_openmaterial(file.text());
}

// Rows stand in the order of `burnish help formats`.
constexpr Format kFormats[] = {
    {.title = "MERL",
     .to = "merl",
     .endings = ".binary",
     .holds = "half/difference cells, RGB, isotropic",
     .told = Told::by_sizes,
     .looks_like = seen<looks_like_merl>,
     .parse = read_by<parse_merl>,
     .write = write_merl,
     .takes_cells = true},
    {.title = "UTIA",
     .to = "utia",
     .endings = ".bin",
     .holds = "6 x 48 directions of light and view, RGB",
     .told = Told::by_length,
     .looks_like = seen<looks_like_utia>,
     .parse = read_by<parse_utia>,
     .write = write_utia},
    {.title = "RGL",
     .to = "rgl",
     .endings = ".bsdf",
     .holds = "adaptive nodes, RGB or spectra",
     .told = Told::by_signature,
     .looks_like = seen<looks_like_rgl>,
     .parse = read_by<parse_rgl>,
     .write = write_rgl,
     .other_endings = ".txt",
     .keeps_name = true},
    {.title = "MBSDF",
     .to = "mbsdf",
     .endings = ".mbsdf",
     .holds = "even angles, grey or RGB, isotropic",
     .told = Told::by_signature,
     .looks_like = seen<looks_like_mbsdf>,
     .parse = read_by<parse_mbsdf>,
     .write = write_mbsdf,
     .takes_cells = true,
     .keeps_transmission = true},
    {.title = "Zemax",
     .to = "zemax",
     .endings = ".bsdf",
     .holds = "angles around the mirror direction, grey or XYZ",
     .looks_like = is_zemax,
     .parse = read_by<parse_zemax>,
     .write = write_zemax,
     .other_endings = ".txt",
     .keeps_name = true,
     .keeps_comments = true,
     .keeps_transmission = true},
    {.title = "tensor tree",
     .to = "tensortree",
     .endings = ".xml",
     .holds = "cubes of Shirley-Chiu squares, grey (rank 3 only from rank 3)",
     .looks_like = seen<looks_like_tensor_tree>,
     .parse = read_tensor_tree,
     .write = write_tensor_tree,
     .write_parts = write_tensor_tree_parts,
     .takes_cells = true,
     .keeps_name = true,
     .keeps_transmission = true,
     .keeps_block = true},
    {.title = "Klems",
     .to = "klems",
     .endings = ".xml",
     .holds = "patches of both hemispheres, grey",
     .looks_like = is_klems,
     .parse = read_by<parse_klems>,
     .write = write_klems,
     .write_parts = write_klems_parts,
     .takes_cells = true,
     .keeps_name = true,
     .keeps_transmission = true,
     .keeps_block = true},
    {.title = "Speos",
     .to = "speos",
     .endings = ".anisotropicbsdf, .brdf",
     .holds = "theta and phi of each incidence, grey or spectra",
     .looks_like = seen<looks_like_speos>,
     .parse = read_by<parse_speos>,
     .write = write_speos,
     .write_parts = write_speos_parts,
     .keeps_name = true,
     .keeps_transmission = true},
    {.title = "simple scattering",
     .endings = ".simplescattering",
     .holds = "Speos' Lambertian and Gaussian shares, grey, isotropic",
     .looks_like = seen<looks_like_speos_scattering>,
     .parse = read_by<parse_speos_scattering>},
    {.title = "LightTools",
     .endings = ".bsdf",
     .holds = "theta and phi of each incidence, grey or XYZ, isotropic",
     .looks_like = is_lighttools,
     .parse = read_by<parse_lighttools>},
    {.title = "Integra",
     .endings = ".ddr, .ddt",
     .holds = "angles around the mirror direction, grey, RGB or spectra",
     .looks_like = is_integra,
     .parse = read_by<parse_integra>},
    {.title = "SSDD",
     .endings = ".ssdd",
     .holds = "angles in four systems, grey, RGB, XYZ or spectra",
     .looks_like = seen<looks_like_ssdd>,
     .parse = read_ssdd},
    {.title = "Fourier BSDF",
     .endings = ".bsdf",
     .holds = "cosine series between splines, grey or RGB, isotropic",
     .told = Told::by_signature,
     .looks_like = seen<looks_like_fourier>,
     .parse = read_by<parse_fourier>},
    {.title = "OpenMATERIAL 3D",
     .to = "openmaterial",
     .endings = ".xompt",
     .holds = "scattered spectra, isotropic",
     .looks_like = seen<looks_like_openmaterial>,
     .parse = read_by<parse_openmaterial>,
     .write = write_openmaterial,
     .other_endings = ".json",
     .takes_count = true,
     .keeps_name = true,
     .keeps_origin = true},
    {.title = "ALTA",
     .endings = ".dat",
     .holds = "scattered, in coordinates of its own, grey or RGB",
     .looks_like = seen<looks_like_alta>,
     .parse = read_by<parse_alta>},
    {.title = "ASTM E1392",
     .to = "astm",
     .endings = ".astm",
     .holds = "scattered, grey, RGB or spectra",
     .told = Told::by_columns,
     .looks_like = seen<looks_like_astm>,
     .parse = read_by<parse_astm>,
     .write = write_astm,
     .other_endings = ".txt",
     .takes_count = true,
     .entries_first = true},
    {.title = "CSV",
     .to = "csv",
     .endings = ".csv, .txt",
     .holds = "scattered, grey, RGB or spectra",
     .told = Told::by_columns,
     .looks_like = seen<looks_like_csv>,
     .parse = read_by<parse_csv>,
     .write = write_csv,
     .takes_count = true,
     .entries_first = true},
    {.title = "FRED",
     .endings = ".txt",
     .holds = "scattered, grey, isotropic",
     .looks_like = seen<looks_like_fred>,
     .parse = read_by<parse_fred>},
    {.title = "Cornell",
     .endings = ".brdf",
     .holds = "scattered spectra, isotropic",
     .told = Told::by_columns,
     .looks_like = seen<looks_like_cornell>,
     .parse = read_cornell},
    {.title = "EXR slices",
     .to = "exr",
     .endings = ".exr",
     .holds = "half/difference cells to look at",
     .write = write_slices,
     .takes_cells = true},
    {.title = "model, OpenEXR",
     .to = "model",
     .endings = ".exr",
     .holds = "what fit writes",
     .told = Told::by_signature,
     .looks_like = is_exr_model,
     .parse = read_model,
     .write = write_model,
     .keeps_transmission = true,
     .keeps_block = true},
    {.title = "model, compact",
     .to = "burnish",
     .endings = ".burnish",
     .holds = "what fit writes",
     .told = Told::by_signature,
     .looks_like = is_compact_model,
     .parse = read_model,
     .write = write_compact,
     .takes_notes = true,
     .keeps_transmission = true,
     .keeps_block = true},
    {.title = "surface",
     .endings = ".burnish, .exr",
     .holds = "surface:FILE#COLUMN,ROW, what fit-surface writes",
     .told = Told::by_signature,
     .looks_like = seen<looks_like_surface>,
     .parse = refuse_surface,
     .written_elsewhere = true},
    {.title = "book of a library",
     .endings = ".burnish",
     .holds = "book:FILE#NAME, what book writes",
     .told = Told::by_signature,
     .looks_like = seen<looks_like_book>,
     .parse = refuse_book},
    {.title = "baseline",
     .endings = ".json",
     .holds = "what fit --method writes",
     .looks_like = is_baseline,
     .parse = read_baseline},
    {.title = "network weights",
     .endings = ".csv",
     .holds = "nbrdf:FILE#NAME",
     .looks_like = seen<looks_like_neural>,
     .parse = read_neural},
    {.title = "Neural Processes codes",
     .endings = ".csv",
     .holds = "np:FOLDER#NAME",
     .told = Told::by_columns,
     .looks_like = seen<looks_like_np>,
     .parse = refuse_np},
};

/// Returns the first format that the file looks like, of those recognized in these ways, the surest first.
const Format* told_format(const FileBytes& file, std::span<const Told> ways) {
  for (const Told way : ways)
    for (const Format& format : kFormats)
      if (format.told == way && format.is_read() && format.looks_like(file)) return &format;
  return nullptr;
}

std::string_view first_ending(const Format& format) noexcept {
  return format.endings.substr(0, format.endings.find(','));
}

}  // namespace

std::span<const Format> formats() noexcept {
  return kFormats;
}

const Format* binary_format_of(const FileBytes& file) {
  using enum Told;
  static constexpr Told kWays[] = {by_signature, by_length, by_sizes};
  return told_format(file, kWays);
}

const Format* text_format_of(const FileBytes& file) {
  using enum Told;
  static constexpr Told kWays[] = {by_words, by_columns};
  return told_format(file, kWays);
}

const Format* format_to(std::string_view name) noexcept {
  const auto* found =
      std::ranges::find_if(kFormats, [&](const Format& f) { return f.write && f.to == name; });
  return found == std::end(kFormats) ? nullptr : found;
}

const Format* format_ending_in(std::string_view ending) noexcept {
  const auto* found = std::ranges::find_if(
      kFormats, [&](const Format& f) { return f.write && !ending.empty() && first_ending(f) == ending; });
  return found == std::end(kFormats) ? nullptr : found;
}

std::vector<std::string> endings_of(const Format& format) {
  std::vector<std::string> endings;
  for (std::string_view rest : {format.endings, format.other_endings})
    while (!rest.empty()) {
      const std::size_t comma = std::min(rest.find(", "), rest.size());
      endings.emplace_back(rest.substr(0, comma));
      rest.remove_prefix(std::min(comma + 2, rest.size()));
    }
  return endings;
}

std::vector<std::string_view> naming_endings() {
  std::vector<std::string_view> endings;
  for (const Format& format : kFormats)
    if (format.write && format_ending_in(first_ending(format)) == &format)
      endings.push_back(first_ending(format));
  return endings;
}

}  // namespace burnish
