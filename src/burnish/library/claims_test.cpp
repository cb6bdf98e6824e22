// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/library/claims.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using namespace std::chrono_literals;

TEST(Claims, AreHeldByOneAtATime) {
  const TemporaryFolder folder("claims");
  Claims one(folder.path, "one", 60s), two(folder.path, "two", 60s);
  EXPECT_TRUE(one.take("gold"));
  EXPECT_FALSE(one.take("gold"));
  EXPECT_FALSE(two.take("gold"));
  EXPECT_TRUE(two.take("silver"));
  one.release("gold");
  EXPECT_TRUE(two.take("gold"));
}

TEST(Claims, AreGivenBackAtTheEnd) {
  const TemporaryFolder folder("claims_end");
  { EXPECT_TRUE(Claims(folder.path, "one", 60s).take("gold")); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "claims"));
}

TEST(Claims, OfWhoLivesAreNotTakenOver) {
  const TemporaryFolder folder("claims_live");
  Claims one(folder.path, "one", 200ms), two(folder.path, "two", 200ms);
  ASSERT_TRUE(one.take("gold"));
  for (int k = 0; k < 8; ++k) {
    EXPECT_FALSE(two.take("gold"));
    std::this_thread::sleep_for(80ms);
  }
}

// The claim is of a machine that fell over: another machine's process, whose file never changes.
TEST(Claims, OfWhoIsSilentAreTakenOverByOne) {
  const TemporaryFolder folder("claims_silent");
  Claims one(folder.path, "one", 100ms), two(folder.path, "two", 100ms);
  write(folder.path / "claims/gold.1", "another machine\n1\n1\n");
  EXPECT_FALSE(one.take("gold"));
  EXPECT_FALSE(two.take("gold"));
  std::this_thread::sleep_for(150ms);
  EXPECT_TRUE(one.take("gold"));
  EXPECT_FALSE(two.take("gold"));
  one.release("gold");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "claims"));
}

TEST(Claims, OfAProcessOfThisMachineThatEndedAreTakenOverAtOnce) {
  const TemporaryFolder folder("claims_ended");
  const ::pid_t child = ::fork();
  if (child == 0) {
    auto* never_destroyed = new Claims(folder.path, "child", 60s);
    ::_exit(never_destroyed->take("gold") ? 0 : 1);
  }
  int status = 1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path / "claims/gold.1"));
  EXPECT_TRUE(Claims(folder.path, "one", 60s).take("gold"));
}

// Each round begins with the claim of a process that has ended. One taker takes it over and gives it back.
TEST(Claims, AreHeldByOneWhileATakenOverOneIsGivenBack) {
  const TemporaryFolder folder("claims_handed_on");
  const pid_t child = ::fork();
  if (child == 0) {
    auto* never_destroyed = new Claims(folder.path, "gone", 60s);
    ::_exit(never_destroyed->take("gold") ? 0 : 1);
  }
  int status = 1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  const std::string first = (folder.path / "claims/gold.1").string(), abandoned = read(first);

  constexpr int kRounds = 100, kOthers = 3;
  Claims one(folder.path, "one", 60s), two(folder.path, "two", 60s), three(folder.path, "three", 60s);
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) write(first, abandoned);
    std::atomic<int> holders{0}, most{0}, taken{0};
    std::vector<std::thread> threads;
    for (Claims* claims : {&one, &two, &three})
      threads.emplace_back([&, claims] {
        while (taken < kOthers) {
          if (!claims->take("gold")) continue;
          const int now = ++holders;
          for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
          }
          std::this_thread::sleep_for(1ms);
          --holders;
          claims->release("gold");
          ++taken;
        }
      });
    for (std::thread& thread : threads) thread.join();
    ASSERT_EQ(most, 1) << "in round " << round;
  }
}

TEST(Claims, SayWhereTheyCannotBeWritten) {
  const TemporaryFolder folder("claims_gone");
  Claims claims(folder.path, "one", 60s);
  std::filesystem::remove_all(folder.path / "claims");
  EXPECT_NE(error_of([&] { claims.take("gold"); }).find("claims/gold.1"), std::string::npos);
}

}  // namespace
}  // namespace burnish
