// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdlib>
#include <future>

#include <gmock/gmock.h>

#include <burnish/library/memory_budget.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using namespace std::chrono_literals;

bool waits(const std::future<bool>& one) {
  return one.wait_for(30ms) == std::future_status::timeout;
}

TEST(MemoryBudget, IsNotExceededByThoseWhoHoldSome) {
  MemoryBudget budget(500, 20);
  ASSERT_TRUE(budget.reserve(280));
  auto second = std::async(std::launch::async, [&] { return budget.reserve(280); });
  EXPECT_TRUE(waits(second));
  budget.give_back(60);
  EXPECT_TRUE(waits(second));
  EXPECT_EQ(budget.reserved(), 240u);
  budget.give_back(20);  // 220 and 280 are all
  EXPECT_TRUE(second.get());
  EXPECT_EQ(budget.reserved(), 500u);
}

TEST(MemoryBudget, LetsWhatIsLargerThanAllGoAlone) {
  MemoryBudget budget(500, 20);
  ASSERT_TRUE(budget.reserve(700));
  auto second = std::async(std::launch::async, [&] { return budget.reserve(1); });
  EXPECT_TRUE(waits(second));
  budget.release(700);
  EXPECT_TRUE(second.get());
}

TEST(MemoryBudget, WaitsNoMoreOnceItIsStopped) {
  MemoryBudget budget(500, 20);
  ASSERT_TRUE(budget.reserve(400));
  auto second = std::async(std::launch::async, [&] { return budget.reserve(400); });
  budget.stop();
  EXPECT_FALSE(second.get());
  EXPECT_FALSE(budget.reserve(1));
  EXPECT_EQ(budget.reserved(), 420u);
}

// A system with 8 GiB free, by what the files of /proc and /sys say.
class UsableMemory : public testing::Test {
 protected:
  static constexpr std::uint64_t kMiB = 1 << 20;

  UsableMemory() {
    clear();
    put("proc/meminfo", "MemTotal: 16777216 kB\nMemAvailable:    8388608 kB\n");
  }
  ~UsableMemory() override { clear(); }
  static void clear() {
    for (const char* name : {"SLURM_MEM_PER_NODE", "SLURM_MEM_PER_CPU", "SLURM_CPUS_ON_NODE"})
      ::unsetenv(name);
  }
  void put(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((folder.path / path).parent_path());
    write((folder.path / path).string(), text);
  }
  std::uint64_t usable() const { return usable_memory(folder.path) / kMiB; }

  TemporaryFolder folder{"memory"};
};

TEST_F(UsableMemory, IsWhatTheSystemHasFreeWithoutLimits) {
  EXPECT_EQ(usable(), 8192u);
  put("proc/self/cgroup", "0::/user/one\n");
  put("sys/fs/cgroup/user/one/memory.max", "max\n");
  EXPECT_EQ(usable(), 8192u);
}

TEST_F(UsableMemory, IsAtMostTheLimitOfAControlGroupOrOneAboveIt) {
  put("proc/self/cgroup", "0::/user/one\n");
  put("sys/fs/cgroup/user/one/memory.max", "3221225472\n");
  EXPECT_EQ(usable(), 3072u);
  put("sys/fs/cgroup/user/memory.max", "1073741824\n");
  EXPECT_EQ(usable(), 1024u);
}

TEST_F(UsableMemory, IsAtMostTheLimitOfAGroupOfVersion1) {
  put("proc/self/cgroup", "5:cpu,cpuacct:/\n4:memory:/docker/abc\n");
  put("sys/fs/cgroup/memory/memory.limit_in_bytes", "2147483648\n");  // as a container sees it
  EXPECT_EQ(usable(), 2048u);
}

TEST_F(UsableMemory, IsAtMostThatOfASlurmJob) {
  ::setenv("SLURM_MEM_PER_CPU", "700", 1);
  EXPECT_EQ(usable(), 700u);
  ::setenv("SLURM_CPUS_ON_NODE", "3", 1);
  EXPECT_EQ(usable(), 2100u);
  ::setenv("SLURM_MEM_PER_NODE", "1500", 1);
  EXPECT_EQ(usable(), 1500u);
}

}  // namespace
}  // namespace burnish
