// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <benchmark/benchmark.h>

#include <burnish/file.h>
#include <burnish/io/merl.h>

namespace burnish {
namespace {

struct Constant {
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3, Vec3, std::span<double> f) const noexcept {
    f[0] = 0.25;
    return true;
  }
};

/// Times a 35 MB file in the cache of the file system; the plain baseline only reads its bytes.
void merl(benchmark::State& state, bool convert) {
  const auto path = std::filesystem::temp_directory_path() / "burnish_merl_bench.binary";
  write_merl(path, Constant{});
  for (auto _ : state) {
    const FileBytes file = read_file(path);
    if (convert) {
      const MerlFile parsed = parse_merl(file);
      if (parsed.table.values.front() != 0.25f) state.SkipWithError("the table is wrong");
    }
    benchmark::DoNotOptimize(file.bytes.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::filesystem::remove(path);
}

BENCHMARK_CAPTURE(merl, read, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(merl, read_and_convert, true)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace burnish
