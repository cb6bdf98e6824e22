// No tests: lets the worker threads end with the tests. The leak check at a program's exit stops all threads
// to look at them and dies, now and then, of one that is on its way out.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace burnish {
namespace {

class Workers : public testing::Environment {
 public:
  void TearDown() override {
    tbb::task_scheduler_handle workers{tbb::attach{}};
    tbb::finalize(workers, std::nothrow);  // waits for them
  }
};

[[maybe_unused]] const testing::Environment* const workers = testing::AddGlobalTestEnvironment(new Workers);

}  // namespace
}  // namespace burnish
