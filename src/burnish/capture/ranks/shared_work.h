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

/// The bytes that make(0) to make(count - 1) return, in this order and at every rank of the crew; rank r makes those
/// whose number is r modulo their count. All of them in this process where there is no crew.
std::vector<std::string> made_together(FitCrew* crew, std::size_t count,
                                       const std::function<std::string(std::size_t)>& make);

/// TexelSolver::solve, its texels shared by the crew; the same bits for any number of ranks.
TexelFits solve_together(FitCrew* crew, const TexelSolver& solver, const TexelSamples& samples,
                         std::vector<float> normals, const TexelSolver::Options& options);

/// Appends values as they lie in memory: ranks are of one kind of processor.
template <class T>
void append_values(std::string& bytes, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

/// Takes values off the front. Precondition: that many are there.
template <class T>
void take_values(std::string_view& bytes, std::span<T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  bytes.remove_prefix(values.size_bytes());
}

}  // namespace burnish
