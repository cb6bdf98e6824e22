// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <burnish/math/parallel.h>

namespace burnish {

void for_each_chunk(std::size_t count, std::size_t chunk_size,
                    const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  // Isolated: an exception in an outer loop must not end the loops within its other chunks halfway, whose
  // bodies would go on with what was not computed.
  tbb::task_group_context context(tbb::task_group_context::isolated);
  tbb::parallel_for(
      std::size_t{0}, chunk_count(count, chunk_size),
      [&](std::size_t chunk) { body(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size)); },
      context);
}

void run_isolated(const std::function<void()>& body) {
  tbb::this_task_arena::isolate([&] { body(); });
}

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0)
    control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                       static_cast<std::size_t>(threads));
}

ThreadLimit::~ThreadLimit() {
  delete static_cast<tbb::global_control*>(control_);
}

}  // namespace burnish
