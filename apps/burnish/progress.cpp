// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "duration_text.h"

namespace burnish::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLeastFraction = 0.02;  // below this share the time left is a guess

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

/// The line, and the thread that draws it.
class Progress::Line {
 public:
  explicit Line(std::string label) : stage_(std::move(label)), thread_([this] { draw_until_done(); }) {}
  ~Line() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_one();
    thread_.join();
    if (drawn_) {
      fmt::print(stderr, "\r\033[K");
      std::fflush(stderr);
    }
  }

  void tell(double fraction) {
    const std::lock_guard lock(mutex_);
    fraction_ = std::clamp(fraction, 0.0, 1.0);
  }
  void tell(std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (stage != stage_) {
      stage_ = stage;
      stage_start_ = Clock::now();
    }
    fraction_ = std::clamp(fraction, 0.0, 1.0);
  }

 private:
  void draw_until_done() {
    constexpr std::chrono::milliseconds kStep(200), kFirst(2000);
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, kFirst, [&] { return done_; })) return;
    do draw();
    while (!changed_.wait_for(lock, kStep, [&] { return done_; }));
  }

  void draw() {
    constexpr int kWidth = 30;
    const int percent = static_cast<int>(100 * fraction_), filled = kWidth * percent / 100;
    std::string text = stage_;
    if (percent > 0)
      text += fmt::format(" [{:=<{}}{: <{}}] {:3d} %", "", filled, "", kWidth - filled, percent);
    text += ", " + duration_text(seconds_since(start_));
    if (fraction_ >= kLeastFraction && fraction_ < 1)
      text +=
          fmt::format(", {} left", duration_text(seconds_since(stage_start_) * (1 - fraction_) / fraction_));
    fmt::print(stderr, "\r{}\033[K", text);
    std::fflush(stderr);
    drawn_ = true;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string stage_;
  double fraction_ = 0;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point stage_start_ = start_;
  bool done_ = false, drawn_ = false;
  std::thread thread_;  // last, since it uses all other members
};

Progress::Progress(std::string label) {
  if (::isatty(STDERR_FILENO) != 0) line_ = std::make_unique<Line>(std::move(label));
}

Progress::~Progress() = default;

std::function<void(double)> Progress::bar() {
  if (!line_) return nullptr;
  return [line = line_.get()](double fraction) { line->tell(fraction); };
}

std::function<void(std::string_view, double)> Progress::stages() {
  if (!line_) return nullptr;
  return [line = line_.get()](std::string_view stage, double fraction) { line->tell(stage, fraction); };
}

}  // namespace burnish::cli
