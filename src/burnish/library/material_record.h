// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace burnish {

/// A file that came of a material.
struct RecordedFile {
  std::string path;    ///< below the batch's folder
  std::string staged;  ///< the name it was written under before it got this one
  std::string sha256;  ///< of its bytes

  friend bool operator==(const RecordedFile&, const RecordedFile&) = default;
};

/// The outcome of a material of a batch.
struct MaterialRecord {
  std::string name, argument;
  std::string
      key;  ///< digest of the input's bytes, the options and the version; empty where the input was not read
  std::string reason;               ///< why there is no model; empty where there is one
  std::vector<RecordedFile> files;  ///< the model first, then its picture, then what was exported

  std::string format;                       ///< of the source
  std::string model;                        ///< its expression
  std::uint64_t bytes = 0;                  ///< of the model, as its type counts them
  std::optional<std::size_t> fetches = {};  ///< filtered reads of tables an evaluation; none of baselines
  /// Errors as in ErrorFigures, of the model as stored on pairs that were not fitted; none where not known or not
  /// finite.
  std::optional<double> psnr = {}, ssim = {}, relative = {}, rms_log = {}, log_cos = {};
  /// The largest directional albedo of the model among theta_i 0, 30, 60 and 80 degrees and its channels.
  std::optional<double> albedo = {};
  std::vector<std::string> warnings;  ///< one short sentence each
  double seconds = 0;                 ///< by the wall clock, everything included
  bool earlier = false;               ///< an earlier run or another process made it; not part of the journal

  bool fitted() const noexcept { return reason.empty(); }
  friend bool operator==(const MaterialRecord&, const MaterialRecord&) = default;
};

/// The figures of a record, by name, in the order in which its JSON, the table of figures and the page have them.
struct RecordFigure {
  const char* name;
  std::optional<double> MaterialRecord::*value;
};
inline constexpr std::array<RecordFigure, 6> kRecordFigures = {{{"psnr", &MaterialRecord::psnr},
                                                                {"ssim", &MaterialRecord::ssim},
                                                                {"relative", &MaterialRecord::relative},
                                                                {"rms_log", &MaterialRecord::rms_log},
                                                                {"log_cos", &MaterialRecord::log_cos},
                                                                {"albedo", &MaterialRecord::albedo}}};

/// A JSON object in one line: name, argument, key; reason where it failed; else files (path, staged, sha256), format,
/// model, bytes, fetches, psnr, ssim, relative, rms_log, log_cos, albedo, warnings; and seconds. Unknown figures are
/// left out.
std::string to_json(const MaterialRecord& record);
/// Reads the text that to_json wrote, and ignores `event` of a line of a journal. Throws Error where it is no such
/// object.
MaterialRecord parse_material_record(const std::string& json);

}  // namespace burnish
