// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace burnish::cli {

/// Shows on standard error what is being done, as long as it lives. Its line is redrawn in place, for the first time
/// after two seconds. It shows the time that passed and, once a share of the work is known, the time that is left. It
/// prints nothing where standard error is no terminal. The destructor removes the line, so print results after that.
class Progress {
 public:
  /// `label` names the work until a stage has a name: "fitting".
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Returns a function to call with the share of the work that is done, from 0 to 1. This object must outlive it.
  /// Returns nullptr without a terminal.
  std::function<void(double fraction)> bar();
  /// Returns a function that also takes the stage's name. The time of a new stage counts from its first call.
  std::function<void(std::string_view stage, double fraction)> stages();

 private:
  class Line;
  std::unique_ptr<Line> line_;  // null without a terminal
};

}  // namespace burnish::cli
