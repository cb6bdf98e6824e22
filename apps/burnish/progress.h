#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace burnish::cli {

/// Says on the standard error output, while it lives, what is being done: a line that is redrawn in place from the
/// second second on, with the time that passed and, once a share of the work is known, the time that is left. Silent
/// where standard error is no terminal. Its line is gone once it is, so results are printed after that.
class Progress {
 public:
  /// `label`: what is done until a stage has a name, "fitting".
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// To be told the share of the work that is done, from 0 to 1; this must outlive it. Nothing without a terminal.
  std::function<void(double fraction)> bar();
  /// The same of a stage; a new stage counts from its first call.
  std::function<void(std::string_view stage, double fraction)> stages();

 private:
  class Line;
  std::unique_ptr<Line> line_;  // nothing without a terminal
};

}  // namespace burnish::cli
