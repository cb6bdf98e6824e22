// SPDX-License-Identifier: Apache-2.0
#pragma once

// A checkpoint of a surface's fit for tests.

#include <string>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/testing/models.h>

namespace burnish {

inline constexpr int kCheckpointWidth = 3, kCheckpointRows = 2;

/// Returns a checkpoint whose numbers are all different, with codes of two lobes, with or without normals.
inline FitCheckpoint some_checkpoint(bool normals) {
  FitCheckpoint checkpoint{
      .key = 0xfedcba9876543210,
      .damaged = {{"a.exr", "cut short"}, {"b/ü.png", ""}, {"no UTF-8\xff", std::string(4095, 'a') + "\xc3"}},
      .missing_pixels = 7,
      .clipped_pixels = 1'000'000'000'000,
      .exposure = 1.0 / 3,
      .lobes = random_model("p(wo) p(wi) + q(h)", {"p=5", "q=4x4"}, 3, TableFormat::half),
      .scales = {0.3f, 17},
      .rows = kCheckpointRows,
      .codes = {},
      .normals = {},
      .texels_without_data = 5,
      .errors = {{1, 2, 3, 4}, {0, std::uint64_t{1} << 62, 5, 6}}};
  constexpr int kTexels = kCheckpointWidth * kCheckpointRows;
  for (const int first : {0, 100}) {
    checkpoint.codes.emplace_back();
    for (int i = 0; i < kTexels; ++i) checkpoint.codes.back().push_back(static_cast<std::byte>(first + i));
  }
  for (int i = 0; normals && i < 2 * kTexels; ++i)
    checkpoint.normals.push_back(0.1f * static_cast<float>(i) - 0.5f);
  return checkpoint;
}

}  // namespace burnish
