// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace burnish {

/// Who works on what, for processes that share a folder and no server: files of FOLDER/claims. NAME.K is the claim of
/// the K-th process that wanted NAME, made by a call that fails where the file exists; the highest K holds NAME. A holder
/// that lives changes its files' times every quarter of `patience`. One that does not is taken over by making K + 1,
/// which of several only one can: at once where its process is seen to be gone from this machine, else after watching
/// it for `patience` without a change. Only times of this process's clock are compared, so clocks of machines may differ.
/// A process that was asleep for so long may go on beside its successor: both write the same bits. Safe to call from
/// several threads.
class Claims {
 public:
  /// `owner` is unlike that of any other process. Throws Error as make_folder does.
  Claims(const std::filesystem::path& folder, std::string owner, std::chrono::duration<double> patience);
  /// Gives back what is held.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Claims `name` for this process. Returns true if this process holds it now and did not before. Throws Error where
  /// the folder cannot be written.
  bool take(const std::string& name);
  /// Gives `name` back: call it when what others have to know of it can be read.
  void release(const std::string& name) noexcept;

 private:
  struct Seen {
    std::filesystem::file_time_type time;
    std::chrono::steady_clock::time_point since;
  };
  std::filesystem::path file(const std::string& name, int generation) const;
  bool make(const std::filesystem::path& path) const;
  bool abandoned(const std::filesystem::path& path);
  void beat();

  std::filesystem::path folder_;
  std::string owner_;
  std::chrono::duration<double> patience_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::map<std::string, int> held_;   // name -> generation
  std::map<std::string, Seen> seen_;  // claims of others, by path
  std::thread heart_;
};

/// This process among all of a cluster: host, process number and a random number.
std::string process_identity();

}  // namespace burnish
