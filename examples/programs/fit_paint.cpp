// SPDX-License-Identifier: Apache-2.0
// Fits a program's own BRDF with burnish::fit, without reading a file.
#include <cstdio>
#include <exception>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/source.h>

int main() {
  try {
    const burnish::Source paint{.name = "paint",
                                .brdf = burnish::parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2"),
                                .findings = {}};
    // One lobe, a product of two tables, is fitted to few pairs, so the fit takes a moment.
    burnish::FitOptions options;
    options.form = burnish::OneLobe{};
    options.samples = 20'000;
    const burnish::Fit fit = burnish::fit(paint, options);
    burnish::write_then_rename("paint.burnish", burnish::format_compact({.brdf = fit.model()}));
    std::printf("paint.burnish is written: %zu bytes of tables\n", fit.model().table_bytes());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
