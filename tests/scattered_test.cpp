// Real scattered samples keep the budget that they are given.

#include <gtest/gtest.h>

#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/testing/files.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

TEST(Scattered, EveryFileKeepsItsBudgets) {
  BURNISH_SKIP_WHERE_SANITIZED();
  BURNISH_NEEDS_DATA();
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "cornell")) {
    if (entry.path().extension() != ".brdf") continue;
    ++files;
    for (const bool spectral : {false, true}) {
      const Source source = open_source(entry.path().string(), {.keep_spectral = spectral});
      for (const std::uint64_t bytes : {592, 2700, 16 << 10})
        EXPECT_LE(
            fit(source, {.form = Budget{.bytes = bytes, .scattered = {.reweightings = 0}}, .smooth = 1e-5})
                .bytes(),
            bytes)
            << entry.path();
    }
    const Source source = open_source(entry.path().string(), {});
    const Fit made = fit(source, {.form = Budget{.bytes = 2700}});
    EXPECT_LE(made.bytes(), 2700u);
    EXPECT_LT(std::get<OneLobeReport>(made.report.how).relative_cross_validated.value(), 0.135)
        << entry.path();
  }
  EXPECT_GT(files, 0u);
}

}  // namespace
}  // namespace burnish
