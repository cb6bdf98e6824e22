// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>

namespace burnish {

/// Bytes that threads share: each reserves all that it may need before it takes any, so none waits while it holds
/// something that others wait for. Safe to call from several threads.
class MemoryBudget {
 public:
  /// `bytes` in all, of which so many are `taken` for good.
  MemoryBudget(std::uint64_t bytes, std::uint64_t taken) : bytes_(bytes), reserved_(taken) {}

  /// Waits until so many bytes are left, or until nobody holds any: what is larger than all goes alone. False where
  /// stop was called, and then nothing is reserved.
  bool reserve(std::uint64_t bytes);
  /// Gives back this part of the reserved bytes; the rest stays reserved.
  void give_back(std::uint64_t bytes);
  /// Ends a reservation of which so many bytes are left.
  void release(std::uint64_t bytes);
  /// Ends all waiting, now and later.
  void stop();

  /// Bytes that are taken or reserved.
  std::uint64_t reserved() const;

 private:
  const std::uint64_t bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t reserved_;
  int holders_ = 0;
  bool stopped_ = false;
};

/// Bytes that this process may still take: what the system has free, at most the limits of its control groups (version
/// 1 and 2) and of its Slurm job (SLURM_MEM_PER_NODE, or SLURM_MEM_PER_CPU for each processor of the job here). `root`
/// is where proc/ and sys/ lie. 0 where nothing is known.
std::uint64_t usable_memory(const std::filesystem::path& root = "/");

}  // namespace burnish
