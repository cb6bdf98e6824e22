// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/capture/ranks/fit_crew.h>

namespace burnish::cli {

/// The ranks of MPI's world [MPI]. Make one crew at a time, while MPI is initialized. Messages may have any size.
class MpiCrew : public FitCrew {
 public:
  MpiCrew();

  int ranks() const noexcept override { return ranks_; }
  int rank() const noexcept override { return rank_; }
  std::vector<std::string> gather(const std::string& bytes) override;
  std::string broadcast(const std::string& bytes) override;

 private:
  int ranks_ = 1, rank_ = 0;
};

}  // namespace burnish::cli
