// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <random>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/library/claims.h>
#include <burnish/library/folder_file.h>

namespace burnish {

namespace fs = std::filesystem;

namespace {

// Returns the space in which process numbers mean the same: this start of this machine, and this container.
std::string process_space() {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  std::error_code error;
  return boot + ' ' + fs::read_symlink("/proc/self/ns/pid", error).string();
}

// When a process was started, in ticks since the machine was: tells it from a later one with its number. Empty where
// there is no such process.
std::string start_of(const std::string& process) {
  std::string stat;
  std::getline(std::ifstream("/proc/" + process + "/stat"), stat);
  const std::size_t end_of_name = stat.rfind(')');
  if (end_of_name == std::string::npos) return {};
  std::istringstream fields(stat.substr(end_of_name + 1));
  std::string field;
  for (int k = 3; k <= 22; ++k) {
    fields >> field;
    if (k == 3 && (field == "Z" || field == "X")) return {};  // ended, and nobody has asked how
  }
  return field;
}

// A claim's first lines: where process numbers mean the same, the number, when it started.
bool is_gone(const fs::path& claim) {
  std::ifstream in(claim);
  std::string space, process, start;
  if (!std::getline(in, space) || !std::getline(in, process) || !std::getline(in, start)) return false;
  return space == process_space() && start_of(process) != start;
}

}  // namespace

std::string process_identity() {
  char host[256] = "host";
  ::gethostname(host, sizeof(host) - 1);
  std::string name;
  for (const char* c = host; *c != '\0'; ++c) name += std::isalnum(static_cast<unsigned char>(*c)) ? *c : '-';
  std::random_device random;
  return fmt::format("{}.{}.{:08x}", name, ::getpid(), random());
}

Claims::Claims(const fs::path& folder, std::string owner, std::chrono::duration<double> patience)
    : folder_(folder / "claims"), owner_(std::move(owner)), patience_(patience) {
  make_folder(folder_);
  heart_ = std::thread([this] { beat(); });
}

Claims::~Claims() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  heart_.join();
  while (!held_.empty()) release(held_.begin()->first);
}

fs::path Claims::file(const std::string& name, int generation) const {
  return folder_ / fmt::format("{}.{}", name, generation);
}

// Makes the file and returns true if it was made. It is written through the opened descriptor, since the folder may
// be moved in this moment: a claim without its lines belongs to a process that may live. A process that is killed
// before it writes them is not known to be gone, only silent.
bool Claims::make(const fs::path& path) const {
  const std::string process = std::to_string(::getpid());
  return write_new_durably(
      path, fmt::format("{}\n{}\n{}\n{}\n", process_space(), process, start_of(process), owner_));
}

bool Claims::take(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (held_.contains(name)) return false;
  int generation = 1;
  if (!make(file(name, generation))) {
    while (fs::exists(file(name, generation + 1))) ++generation;
    const fs::path last = file(name, generation);
    if (!abandoned(last) || !make(file(name, ++generation))) return false;
    // a successor may have given all back since, and another begun anew: whatever `last` is now is asked again
    if (!abandoned(last)) {
      ::unlink(file(name, generation).c_str());
      return false;
    }
  }
  held_[name] = generation;
  return true;
}

bool Claims::abandoned(const fs::path& path) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(path, error);
  if (error) return false;  // given back in this moment
  if (is_gone(path)) return true;
  const auto now = std::chrono::steady_clock::now();
  const auto [at, is_new] = seen_.try_emplace(path.string(), Seen{time, now});
  if (at->second.time != time) at->second = {time, now};
  return now - at->second.since > patience_;
}

void Claims::release(const std::string& name) noexcept {
  const std::lock_guard lock(mutex_);
  const auto found = held_.find(name);
  if (found == held_.end()) return;
  // the highest goes last: without it those below look abandoned, and a successor would stand beside a new first; and
  // who can make it again finds the one below gone or new
  for (int generation = 1; generation <= found->second; ++generation)
    ::unlink(file(name, generation).c_str());
  held_.erase(found);
}

void Claims::beat() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, patience_ / 4, [this] { return stopping_; }))
    for (const auto& [name, generation] : held_)
      ::utimensat(AT_FDCWD, file(name, generation).c_str(), nullptr, 0);
}

}  // namespace burnish
