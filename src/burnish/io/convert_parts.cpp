// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/convert_compare.h>
#include <burnish/io/convert_writers.h>
#include <burnish/io/klems.h>
#include <burnish/io/speos.h>
#include <burnish/io/tensor_tree_xml.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/patch_means.h>

namespace burnish {

namespace {

constexpr double kTreeTolerance = 1e-3;  // relative; cubes whose values agree within it become one

/// Returns the part and band that the source came from. A source without a part becomes Radiance's front,
/// reflection-back. Without a band it is Visible, and so is the luminance of the band CIE-XYZ.
BsdfBlock window_block(const Source& source) {
  BsdfBlock block = source.findings.block.value_or(BsdfBlock{BsdfPart::reflection_back, {}});
  if (block.band.empty() || block.band == kColourBand) block.band = "Visible";
  return block;
}

/// Converts parts of one surface into one file, and collects losses and warnings.
class PartsConverter {
 public:
  PartsConverter(std::span<const Source> parts, const ConvertOptions& options, Losses losses)
      : parts_(parts), options_(options) {
    made_.losses = std::move(losses);
  }

  Converted klems() {
    std::vector<PatchTable> tables;
    tables.reserve(parts_.size());
    std::vector<PatchBlock> blocks;
    for (const Source& part : parts_) {
      require_grey_or_rgb(part, "Klems XML");
      const auto* patches = std::get_if<PatchTable>(&part.brdf);
      if (patches && patches->channels() == 1) {
        tables.push_back(*patches);
      } else {
        const Luminance grey = grey_of(part);
        const PatchBasis outgoing = options_.cells < 45 ? klems_quarter_basis() : klems_full_basis();
        PatchBasis incident = outgoing;
        incident.first_azimuth = kPi;
        tables.push_back(patch_means(grey, std::move(incident), outgoing));
        sampled(part, fmt::format("{0} x {0} patches, by their means", outgoing.size()), grey, tables.back());
      }
      blocks.push_back({&tables.back(), own_block(part)});
    }
    return kept(format_klems(blocks, sample_name(parts_.front())));
  }

  Converted tensor_trees() {
    std::vector<TensorTree> trees;
    trees.reserve(parts_.size());
    std::vector<TreeBlock> blocks;
    for (const Source& part : parts_) {
      require_grey_or_rgb(part, "a tensor tree");
      if (const auto* tree = std::get_if<TensorTree>(&part.brdf)) {
        trees.push_back(*tree);
      } else {
        const Luminance grey = grey_of(part);
        // An axis has half the cells of a polar angle, rounded down to a power of two from 2 to 32.
        int depth = 1;
        while (depth < 5 && 4 << depth <= options_.cells) ++depth;
        trees.push_back(tabulate_tree(grey, depth, kTreeTolerance));
        sampled(part, fmt::format("{0} x {0} x {0} x {0} cells of Shirley-Chiu squares", 1 << depth), grey,
                trees.back());
      }
      blocks.push_back({&trees.back(), own_block(part)});
    }
    return kept(format_tensor_trees(blocks, sample_name(parts_.front())));
  }

  Converted speos() {
    const Source *reflection = nullptr, *transmission = nullptr;
    for (const Source& part : parts_) {
      const BsdfBlock block = part.findings.block.value_or(BsdfBlock{});
      const Source*& place = is_transmission(block.part) ? transmission : reflection;
      if (!place)
        place = &part;
      else if (is_back(place->findings.block.value_or(BsdfBlock{}).part) && !is_back(block.part))
        lose(*std::exchange(place, &part));
      else
        lose(part);
    }
    std::vector<AngleTable> tables;
    tables.reserve(2);
    SpeosParts written;
    for (const Source* part : {reflection, transmission}) {
      if (!part) continue;
      require_grey_or_rgb(*part, "Speos");
      const auto* angles = std::get_if<AngleTable>(&part->brdf);
      if (angles && fits_speos(*angles)) {
        tables.push_back(*angles);
      } else {
        const Luminance grey = grey_of(*part);
        tables.push_back(tabulate_angles(grey, speos_layout(grey.isotropic())));
        const auto& axes = tables.back().axes;
        sampled(*part,
                fmt::format("{} x {} x {} x {} angles", axes[0].nodes.size(), axes[1].nodes.size(),
                            axes[2].nodes.size(), axes[3].nodes.size()),
                grey, tables.back());
      }
      (part == reflection ? written.reflection : written.transmission) = &tables.back();
    }
    return kept(format_speos(written, sample_name(parts_.front())));
  }

 private:
  /// Returns the part's name as the prefix of its messages if there are several parts.
  std::string prefix(const Source& part) const {
    return parts_.size() > 1 ? to_string(part.findings.block.value_or(BsdfBlock{})) + ": " : "";
  }

  void lose(const Source& part) {
    made_.losses.push_back(to_string(part.findings.block.value_or(BsdfBlock{})));
  }

  void require_grey_or_rgb(const Source& part, const char* format) const {
    if (const std::size_t channels = part.ref().channels(); channels != 1 && channels != 3)
      throw Error::in_file(part.name, fmt::format("grey or RGB for {}, so no --spectral", format),
                           fmt::format("{} channels", channels));
  }

  Luminance grey_of(const Source& part) {
    const BrdfRef brdf = part.ref().unclamped();
    if (has_colour(brdf)) made_.losses.push_back(prefix(part) + "colour: its luminance is kept");
    return {brdf};
  }

  /// Returns the block that a part becomes. Throws Error if another part has become it.
  BsdfBlock own_block(const Source& part) {
    BsdfBlock block = window_block(part);
    const auto same = [&](const BsdfBlock& other) {
      return other.part == block.part && same_name(other.band, block.band);
    };
    if (std::ranges::any_of(taken_, same))
      throw Error::in_file(part.name, "each part and band once", "two of " + to_string(block));
    taken_.push_back(block);
    return block;
  }

  /// Notes that a part was sampled anew, and how far the result is from the source.
  void sampled(const Source& part, const std::string& where, BrdfRef source, BrdfRef made) {
    if (part.samples()) made_.losses.push_back(prefix(part) + "scattered samples interpolated");
    const auto difference = relative_difference(source, made, kComparedPairs);
    made_.losses.push_back(fmt::format(
        "{}sampled at {}{}", prefix(part), where,
        difference ? fmt::format(", {:.3g} % from the source on average", 100 * *difference) : ""));
    if (difference && *difference > kFarFromSource)
      made_.warnings.push_back(fmt::format("{}The values are {:.3g} % from the source on average.",
                                           prefix(part), 100 * *difference));
    made_.resampled = true;
  }

  Converted kept(std::string bytes) {
    made_.bytes = std::move(bytes);
    return std::move(made_);
  }

  std::span<const Source> parts_;
  const ConvertOptions& options_;
  std::vector<BsdfBlock> taken_;
  Converted made_;
};

}  // namespace

Converted write_klems(const Source& source, const ConvertOptions& options, Losses losses) {
  return PartsConverter({&source, 1}, options, std::move(losses)).klems();
}

Converted write_klems_parts(std::span<const Source> parts, const ConvertOptions& options, Losses losses) {
  return PartsConverter(parts, options, std::move(losses)).klems();
}

Converted write_tensor_tree(const Source& source, const ConvertOptions& options, Losses losses) {
  return PartsConverter({&source, 1}, options, std::move(losses)).tensor_trees();
}

Converted write_tensor_tree_parts(std::span<const Source> parts, const ConvertOptions& options,
                                  Losses losses) {
  return PartsConverter(parts, options, std::move(losses)).tensor_trees();
}

Converted write_speos(const Source& source, const ConvertOptions& options, Losses losses) {
  return PartsConverter({&source, 1}, options, std::move(losses)).speos();
}

Converted write_speos_parts(std::span<const Source> parts, const ConvertOptions& options, Losses losses) {
  return PartsConverter(parts, options, std::move(losses)).speos();
}

}  // namespace burnish
