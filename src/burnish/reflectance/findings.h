// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <burnish/reflectance/bsdf_part.h>

namespace burnish {

/// Who made what a file holds and how it may be used, in the file's words; empty where it says nothing.
struct Origin {
  std::string licence, sources;
  std::vector<std::string> copyrights, authors;

  friend bool operator==(const Origin&, const Origin&) = default;
};

/// A share of light that a file states beside its function: light that is mirrored, or passes straight on.
struct DirectShare {
  double theta_i = 0;  ///< radians
  double share = 0;    ///< of the light received, in [0, 1]; of a colour the luminance
};

/// The facts that a reader found in a source, as `burnish info` prints them.
struct Findings {
  std::string format;       ///< "MERL binary", "Cornell scattered spectra", "analytic", ...
  std::string description;  ///< the source's own name or remarks, one line; may be empty
  std::vector<std::string>
      conventions;                   ///< how the source's conventions were mapped to ours, one sentence each
  std::uint64_t sample_count = 0;    ///< stored values of one channel, holes included
  std::uint64_t hole_count = 0;      ///< of these, how many hold no measurement
  std::uint64_t negative_count = 0;  ///< of all channels' values, how many are below zero
  double most_negative = 0;          ///< the smallest of them, 1/sr
  std::vector<double> lambda_nm;     ///< wavelengths of the channels kept, or empty for grey and RGB
  std::string illuminant;            ///< how spectra became RGB: "equal energy", "D65"; empty if they did not
  Origin origin;                     ///< among the conventions too, shortened
  std::string notes;  ///< what a model says about its making, a JSON object; empty for anything else
  double theta_i_min = 0, theta_i_max = 0;  ///< polar angles covered by data, radians
  double theta_o_min = 0, theta_o_max = 0;
  std::vector<std::string>
      warnings;  ///< what may be wrong with the file or how it was read, one sentence each
  std::vector<std::string> left_out;  ///< what else the file holds: "Transmission Front (Visible)"
  std::vector<BsdfBlock> blocks;  ///< every part and band that the file holds, where its format has several
  /// The part and band that were read, or that a model was fitted to; nothing where a format has reflection alone.
  std::optional<BsdfBlock> block;
  std::vector<DirectShare> direct;    ///< of the block that was read, by rising theta_i; no function has it
  std::vector<std::string> comments;  ///< remarks of a format that keeps them, without their marks

  /// Returns true of transmission, whose wo is mirrored through the surface: see BsdfPart.
  bool transmits() const noexcept { return block && is_transmission(block->part); }
};

}  // namespace burnish
