// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include <burnish/library/memory_budget.h>

namespace burnish {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kNoLimit = ~std::uint64_t{0}, kKiB = 1024, kMiB = 1024 * kKiB;

// The number that a text starts with; none where it says "max", 0 or nothing.
std::uint64_t limit_in(const std::string& text) {
  const std::uint64_t number = std::strtoull(text.c_str(), nullptr, 10);
  return number > 0 ? number : kNoLimit;
}

std::uint64_t limit_of_file(const fs::path& path) {
  std::string line;
  std::getline(std::ifstream(path), line);
  return limit_in(line);
}

// The line "MemAvailable: N kB".
std::uint64_t available(const fs::path& root) {
  constexpr std::string_view kName = "MemAvailable:";
  std::ifstream in(root / "proc/meminfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(kName)) return kKiB * std::strtoull(line.c_str() + kName.size(), nullptr, 10);
  return kNoLimit;
}

// Returns the least limit of a group and of the groups that it is in. In a container the path may begin outside, and
// then only its end is there.
std::uint64_t limit_of_groups(const fs::path& mount, const std::string& group, std::string_view file) {
  std::uint64_t least = kNoLimit;
  for (fs::path below = fs::path(group).relative_path();; below = below.parent_path()) {
    least = std::min(least, limit_of_file(mount / below / file));
    if (below.empty()) return least;
  }
}

// Lines "NUMBER:CONTROLLERS:PATH"; version 2 has the number 0 and no controllers.
std::uint64_t limit_of_control_groups(const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  std::uint64_t least = kNoLimit;
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (line.starts_with("0::"))
      least = std::min(least, limit_of_groups(mount, path, "memory.max"));
    else if (controllers.find(",memory,") != std::string::npos)
      least = std::min(least, limit_of_groups(mount / "memory", path, "memory.limit_in_bytes"));
  }
  return least;
}

// In the environment, MiB; 0 stands for all of a node.
std::uint64_t limit_of_job() {
  const auto number = [](const char* name) {
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : 0;
  };
  if (const std::uint64_t of_node = number("SLURM_MEM_PER_NODE")) return of_node * kMiB;
  const std::uint64_t of_processor = number("SLURM_MEM_PER_CPU");
  const std::uint64_t processors = std::max<std::uint64_t>(number("SLURM_CPUS_ON_NODE"), 1);
  return of_processor > 0 ? of_processor * processors * kMiB : kNoLimit;
}

}  // namespace

bool MemoryBudget::reserve(std::uint64_t bytes) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stopped_ || holders_ == 0 || reserved_ + bytes <= bytes_; });
  if (stopped_) return false;
  reserved_ += bytes;
  ++holders_;
  return true;
}

void MemoryBudget::give_back(std::uint64_t bytes) {
  {
    const std::lock_guard lock(mutex_);
    reserved_ -= bytes;
  }
  changed_.notify_all();
}

void MemoryBudget::release(std::uint64_t bytes) {
  {
    const std::lock_guard lock(mutex_);
    reserved_ -= bytes;
    --holders_;
  }
  changed_.notify_all();
}

void MemoryBudget::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
}

std::uint64_t MemoryBudget::reserved() const {
  const std::lock_guard lock(mutex_);
  return reserved_;
}

std::uint64_t usable_memory(const fs::path& root) {
  const std::uint64_t least = std::min({available(root), limit_of_control_groups(root), limit_of_job()});
  return least == kNoLimit ? 0 : least;
}

}  // namespace burnish
