#include "progress.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include <fmt/format.h>
#include <unistd.h>

namespace burnish::cli {

std::function<void(double)> progress_bar(std::string label) {
  if (::isatty(STDERR_FILENO) == 0) return nullptr;
  return [label = std::move(label), shown = -1](double fraction) mutable {
    constexpr int kWidth = 40;
    const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
    if (percent == shown) return;
    shown = percent;
    const int filled = kWidth * percent / 100;
    fmt::print(stderr, "\r{} [{:=<{}}{: <{}}] {:3d} %", label, "", filled, "", kWidth - filled, percent);
    if (percent == 100) fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  };
}

std::function<void(std::string_view, double)> progress_bars() {
  if (!progress_bar("")) return nullptr;
  return [bars = std::map<std::string, std::function<void(double)>, std::less<>>()](std::string_view stage,
                                                                                    double fraction) mutable {
    auto bar = bars.find(stage);
    if (bar == bars.end()) bar = bars.emplace(stage, progress_bar(std::string(stage))).first;
    bar->second(fraction);
  };
}

}  // namespace burnish::cli
