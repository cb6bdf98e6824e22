// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace burnish {

/// The processes, called ranks, that fit one capture together, and the messages between them. All ranks make the same
/// calls in the same order.
class FitCrew {
 public:
  FitCrew() = default;
  FitCrew(const FitCrew&) = delete;
  FitCrew& operator=(const FitCrew&) = delete;
  virtual ~FitCrew() = default;

  virtual int ranks() const noexcept = 0;
  /// In [0, ranks()); rank 0 leads.
  virtual int rank() const noexcept = 0;
  /// Returns every rank's bytes, in the order of ranks, at rank 0; nothing at the other ranks.
  virtual std::vector<std::string> gather(const std::string& bytes) = 0;
  /// Returns at every rank the bytes that rank 0 passed.
  virtual std::string broadcast(const std::string& bytes) = 0;
};

}  // namespace burnish
