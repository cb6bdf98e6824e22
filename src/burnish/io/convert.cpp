// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/io/astm.h>
#include <burnish/io/convert_compare.h>
#include <burnish/io/convert_writers.h>
#include <burnish/io/csv.h>
#include <burnish/io/formats.h>
#include <burnish/io/mbsdf.h>
#include <burnish/io/merl.h>
#include <burnish/io/open_source.h>
#include <burnish/io/openmaterial.h>
#include <burnish/io/rgl.h>
#include <burnish/io/slice_image.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/utia.h>
#include <burnish/io/window_xml.h>
#include <burnish/io/zemax.h>
#include <burnish/math/closest_name.h>
#include <burnish/math/spectrum.h>
#include <burnish/reflectance/azimuth_mean.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

namespace {

constexpr double kReciprocal = 1e-6;  // an asymmetry up to this is rounding
constexpr std::size_t kMirrorPairs = 500;
constexpr double kGrey_nm = 555;  // wavelength of grey in a format of spectra

/// A source mirrored in the plane of incidence: it has the values of the other side.
struct OtherSide {
  BrdfRef source;

  std::size_t channels() const noexcept { return source.channels(); }
  bool isotropic() const noexcept { return source.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    // An isotropic source has its sides exchanged if both directions are reflected at any one plane through the normal.
    return source.eval({wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}, f);
  }
};

/// Returns the table with each value three times.
AngleTable in_three_channels(const AngleTable& grey) {
  AngleTable table = grey;
  table.channel_count = 3;
  table.values.clear();
  for (const float value : grey.values) table.values.insert(table.values.end(), 3, value);
  return table;
}

/// Returns true if the description is in the file's own words. MERL and UTIA files have none, so theirs is burnish's.
bool has_own_remark(const Source& source) {
  const auto* angles = std::get_if<AngleTable>(&source.brdf);
  return is_measurement(source) && !std::holds_alternative<HalfDiffTable>(source.brdf) &&
         !(angles && fits_utia(*angles));
}

/// Returns the comments that are left behind, in quotes and shortened.
std::string named_comments(const std::vector<std::string>& comments) {
  constexpr std::size_t kMost = 12, kLongest = 60;
  std::string text = comments.size() == 1 ? "the comment" : fmt::format("{} comments:", comments.size());
  for (std::size_t k = 0; k < std::min(comments.size(), kMost); ++k)
    text += fmt::format("{} '{}'", k > 0 ? "," : "", printable(trimmed(comments[k]), kLongest));
  return comments.size() > kMost ? text + fmt::format(" and {} more", comments.size() - kMost) : text;
}

/// Returns the places of samples whose directions are both so far above the horizon that a reader accepts them.
std::vector<std::size_t> above_horizon(const Samples& samples) {
  constexpr double kMinCosine = 1e-9;
  std::vector<std::size_t> above;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (std::min(samples.pairs[i].wi.z, samples.pairs[i].wo.z) > kMinCosine) above.push_back(i);
  return above;
}

/// One conversion.
class Converter {
 public:
  Converter(const Source& source, const ConvertOptions& options, Losses losses)
      : source_(source),
        options_(options),
        brdf_(source.ref().unclamped()),
        mean_(brdf_),
        losses_(std::move(losses)) {}

 private:
  template <class... T>
  void lose(fmt::format_string<T...> phrase, T&&... values) {
    losses_.push_back(fmt::format(phrase, std::forward<T>(values)...));
  }

  template <class... T>
  void note(fmt::format_string<T...> phrase, T&&... values) {
    notes_.push_back(fmt::format(phrase, std::forward<T>(values)...));
  }

  void require_grey_or_rgb(const char* format) const {
    if (const std::size_t channels = brdf_.channels(); channels != 1 && channels != 3)
      throw Error::in_file(source_.name, fmt::format("grey or RGB for {}, so no --spectral", format),
                           fmt::format("{} channels", channels));
  }

  void require_grey_or_rgb_or_spectra() const {
    const auto bands = source_.findings.lambda_nm.size();
    if (const std::size_t channels = brdf_.channels(); channels != 1 && channels != 3 && bands == 0)
      throw Error::in_file(source_.name, "grey, RGB or wavelengths for OpenMATERIAL",
                           fmt::format("{} channels", channels));
  }

  /// Returns the source, or its mean over the azimuth.
  BrdfRef isotropic() {
    if (brdf_.isotropic()) return brdf_;
    lose("anisotropy averaged over {} azimuths", AzimuthMean::kTurns);
    return mean_;
  }

  /// Notes the asymmetry that a format averages because it holds one order of the two directions.
  void lose_asymmetry(BrdfRef brdf) {
    if (const double error = reciprocity_error(brdf, kMirrorPairs, 1).mean; error > kReciprocal)
      lose("values of exchanged directions were averaged (asymmetry {:.3g} %)", 100 * error);
  }

  void lose_sides(BrdfRef brdf) {
    if (const auto error = relative_difference(brdf, OtherSide{brdf}, kMirrorPairs).value_or(0);
        error > kReciprocal)
      lose("both sides of the plane of incidence were averaged (difference {:.3g} %)", 100 * error);
  }

  void lose_unknown(const AngleTable& made) {
    const auto entries = made.values.size() / made.channel_count;
    const auto unknown = static_cast<std::size_t>(
        std::count_if(made.values.begin(), made.values.end(), [](float v) { return std::isnan(v); }) /
        made.channel_count);
    if (unknown > 0)
      lose("unknown directions became 0 ({:.3g} % of the entries)",
           100 * static_cast<double>(unknown) / static_cast<double>(entries));
  }

  Converted sampled(const std::string& where, std::string bytes) {
    return sampled(where, std::move(bytes), brdf_);
  }

  /// Returns the converted bytes, and notes how far they are from `brdf`.
  Converted sampled(const std::string& where, std::string bytes, BrdfRef brdf) {
    if (source_.samples()) lose("scattered samples interpolated");
    // The bytes are read back, as another program would read them.
    const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
    const Source back = parse_source({"converted", {data, data + bytes.size()}},
                                     {.keep_spectral = !source_.findings.lambda_nm.empty()});
    const auto difference = relative_difference(brdf, back.ref(), kComparedPairs);
    lose("sampled at {}{}", where,
         difference ? fmt::format(", {:.3g} % from the source on average", 100 * *difference) : "");
    if (difference && *difference > kFarFromSource)
      warnings_.push_back(
          fmt::format("The values are {:.3g} % from the source on average.", 100 * *difference));
    resampled_ = true;
    return kept(std::move(bytes));
  }

  std::string cells(const char* kind) const {
    return fmt::format("{0} x {0} x {1} {2} cells", options_.cells, 2 * options_.cells, kind);
  }

  /// Returns the name that the source has in its file, or its file's name without folders.
  std::string sample_name() const { return burnish::sample_name(source_); }

  Converted kept(std::string bytes) {
    return {.bytes = std::move(bytes),
            .losses = std::move(losses_),
            .notes = std::move(notes_),
            .warnings = std::move(warnings_),
            .resampled = resampled_};
  }

  /// Returns the part of the source; in a format without sides it is a front one.
  BsdfPart part() const { return source_.findings.block.value_or(BsdfBlock{}).part; }

  /// Samples the source at half/difference cells. Both orders of directions have one value unless cells cover
  /// the circle.
  HalfDiffTable half_diff_cells() {
    const BrdfRef brdf = isotropic();
    const int n = options_.cells;
    // 360 azimuths would be the full circle.
    if (2 * n == 360) return tabulate_half_diff(brdf, n, n, 2 * n, true);
    lose_asymmetry(brdf);
    if (!brdf_.isotropic()) return tabulate_half_diff(AzimuthMean(brdf_, true), n, n, 2 * n, false);
    return tabulate_half_diff(SymmetrizedBrdf(brdf), n, n, 2 * n, false);
  }

 public:
  Converted merl() {
    require_grey_or_rgb("MERL");
    const auto* table = std::get_if<HalfDiffTable>(&source_.brdf);
    if (table && fits_merl(*table)) return kept(format_merl(*table));
    return sampled(cells("half/difference"), format_merl(half_diff_cells()));
  }

  Converted slices() {
    require_grey_or_rgb("an image of slices");
    if (const auto* table = std::get_if<HalfDiffTable>(&source_.brdf))
      return kept(format_slice_image(*table));
    const HalfDiffTable table = half_diff_cells();
    lose("sampled at {}", cells("half/difference"));
    resampled_ = true;
    return kept(format_slice_image(table));
  }

  Converted rgl() {
    if (const auto* table = std::get_if<RglTable>(&source_.brdf)) return kept(format_rgl(*table));
    RglOptions options;
    options.lambda_nm = source_.findings.lambda_nm;
    options.description = sample_name();
    return sampled(fmt::format("{} x {} x {} x {} nodes", brdf_.isotropic() ? 1 : options.phi_i_count,
                               options.theta_i_count, options.resolution, options.resolution),
                   format_rgl(make_rgl_table(brdf_, options)));
  }

  Converted mbsdf() {
    require_grey_or_rgb("MBSDF");
    const auto* table = std::get_if<AngleTable>(&source_.brdf);
    if (table && fits_mbsdf(*table)) return kept(format_mbsdf(*table, part()));
    const BrdfRef brdf = isotropic();
    lose_sides(brdf);
    const auto n = static_cast<std::size_t>(options_.cells);
    const AngleTable made = tabulate_angles(brdf, mbsdf_layout(n, 2 * n));
    lose_unknown(made);
    return sampled(cells("angle"), format_mbsdf(made, part()));
  }

  Converted zemax() {
    require_grey_or_rgb("Zemax");
    const std::string sample = sample_name();
    const auto* table = std::get_if<AngleTable>(&source_.brdf);
    if (table && fits_zemax(*table)) {
      // No other format has a table of this frame.
      const bool told_apart = std::ranges::any_of(source_.findings.warnings, [](const std::string& warning) {
        return warning.find("TIS says") != std::string::npos;
      });
      note("{}", told_apart ? "TIS changed: it states the integral of the values"
                            : "TIS was computed anew from the values");
      return kept(format_zemax(*table, sample, source_.findings.comments, part()));
    }
    const BrdfRef brdf = brdf_;
    if (brdf.isotropic()) lose_sides(brdf);
    const AngleTable made = tabulate_angles(brdf, zemax_layout(brdf.isotropic()));
    return sampled(
        fmt::format("{} x {} x {} x {} angles around the mirror direction", made.axes[0].nodes.size(),
                    made.axes[1].nodes.size(), made.axes[2].nodes.size(), made.axes[3].nodes.size()),
        format_zemax(made, sample, {}, part()));
  }

  Converted utia() {
    require_grey_or_rgb("UTIA");
    const auto* table = std::get_if<AngleTable>(&source_.brdf);
    if (table && fits_utia(*table)) return kept(format_utia(*table));
    AngleTable layout = utia_layout();
    layout.channel_count = brdf_.channels();
    AngleTable made = tabulate_angles(brdf_, std::move(layout));
    lose_unknown(made);
    if (made.channel_count == 1) made = in_three_channels(made);
    return sampled("6 x 48 x 6 x 48 angles, constant beyond 75 degrees", format_utia(made));
  }

  Converted openmaterial() {
    require_grey_or_rgb_or_spectra();
    // The samples are the source's without their orientation, the entries of its table, or draws.
    std::optional<Samples> made;
    const Samples* samples = source_.samples();
    if (samples && !samples->isotropic) {
      made = *samples;
      made->isotropic = true;
      lose("the orientation of {} samples: only the azimuth between wi and wo is kept", made->size());
    } else if (!samples && options_.entries && brdf_.isotropic()) {
      made = table_entries(source_);
      lose("the table's grid: {} entries became scattered samples", made->size());
    } else if (!samples) {
      made = measure(isotropic(), {options_.count, 0, options_.seed});
      lose("the values between {} samples drawn at random directions", made->size());
    }
    if (made) samples = &*made;
    std::vector<double> lambda_nm = source_.findings.lambda_nm;
    if (lambda_nm.empty() && samples->channels == 1) {
      lambda_nm = {kGrey_nm};
      note("grey values are stored at {} nm", kGrey_nm);
    } else if (lambda_nm.empty()) {
      lambda_nm.assign(kColourNodes_nm.begin(), kColourNodes_nm.end());
      Samples spectra{
          .channels = kColourNodes_nm.size(), .isotropic = true, .pairs = samples->pairs, .values = {}};
      spectra.values.reserve(samples->size() * spectra.channels);
      for (std::size_t i = 0; i < samples->size(); ++i)
        std::ranges::copy(spectrum_of_colour(samples->at(i).first<3>()), std::back_inserter(spectra.values));
      made = std::move(spectra);
      samples = &*made;
      note("colours became spectra at {:g} nm, the same under equal energy",
           fmt::join(kColourNodes_nm, ", "));
    }
    if (const auto below = std::ranges::count_if(samples->values, [](double v) { return v < 0; }); below > 0)
      lose("{} values below zero became zero", below);
    OpenMaterialText made_text =
        format_openmaterial(*samples, lambda_nm, sample_name(), source_.findings.origin);
    if (made_text.averaged > 0)
      lose("{} samples averaged with others of the same angles", made_text.averaged);
    return kept(std::move(made_text.text));
  }

  Converted model() { return kept(format_model(to_model(source_))); }

  Converted compact() {
    const Model model = to_model(source_);
    if (options_.notes) return kept(format_compact(model, CompactContent::model_and_notes));
    if (model.notes != Model{}.notes) lose("the notes of the fit");
    return kept(format_compact(model));
  }

  Converted scattered(bool astm) {
    // The samples are the source's, the entries of its table, or draws.
    std::optional<Samples> made;
    const Samples* samples = source_.samples();
    if (!samples && options_.entries) {
      made = table_entries(source_);
      lose("the table's grid: {} entries became scattered samples", made->size());
    } else if (!samples) {
      made = measure(brdf_, {options_.count, 0, options_.seed});
      lose("the values between {} samples drawn at random directions", made->size());
    }
    if (made) samples = &*made;
    if (const auto above = above_horizon(*samples); above.size() < samples->size()) {
      lose("{} samples on the horizon", samples->size() - above.size());
      made = select(*samples, above);
      samples = &*made;
    }
    if (astm && !samples->isotropic && same_incident_azimuth(*samples))
      lose("the anisotropy: all samples have one phi_i, so readers take them as isotropic");
    const auto& lambda = source_.findings.lambda_nm;
    return kept(astm ? samples_astm(*samples, lambda) : samples_csv(*samples, lambda));
  }

 private:
  const Source& source_;
  const ConvertOptions& options_;
  const BrdfRef brdf_;  // values below zero stay
  const AzimuthMean mean_;
  std::vector<std::string> losses_, notes_, warnings_;
  bool resampled_ = false;
};

/// Collects the values that are known above the horizon.
class EntryList {
 public:
  explicit EntryList(BrdfRef brdf) : brdf_(brdf), f_(brdf.channels()) {
    samples_.channels = brdf.channels();
    samples_.isotropic = brdf.isotropic();
  }
  void add(const DirectionPair& pair) {
    if (pair.wi.z <= 0 || pair.wo.z <= 0 || !brdf_.eval(pair.wi, pair.wo, f_)) return;
    samples_.pairs.push_back(pair);
    samples_.values.insert(samples_.values.end(), f_.begin(), f_.end());
  }
  Samples take() { return std::move(samples_); }

 private:
  BrdfRef brdf_;
  std::vector<double> f_;
  Samples samples_;
};

// Adds every known entry of a table.
void add_entries(const HalfDiffTable& table, EntryList& list) {
  for (int h = 0; h < table.theta_h_count; ++h)
    for (int d = 0; d < table.theta_d_count; ++d)
      for (int p = 0; p < table.phi_d_count; ++p)
        if (!std::isnan(table.values[table.offset(h, d, p)])) {
          const auto [wi, wo] = from_half_diff(table.centre(h, d, p));
          list.add({wi, wo});
        }
}

void add_entries(const RglTable& table, EntryList& list) {
  const RglData& data = table.data();
  const auto size = [](const auto& v) { return static_cast<int>(v.size()); };
  for (int phi = 0; phi < size(data.phi_i); ++phi)
    for (int theta = 0; theta < size(data.theta_i); ++theta)
      for (int row = 0; row < data.spectra.height; ++row)
        for (int column = 0; column < data.spectra.width; ++column)
          list.add(table.node_directions(phi, theta, row, column));
}

void add_entries(const AngleTable& table, EntryList& list) {
  for (std::size_t i = 0; i < entry_count(table); ++i)
    if (!std::isnan(table.values[i * table.channel_count]))
      list.add(node_directions(table, node_of_entry(table, i)));
}

void add_entries(const TensorTree& table, EntryList& list) {
  for (const TreeLeaf& leaf : leaves(table)) list.add(leaf_directions(table, leaf));
}

void add_entries(const PatchTable& table, EntryList& list) {
  for (std::size_t out = 0; out < table.outgoing.size(); ++out)
    for (std::size_t in = 0; in < table.incident.size(); ++in)
      list.add({table.incident.centre(in), table.outgoing.centre(out)});
}

}  // namespace

bool has_entries(const Source& source) noexcept {
  return std::visit(
      [](const auto& brdf) {
        return requires(EntryList & list) {
          add_entries(brdf, list);
        };
      },
      source.brdf);
}

Samples table_entries(const Source& source) {
  EntryList list(source.ref().unclamped());
  std::visit(
      [&](const auto& brdf) {
        if constexpr (requires { add_entries(brdf, list); })
          add_entries(brdf, list);
        else
          throw Error::in_file(source.name, "a table for its entries", "none");
      },
      source.brdf);
  return list.take();
}

namespace {

/// Returns what the source's file holds and files of this format have no place for.
Losses left_behind(const Source& source, const Findings& found, const Format& format) {
  Losses losses;
  if (!found.left_out.empty()) losses.push_back(fmt::format("{}", fmt::join(found.left_out, ", ")));
  if (found.transmits() && !format.keeps_transmission)
    losses.push_back("transmission: the format has reflection alone, so wo is mirrored through the surface");
  if (found.block && is_back(found.block->part) && !format.keeps_block)
    losses.push_back("the side: the values are those of the back");
  if (found.block && !found.block->band.empty() && !same_name(found.block->band, "Visible") &&
      found.block->band != kColourBand && !format.keeps_block)
    losses.push_back(fmt::format("the band {}", found.block->band));
  if (!found.illuminant.empty())
    losses.push_back(fmt::format("spectra became linear Rec. 709 ({})", found.illuminant));
  if (!format.keeps_origin && found.origin != Origin{}) losses.push_back("licence, authors and origin");
  if (!format.keeps_comments && !found.comments.empty())
    losses.push_back(named_comments(found.comments));
  else if (!format.keeps_name && has_own_remark(source) && !found.description.empty())
    losses.push_back(fmt::format("the remark '{}'", printable(found.description, 120)));
  return losses;
}

const Format& checked_format(std::string_view name, const ConvertOptions& options) {
  if (options.cells < 2 || options.cells > 1000)
    throw Error(fmt::format("expected 2 to 1000 cells, found {}", options.cells));
  const Format* const format = format_to(name);
  if (!format) throw Error("convert: " + expected_one_of(convert_formats(), name));
  return *format;
}

Converted written(const Source& source, std::string_view name, const ConvertOptions& options) {
  const Format& format = checked_format(name, options);
  return format.write(source, options, left_behind(source, source.findings, format));
}

/// Returns true if a reader's phrase for something left out means this block.
bool means_block(std::string_view words, const BsdfBlock& block) {
  const std::string_view direction = window_direction(block.part);
  return words == to_string(block) || words == to_string(block.part) || same_name(words, direction) ||
         same_name(words, fmt::format("{} ({})", direction, block.band)) ||
         words == (is_transmission(block.part) ? "transmission" : "reflection");
}

/// Returns what files of this format have no place for, of all parts together. A block that one part left out is not
/// lost if another part is that block.
Losses left_behind(std::span<const Source> parts, const Format& format) {
  Losses all;
  for (const Source& part : parts) {
    Findings found = part.findings;
    std::erase_if(found.left_out, [&](const std::string& words) {
      return std::ranges::any_of(parts, [&](const Source& other) {
        return other.findings.block && means_block(words, *other.findings.block);
      });
    });
    for (std::string& loss : left_behind(part, found, format))
      if (std::ranges::find(all, loss) == all.end()) all.push_back(std::move(loss));
  }
  return all;
}

}  // namespace

std::vector<std::string_view> convert_formats() {
  std::vector<std::string_view> names;
  for (const Format& format : formats())
    if (format.write) names.push_back(format.to);
  return names;
}

Converted convert(const Source& source, std::string_view format, const ConvertOptions& options) {
  try {
    return written(source, format, options);
  } catch (const Error& error) {
    if (std::string_view(error.what()).starts_with(source.name)) throw;
    throw Error(fmt::format("{}: {}", source.name, error.what()));
  }
}

Converted convert_parts(std::span<const Source> parts, std::string_view format_name,
                        const ConvertOptions& options) {
  const Format& format = checked_format(format_name, options);
  if (parts.size() == 1) return convert(parts.front(), format_name, options);
  if (parts.empty() || !format.write_parts)
    throw Error(fmt::format("convert: expected one part for {}, found {}", format.to, parts.size()));
  return format.write_parts(parts, options, left_behind(parts, format));
}

Converted write_merl(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).merl();
}

Converted write_utia(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).utia();
}

Converted write_rgl(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).rgl();
}

Converted write_mbsdf(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).mbsdf();
}

Converted write_zemax(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).zemax();
}

Converted write_openmaterial(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).openmaterial();
}

Converted write_astm(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).scattered(true);
}

Converted write_csv(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).scattered(false);
}

Converted write_slices(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).slices();
}

Converted write_model(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).model();
}

Converted write_compact(const Source& source, const ConvertOptions& options, Losses losses) {
  return Converter(source, options, std::move(losses)).compact();
}

}  // namespace burnish
