// SPDX-License-Identifier: Apache-2.0
#include "source_arguments.h"

#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/illuminant.h>

#include "progress.h"
#include "usage.h"

namespace burnish::cli {

namespace {

// Reports a bad illuminant even where no spectrum needs one.
void check_illuminant(const std::string& spec) {
  try {
    open_illuminant(spec);
  } catch (const Error& error) {
    throw Error(std::string("--illuminant: ") + error.what());
  }
}

}  // namespace

Source SourceArguments::open() const {
  Source source = [&] {
    const Progress progress("reading " + spec);
    return open_source(spec, options);
  }();
  for (const std::string& warning : source.findings.warnings)
    fmt::print(stderr, "burnish: {}: warning: {}\n", spec, warning);
  return source;
}

void add_source_arguments(CLI::App& verb, SourceArguments& arguments) {
  verb.add_option("BRDF", arguments.spec,
                  "Names a measurement, a model, an encoding nbrdf:FILE#NAME or np:FOLDER#NAME, or an "
                  "analytic BRDF such as ggx:alpha_x=0.1,alpha_y=0.1.")
      ->required();
  add_open_options(verb, arguments.options);
}

void add_illuminant(CLI::App& verb, OpenOptions& options) {
  verb.add_option("--illuminant", options.illuminant,
                  "Sets the light under which spectra become RGB: E (equal energy), D50, D65, A, or a file "
                  "of wavelengths in nm and powers.")
      ->each(check_illuminant)
      ->capture_default_str();
}

void add_open_options(CLI::App& verb, OpenOptions& options) {
  verb.add_flag("--spectral", options.keep_spectral, "Keeps one channel for each wavelength.");
  add_illuminant(verb, options);
  auto* cosine =
      verb.add_flag("--has-cosine", options.has_cosine, "Takes values of CSV and ASTM as f_r cos(theta_i).");
  auto* cosine_o = verb.add_flag("--has-cosine-o", options.has_cosine_o,
                                 "Takes values of CSV and ASTM as f_r cos(theta_o).");
  verb.add_flag("--brf", options.brf,
                "Takes values of CSV and ASTM as reflectance factors, and divides by pi.")
      ->excludes(cosine)
      ->excludes(cosine_o);
  cosine_o->excludes(cosine);
  verb.add_flag("!--keep-negatives", options.clamp_negatives, "Leaves values below zero as they are.");
  auto* back = verb.add_flag("--back", options.back_side,
                             "Reads the back side's reflection of Klems files and tensor trees.");
  std::vector<std::string> parts;
  for (const BsdfPart part : kBsdfParts) parts.emplace_back(to_string(part));
  verb.add_option_function<std::string>(
          "--part", [&options](const std::string& name) { options.part = find_bsdf_part(name); },
          "Reads this part of a file that has several; `burnish info` names them.")
      ->check(one_of(parts))
      ->excludes(back);
  verb.add_option("--band", options.band,
                  "Reads this band of a file that has several, such as Visible, Solar, NIR or CIE-XYZ.");
  verb.add_flag("--scale-to-tis", options.scale_to_tis,
                "Scales each incidence of a Zemax or LightTools file to the integral that its TIS states.");
}

}  // namespace burnish::cli
