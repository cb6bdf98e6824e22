// SPDX-License-Identifier: Apache-2.0
// This file stands in for math/parallel.cpp. Chunks run on this thread and on those of burnish_start_threads. Without
// shared memory there are none of those. Results are the same for every number of threads.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <emscripten/emscripten.h>

#include <burnish/math/parallel.h>

namespace burnish {

namespace {

using Body = std::function<void(std::size_t, std::size_t, std::size_t)>;

// The chunks of one loop, taken by any idle thread. The loop lives on the stack of its caller, which waits for its
// helpers.
class Loop {
 public:
  Loop(std::size_t count, std::size_t chunk_size, const Body& body)
      : count_(count), chunk_size_(chunk_size), body_(body) {}

  int helpers = 0;  // other threads within run(); guarded by the pool's mutex

  bool has_more() const { return next_ < chunk_count(count_, chunk_size_); }

  void run() {
    const std::size_t chunks = chunk_count(count_, chunk_size_);
    for (std::size_t chunk; (chunk = next_++) < chunks;) {
      try {
        body_(chunk, chunk * chunk_size_, std::min(count_, (chunk + 1) * chunk_size_));
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
        next_ = chunks;  // running chunks end, no other begins
      }
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::size_t count_, chunk_size_;
  const Body& body_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::exception_ptr error_;
};

// Threads that help with loops, the latest loop first, since it is nested in earlier ones. They end with the worker.
class Pool {
 public:
  void start(int threads) {
    for (int i = 0; i < threads; ++i) std::thread([this] { help(); }).detach();
    size_ = threads;
  }
  bool empty() const { return size_ == 0; }

  void run(Loop& loop) {
    {
      const std::lock_guard lock(mutex_);
      loops_.push_back(&loop);
    }
    begun_.notify_all();
    loop.run();
    std::unique_lock lock(mutex_);
    std::erase(loops_, &loop);
    left_.wait(lock, [&] { return loop.helpers == 0; });
  }

 private:
  void help() {
    std::unique_lock lock(mutex_);
    while (true) {
      const auto loop = std::find_if(loops_.rbegin(), loops_.rend(), [](Loop* l) { return l->has_more(); });
      if (loop == loops_.rend()) {
        begun_.wait(lock);
        continue;
      }
      Loop& mine = **loop;
      ++mine.helpers;
      lock.unlock();
      mine.run();
      lock.lock();
      if (--mine.helpers == 0) left_.notify_all();
    }
  }

  int size_ = 0;
  std::mutex mutex_;
  std::condition_variable begun_, left_;
  std::vector<Loop*> loops_;
};

Pool& pool() {
  static Pool* const threads = new Pool;  // lives as long as its threads
  return *threads;
}

}  // namespace

void for_each_chunk(std::size_t count, std::size_t chunk_size, const Body& body) {
  Loop loop(count, chunk_size, body);
  if (pool().empty() || chunk_count(count, chunk_size) < 2)
    loop.run();
  else
    pool().run(loop);
  loop.rethrow();
}

// A thread that waits for its own loop takes chunks of no other loop.
void run_isolated(const std::function<void()>& body) {
  body();
}

ThreadLimit::ThreadLimit(int) {}

ThreadLimit::~ThreadLimit() {}

}  // namespace burnish

/// Starts threads beside the caller's. Call it once, when their workers exist.
extern "C" EMSCRIPTEN_KEEPALIVE void burnish_start_threads(int threads) {
  burnish::pool().start(threads);
}
