// SPDX-License-Identifier: Apache-2.0
// Fits materials one after the other into a folder with a page and a table of figures, with burnish::library:
// fit_library FOLDER MATERIAL... Each material is anything that open_source accepts.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <burnish/library/batch.h>

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: fit_library FOLDER MATERIAL...\n");
    return 2;
  }
  try {
    burnish::BatchOptions options{.folder = arguments[1]};
    options.fit = [](bool) {
      burnish::FitOptions fit;
      fit.form = burnish::OneLobe{};
      fit.samples = 20'000;
      return fit;
    };
    const std::vector<std::string> materials(arguments + 2, arguments + count);
    burnish::Batch batch(burnish::named_entries(materials), options);
    while (batch.next()) {
    }
    const burnish::BatchSummary summary = batch.summary();
    std::printf("%zu of %zu materials are fitted\n", summary.fitted, summary.total);
    return summary.failed == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
