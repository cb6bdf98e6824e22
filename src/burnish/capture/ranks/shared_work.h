// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/capture/texels/texel_solver.h>

namespace burnish {

/// Returns the bytes of make(0) to make(count - 1), in this order, at every rank of the crew. Rank r makes those
/// whose number is r modulo the number of ranks. Without a crew this process makes all of them.
std::vector<std::string> made_together(FitCrew* crew, std::size_t count,
                                       const std::function<std::string(std::size_t)>& make);

/// Runs TexelSolver::solve with its texels shared by the crew. The bits are the same for any number of ranks.
TexelFits solve_together(FitCrew* crew, const TexelSolver& solver, const TexelSamples& samples,
                         std::vector<float> normals, const TexelSolver::Options& options);

/// Appends values as they lie in memory, since all ranks run on one kind of processor.
template <class T>
void append_values(std::string& bytes, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

/// Takes values off the front. Precondition: `bytes` holds enough of them.
template <class T>
void take_values(std::string_view& bytes, std::span<T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  bytes.remove_prefix(values.size_bytes());
}

}  // namespace burnish
