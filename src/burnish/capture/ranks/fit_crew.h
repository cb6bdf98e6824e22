#pragma once

#include <string>
#include <vector>

namespace burnish {

/// The processes, called ranks, that fit one capture together, and what they say to each other. All of them make the
/// same calls in the same order.
class FitCrew {
 public:
  FitCrew() = default;
  FitCrew(const FitCrew&) = delete;
  FitCrew& operator=(const FitCrew&) = delete;
  virtual ~FitCrew() = default;

  virtual int ranks() const noexcept = 0;
  /// In [0, ranks()); rank 0 leads.
  virtual int rank() const noexcept = 0;
  /// At rank 0 every rank's bytes, in their order; elsewhere nothing.
  virtual std::vector<std::string> gather(const std::string& bytes) = 0;
  /// At every rank what rank 0 gave.
  virtual std::string broadcast(const std::string& bytes) = 0;
};

}  // namespace burnish
