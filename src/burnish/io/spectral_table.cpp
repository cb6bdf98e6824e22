// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/illuminant.h>
#include <burnish/io/spectral_table.h>
#include <burnish/math/angles.h>

namespace burnish {

void check_wavelengths(const std::string& file, const std::vector<double>& lambda_nm) {
  if (!lambda_nm.empty() &&
      (lambda_nm.front() <= 0 || lambda_nm.back() >= 1e6 ||
       std::adjacent_find(lambda_nm.begin(), lambda_nm.end(), std::greater_equal<>{}) != lambda_nm.end()))
    throw Error::in_file(file, "positive, increasing wavelengths",
                         fmt::format("{} ... {} nm out of order", lambda_nm.front(), lambda_nm.back()));
}

AngleTable shown_spectrum(const std::string& file, AngleTable table, const std::vector<double>& lambda_nm,
                          const OpenOptions& options, Findings& findings) {
  if (lambda_nm.size() < 2 || options.keep_spectral) {
    findings.lambda_nm = lambda_nm;
    return table;
  }
  const auto weights = rec709_weights_of(file, lambda_nm, options.illuminant);
  std::vector<float> rgb(entry_count(table) * 3);
  for (std::size_t entry = 0; entry < rgb.size() / 3; ++entry)
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < weights.size(); ++k)
        sum += weights[k][c] * static_cast<double>(table.values[entry * weights.size() + k]);
      rgb[3 * entry + c] = static_cast<float>(sum);
    }
  table.values = std::move(rgb);
  table.channel_count = 3;
  findings.illuminant = illuminant_name(options.illuminant);
  return table;
}

void note_table(const AngleTable& table, Findings& findings) {
  findings.sample_count = entry_count(table);
  for (std::size_t entry = 0; entry < entry_count(table); ++entry)
    findings.hole_count += std::isnan(table.values[entry * table.channel_count]);
  for (const float value : table.values)
    if (value < 0) {
      ++findings.negative_count;
      findings.most_negative = std::min(findings.most_negative, static_cast<double>(value));
    }
  const std::vector<double>& incidences = table.axes[1].nodes;
  // A single angle stands for all.
  const bool every_incidence = incidences.size() == 1;
  findings.theta_i_min = every_incidence ? 0 : incidences.front();
  findings.theta_i_max = every_incidence ? kHalfPi : std::min(incidences.back(), kHalfPi);
  findings.theta_o_max = kHalfPi;
  if (table.frame == AngleTable::Frame::normal && table.axes[2].nodes.size() > 1) {
    findings.theta_o_min = table.axes[2].nodes.front();
    findings.theta_o_max = std::min(table.axes[2].nodes.back(), kHalfPi);
  }
}

}  // namespace burnish
