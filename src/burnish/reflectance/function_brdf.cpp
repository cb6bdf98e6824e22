// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/function_brdf.h>

namespace burnish {

struct FunctionBrdf::State {
  Function function;
  std::atomic<std::size_t> failures = 0;
  std::atomic<bool> waiting = false;  // what was thrown has not been asked for
  std::mutex mutex;                   // of what was thrown
  std::exception_ptr thrown = {};
};

FunctionBrdf::FunctionBrdf(std::size_t channels, bool isotropic, Function function)
    : channels_(channels), isotropic_(isotropic), state_(std::make_shared<State>()) {
  constexpr std::size_t kMost = SymmetrizedBrdf::kMaxChannels;
  if (!function) throw Error("function: expected a function, found none");
  if (channels < 1 || channels > kMost)
    throw Error(fmt::format("function: expected 1 to {} channels, found {}", kMost, channels));
  state_->function = std::move(function);
}

bool FunctionBrdf::fill(std::span<const DirectionPair> pairs, std::span<double> values) const noexcept {
  if (state_->waiting) {  // whatever asks will fail: its end need not be slow
    ++state_->failures;
    return false;
  }
  std::exception_ptr thrown;
  try {
    run_isolated([&] { state_->function(pairs, values); });
    return true;
  } catch (...) {
    thrown = std::current_exception();
  }
  {
    const std::scoped_lock lock(state_->mutex);
    std::swap(state_->thrown, thrown);
    state_->waiting = true;
    ++state_->failures;
  }
  return false;  // an earlier one dies outside of the lock
}

bool FunctionBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const DirectionPair pair{wi, wo};
  std::uint8_t known = 0;
  eval({&pair, 1}, f, {&known, 1});
  return known != 0;
}

void FunctionBrdf::eval(std::span<const DirectionPair> pairs, std::span<double> values,
                        std::span<std::uint8_t> known) const noexcept {
  const auto above = [](const DirectionPair& pair) { return pair.wi.z > 0 && pair.wo.z > 0; };
  std::ranges::fill(known, std::uint8_t{1});
  if (std::ranges::all_of(pairs, above)) {
    if (pairs.empty() || fill(pairs, values)) return;
    std::ranges::fill(values, 0.0);
    std::ranges::fill(known, std::uint8_t{0});
    return;
  }
  // those above the horizon side by side
  std::vector<DirectionPair> asked;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(asked), above);
  std::vector<double> found(asked.size() * channels_);
  const bool told = asked.empty() || fill(asked, found);
  std::ranges::fill(values, 0.0);
  for (std::size_t i = 0, k = 0; i < pairs.size(); ++i) {
    if (!above(pairs[i])) continue;
    known[i] = told;
    if (told)
      std::ranges::copy(std::span(found).subspan(k * channels_, channels_),
                        values.begin() + static_cast<std::ptrdiff_t>(i * channels_));
    ++k;
  }
}

std::size_t FunctionBrdf::failures() const noexcept {
  return state_->failures;
}

void FunctionBrdf::rethrow_since(std::size_t count) const {
  if (failures() == count) return;
  std::exception_ptr thrown;
  {
    const std::scoped_lock lock(state_->mutex);
    std::swap(state_->thrown, thrown);
    state_->waiting = false;
  }
  if (thrown) std::rethrow_exception(std::move(thrown));
  throw Error("function: it failed, as another caller was told");
}

}  // namespace burnish
