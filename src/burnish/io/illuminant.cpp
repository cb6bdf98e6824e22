// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/illuminant.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/closest_name.h>

namespace burnish {

Illuminant parse_illuminant(const FileBytes& file) {
  Illuminant light{.name = file.name, .lambda_nm = {}, .power = {}};
  TextReader reader(file);
  while (reader.next_content_line()) {
    const double lambda = reader.number("a wavelength"), power = reader.number("a power");
    reader.end_of_line();
    if (!(lambda > 0) || (!light.lambda_nm.empty() && lambda <= light.lambda_nm.back()))
      reader.fail("increasing wavelengths in nm", fmt::format("{}", lambda));
    if (!(power >= 0 && power < 1e30)) reader.fail("a power of at least 0", fmt::format("{}", power));
    light.lambda_nm.push_back(lambda);
    light.power.push_back(power);
  }
  if (light.power.size() < 2)
    throw Error::in_file(file.name, "two rows of wavelength and power",
                         fmt::format("{}", light.power.size()));
  return light;
}

Illuminant open_illuminant(const std::string& spec) {
  constexpr std::array<std::string_view, 4> kStandard{"E", "D50", "D65", "A"};
  if (std::find(kStandard.begin(), kStandard.end(), spec) != kStandard.end())
    return standard_illuminant(spec);
  if (std::error_code none; !std::filesystem::exists(spec, none))
    throw Error(fmt::format(
        "expected E, D50, D65, A or a file of wavelengths and powers, found '{}', which is neither{}", spec,
        did_you_mean(spec, kStandard)));
  return parse_illuminant(read_file(spec, 1 << 24));
}

std::vector<std::array<double, 3>> rec709_weights_of(const std::string& file,
                                                     std::span<const double> lambda_nm,
                                                     const std::string& spec) {
  const Illuminant light = open_illuminant(spec);
  try {
    return rec709_weights(lambda_nm, light);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
}

std::string illuminant_name(const std::string& spec) {
  return spec == "E" ? "equal energy" : spec;
}

}  // namespace burnish
