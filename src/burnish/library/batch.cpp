// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <fstream>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/library/batch.h>
#include <burnish/library/catalogue.h>
#include <burnish/library/claims.h>
#include <burnish/library/figures_table.h>
#include <burnish/library/fitted_material.h>
#include <burnish/library/folder_file.h>
#include <burnish/library/journal.h>
#include <burnish/library/memory_budget.h>
#include <burnish/library/sha256.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

namespace {

constexpr std::chrono::milliseconds kPoll{500}, kTold{100};
constexpr std::string_view kAssembly = "~assembly";  // no material has such a name
constexpr std::string_view kStaging = "staging";
constexpr std::uint64_t kInputCopies = 2;  // of an input's bytes: the file's, and the numbers in it

/// Ends a fit that nobody waits for.
struct Stopped {};

int processors() {
  cpu_set_t set;
  return ::sched_getaffinity(0, sizeof(set), &set) == 0
             ? std::max(CPU_COUNT(&set), 1)
             : static_cast<int>(std::thread::hardware_concurrency());
}

// Resident memory, bytes: the second number of the line, in pages.
std::uint64_t memory_taken() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  in >> all >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string digest_of(const std::vector<MaterialRecord>& records, const std::string& studio) {
  Sha256 hash;
  hash.add(studio);
  for (const MaterialRecord& record : records)
    hash.add(fmt::format("\n{}\n{}\n{}\n{}", record.name, record.argument, record.key, record.reason));
  return hash.hex();
}

std::string digest_of_file(const fs::path& path) {
  try {
    return sha256(read_file(path).text());
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

class Batch::State {
 public:
  State(std::vector<LibraryEntry> entries, BatchOptions options);
  ~State();

  std::optional<MaterialRecord> next(const std::function<void()>& waiting);
  BatchSummary summary() const;

 private:
  class MemoryShare;
  void work();
  std::optional<std::size_t> take();
  void process(std::size_t index);
  std::optional<MaterialRecord> settled(const LibraryEntry& entry, const std::string& key);
  MaterialRecord fitted(const LibraryEntry& entry, const std::string& key);
  void stage(FittedMaterial& made);
  void place(const RecordedFile& file);
  void give(std::size_t index, MaterialRecord record);
  void share_threads();
  void assemble();
  void check_stopped() const {
    if (stopping_) throw Stopped{};
  }

  const std::vector<LibraryEntry> entries_;
  const BatchOptions options_;
  const int threads_;
  MemoryBudget memory_;
  const std::string identity_ = process_identity();
  const Clock::time_point start_ = Clock::now();
  Journal journal_;
  Claims claims_;
  InputDigests digests_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> stopping_{false};
  std::deque<std::size_t> pending_, later_;  // places in entries_; later: held by other processes
  std::deque<MaterialRecord> results_;
  std::vector<MaterialRecord> records_;  // of all entries, in their order
  std::exception_ptr error_;
  std::size_t working_ = 0;  // threads
  bool assembled_ = false;
  int fitting_ = 0;  // threads that are within a fit
  std::unique_ptr<ThreadLimit> limit_;
  BatchSummary summary_;
  double fitted_seconds_ = 0;  // when the last result of this run came, since the start
  std::vector<std::thread> workers_;
};

/// The share of the memory that a material takes, and of the threads while it is fitted. The most that it may need is
/// reserved before it is opened, since only then is it known whether it is isotropic.
class Batch::State::MemoryShare {
 public:
  MemoryShare(State& state, std::uint64_t input)
      : state_(state),
        fit_(std::max(most_of_a_fit(state.options_, false), most_of_a_fit(state.options_, true))),
        bytes_(input + fit_) {
    if (!state_.memory_.reserve(bytes_)) throw Stopped{};
  }
  ~MemoryShare() {
    ::malloc_trim(0);  // what was freed goes back to the system, since the next fit may need it elsewhere
    state_.memory_.release(bytes_);
    if (!fits_) return;
    const std::lock_guard lock(state_.mutex_);
    --state_.fitting_;
    state_.share_threads();
  }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  void begin_fit(std::uint64_t bytes) {
    const std::uint64_t unused = fit_ - std::min(bytes, fit_);
    state_.memory_.give_back(unused);
    bytes_ -= unused;
    fits_ = true;
    const std::lock_guard lock(state_.mutex_);
    ++state_.fitting_;
    state_.share_threads();
  }

 private:
  static std::uint64_t most_of_a_fit(const BatchOptions& options, bool isotropic) {
    return fit_memory(options.fit ? options.fit(isotropic) : FitOptions{}, isotropic);
  }

  State& state_;
  std::uint64_t fit_, bytes_;
  bool fits_ = false;
};

Batch::State::State(std::vector<LibraryEntry> entries, BatchOptions options)
    : entries_(std::move(entries)),
      options_(std::move(options)),
      threads_(options_.threads > 0 ? options_.threads : processors()),
      memory_(options_.memory > 0 ? options_.memory : usable_memory() / 5 * 4, memory_taken()),
      journal_((make_folder(options_.folder), options_.folder), identity_),
      claims_(options_.folder, identity_, options_.patience),
      digests_(options_),
      records_(entries_.size()) {
  if (!options_.resume && !journal_.empty())
    throw Error::in_file(options_.folder.string(), "a folder without a batch, or to resume it",
                         "the journal of one");
  for (const std::string_view below : {std::string_view("models"), std::string_view("pictures"), kStaging})
    make_folder(options_.folder / below);
  for (std::size_t k = 0; k < entries_.size(); ++k) pending_.push_back(k);
  summary_.total = entries_.size();

  const auto count = std::min(static_cast<std::size_t>(threads_), entries_.size());
  share_threads();
  working_ = count;
  for (std::size_t k = 0; k < count; ++k) workers_.emplace_back([this] { work(); });
}

Batch::State::~State() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  memory_.stop();
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void Batch::State::work() {
  try {
    while (const auto index = take()) process(*index);
  } catch (const Stopped&) {
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
    stopping_ = true;
    memory_.stop();
  }
  const std::lock_guard lock(mutex_);
  --working_;
  changed_.notify_all();
}

// The next place, those that others hold after all else. Waits while others hold all that is left.
std::optional<std::size_t> Batch::State::take() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (!pending_.empty()) {
      const std::size_t index = pending_.front();
      pending_.pop_front();
      return index;
    }
    if (later_.empty()) return std::nullopt;
    changed_.wait_for(lock, kPoll);
    journal_.refresh();
    pending_.swap(later_);
  }
  return std::nullopt;
}

void Batch::State::process(std::size_t index) {
  const LibraryEntry& entry = entries_[index];
  std::string key;
  try {
    key = digests_.key(entry);
  } catch (const Error& error) {
    MaterialRecord record{.name = entry.name, .argument = entry.argument, .reason = error.what()};
    journal_.append(record);
    return give(index, std::move(record));
  }
  if (auto record = settled(entry, key)) return give(index, std::move(*record));

  // whoever holds it may have done it since the journal was read
  const bool held = claims_.take(entry.name);
  if (held) journal_.refresh();
  if (auto record = settled(entry, key)) {
    claims_.release(entry.name);
    return give(index, std::move(*record));
  }
  if (!held) {
    const std::lock_guard lock(mutex_);
    later_.push_back(index);
    return;
  }
  give(index, fitted(entry, key));
  claims_.release(entry.name);
}

// The journal's record, where it says that the material failed or its files are whole; those that were not renamed yet
// are now.
std::optional<MaterialRecord> Batch::State::settled(const LibraryEntry& entry, const std::string& key) {
  std::optional<MaterialRecord> record = journal_.record(entry.name, key);
  if (!record) return std::nullopt;
  for (const RecordedFile& file : record->files) {
    if (digest_of_file(options_.folder / file.path) == file.sha256) continue;
    if (digest_of_file(options_.folder / file.staged) != file.sha256) return std::nullopt;
    place(file);
  }
  record->argument = entry.argument;
  record->earlier = true;
  return record;
}

MaterialRecord Batch::State::fitted(const LibraryEntry& entry, const std::string& key) {
  const auto start = Clock::now();
  journal_.append_began(entry.name, key);
  const auto failed = [&](std::string why, const std::string& under) {
    return FittedMaterial{{.name = entry.name,
                           .argument = entry.argument,
                           .key = under,
                           .reason = std::move(why),
                           .seconds = std::chrono::duration<double>(Clock::now() - start).count()},
                          {}};
  };
  FittedMaterial made;
  {
    MemoryShare share(*this, kInputCopies * input_size(entry));
    try {
      made = fit_material(entry, key, options_,
                          {.stop = [this] { check_stopped(); },
                           .reserve = [&share](std::uint64_t bytes) { share.begin_fit(bytes); }});
    } catch (const std::bad_alloc&) {
      made = failed("expected enough memory, found too little", {});  // another time there may be more
    } catch (const std::exception& error) {
      made = failed(error.what(), key);
    }
  }
  stage(made);
  return std::move(made.record);
}

// Writes the files under other names, says so in the journal, and renames them: killed before that, the fit is done
// again; after it, it is not.
void Batch::State::stage(FittedMaterial& made) {
  MaterialRecord& record = made.record;
  for (std::size_t k = 0; k < record.files.size(); ++k) {
    record.files[k].staged = fmt::format("{}/{}.{}.{}", kStaging, record.name, k, identity_);
    write_durably(options_.folder / record.files[k].staged, made.bytes[k]);
  }
  journal_.append(record);
  for (const RecordedFile& file : record.files) place(file);
}

// Gives a file its name. Another process that read the journal may do so in the same moment.
void Batch::State::place(const RecordedFile& file) {
  const fs::path path = options_.folder / file.path, staged = options_.folder / file.staged;
  fs::path below = options_.folder;
  for (const fs::path& part : fs::path(file.path).parent_path()) {
    std::error_code ignored;  // where the batch's folder is gone, which is not made again
    fs::create_directory(below /= part, ignored);
  }
  try {
    rename_durably(staged, path);
  } catch (const Error&) {
    if (digest_of_file(path) != file.sha256) throw;
  }
}

void Batch::State::give(std::size_t index, MaterialRecord record) {
  const std::lock_guard lock(mutex_);
  if (!record.earlier) fitted_seconds_ = std::chrono::duration<double>(Clock::now() - start_).count();
  records_[index] = record;
  results_.push_back(std::move(record));
  changed_.notify_all();
}

// Each fit has a thread of its own; those that are left help within fits.
void Batch::State::share_threads() {
  auto limit = std::make_unique<ThreadLimit>(std::max(threads_ - std::max(fitting_, 1) + 1, 1));
  limit_ = std::move(limit);
}

std::optional<MaterialRecord> Batch::State::next(const std::function<void()>& waiting) {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kTold, [&] { return !results_.empty() || error_ || working_ == 0; })) {
    lock.unlock();
    if (waiting) waiting();
    lock.lock();
  }
  if (!results_.empty()) {
    MaterialRecord record = std::move(results_.front());
    results_.pop_front();
    ++(record.fitted() ? summary_.fitted : summary_.failed);
    if (record.earlier) ++summary_.earlier;
    return record;
  }
  if (error_) std::rethrow_exception(error_);
  lock.unlock();
  if (!std::exchange(assembled_, true)) assemble();
  return std::nullopt;
}

BatchSummary Batch::State::summary() const {
  const std::lock_guard lock(mutex_);
  BatchSummary summary = summary_;
  summary.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::size_t done = summary.fitted + summary.failed, own = done - summary.earlier;
  if (own > 0)
    summary.seconds_left =
        fitted_seconds_ / static_cast<double>(own) * static_cast<double>(summary.total - done);
  return summary;
}

// Table and page, by one process of those that work on the folder.
void Batch::State::assemble() {
  const std::string digest = digest_of(records_, options_.studio);
  const auto whole = [&] {
    const auto files = journal_.assembled(digest);
    return files && std::ranges::all_of(*files, [&](const AssembledFile& file) {
             return digest_of_file(options_.folder / file.path) == file.sha256;
           });
  };
  const std::string claim(kAssembly);
  while (!whole()) {
    if (claims_.take(claim)) {
      journal_.refresh();
      if (!whole()) {
        write_figures_table(options_.folder, records_);
        std::vector<std::string> paths = write_catalogue(options_.folder, records_, options_.studio);
        paths.emplace_back(kFiguresTable);
        std::vector<AssembledFile> files;
        for (const std::string& path : paths) files.push_back({path, digest_of_file(options_.folder / path)});
        journal_.append_assembled(digest, files);
      }
      claims_.release(claim);
      return;
    }
    std::this_thread::sleep_for(kPoll);
    journal_.refresh();
  }
}

Batch::Batch(std::vector<LibraryEntry> entries, BatchOptions options)
    : state_(std::make_unique<State>(std::move(entries), std::move(options))) {}

Batch::~Batch() = default;

std::optional<MaterialRecord> Batch::next(const std::function<void()>& waiting) {
  return state_->next(waiting);
}

BatchSummary Batch::summary() const {
  return state_->summary();
}

}  // namespace burnish
