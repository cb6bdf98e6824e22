// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace burnish {

/// Runs body(chunk, begin, end) over [0, count) cut into chunks of `chunk_size` (the last may be shorter), on
/// all threads. The cut depends on count and chunk_size alone: a caller that keeps one result a chunk and
/// joins them in order gets the same bits for every number of threads. Exceptions of a body are rethrown
/// here. A body catches nothing by type: in browsers two threads at once could not (apps/wasm/standins/unwind.cpp).
void for_each_chunk(std::size_t count, std::size_t chunk_size,
                    const std::function<void(std::size_t chunk, std::size_t begin, std::size_t end)>& body);

/// Runs body(), whose loops' threads take up no work from outside it while they wait: for what others wait for behind a
/// lock.
void run_isolated(const std::function<void()>& body);

/// Number of chunks for_each_chunk makes.
constexpr std::size_t chunk_count(std::size_t count, std::size_t chunk_size) noexcept {
  return (count + chunk_size - 1) / chunk_size;
}

/// Limits the threads used by the library from now on until the object dies; 0 means all.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_ = nullptr;
};

}  // namespace burnish
