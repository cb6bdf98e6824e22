// SPDX-License-Identifier: Apache-2.0
#pragma once

// Crews for tests: ranks that are threads.

#include <barrier>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include <burnish/capture/ranks/fit_crew.h>

namespace burnish {

class ThreadCrew {
 public:
  explicit ThreadCrew(int ranks) : barrier_(ranks), sent_(static_cast<std::size_t>(ranks)) {}

  class Member : public FitCrew {
   public:
    Member(ThreadCrew& crew, int rank) : crew_(crew), rank_(rank) {}
    int ranks() const noexcept override { return static_cast<int>(crew_.sent_.size()); }
    int rank() const noexcept override { return rank_; }
    std::vector<std::string> gather(const std::string& bytes) override {
      crew_.sent_[static_cast<std::size_t>(rank_)] = bytes;
      crew_.barrier_.arrive_and_wait();
      std::vector<std::string> all;
      if (rank_ == 0) all = crew_.sent_;
      crew_.barrier_.arrive_and_wait();
      return all;
    }
    std::string broadcast(const std::string& bytes) override {
      if (rank_ == 0) crew_.sent_[0] = bytes;
      crew_.barrier_.arrive_and_wait();
      std::string first = crew_.sent_[0];
      crew_.barrier_.arrive_and_wait();
      return first;
    }

   private:
    ThreadCrew& crew_;
    int rank_;
  };

 private:
  std::barrier<> barrier_;
  std::vector<std::string> sent_;
};

/// Returns the results of work(rank's crew) at each rank; all ranks run at once.
template <class Work>
auto at_every_rank(int ranks, Work work) {
  ThreadCrew crew(ranks);
  std::vector<decltype(work(static_cast<FitCrew*>(nullptr)))> all(static_cast<std::size_t>(ranks));
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < ranks; ++rank)
    threads.emplace_back([&, rank] {
      ThreadCrew::Member member(crew, rank);
      all[static_cast<std::size_t>(rank)] = work(static_cast<FitCrew*>(&member));
    });
  threads.clear();
  return all;
}

}  // namespace burnish
