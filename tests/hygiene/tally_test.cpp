// The counters count: what a tick of a clean scene does in its last hook, once, is found, with who did it.
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <new>
#include <string>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/base/error.h"
#include "sim/bodies/mujoco.h"
#include "tests/hygiene/tick_run.h"

namespace enc::test {
namespace {

Told with(const std::function<void()>& deed) {
  Case asked{.most = 1000};
  asked.options.watch = [deed](const trial::Glance& glance) {
    if (glance.tick.index == kWarmUp + 500) deed();
  };
  return counted_run(asked);
}
void expect_once(const Told& told, Offence kind, const std::string& name, std::int64_t times = 1) {
  EXPECT_EQ(told.error, "");
  EXPECT_EQ(told.tally.all() - told.tally.faults(), times) << words(told.tally);
  EXPECT_EQ(told.tally[kind], times) << words(told.tally);
  EXPECT_EQ(told.tally.dirty, 1);
  ASSERT_GT(told.tally.offenders, 0U);
  EXPECT_EQ(told.tally.first[0].tick, 500);
  EXPECT_EQ(told.tally.first[0].name.data(), name);
  EXPECT_GT(told.tally.first[0].depth, 2U);
}

TEST_F(AnyTick, IsFoundToAllocate) {
  static void* volatile kept = nullptr;
  expect_once(with([] { kept = ::operator new(24); }), Offence::heap, "malloc");
  expect_once(with([] { kept = std::calloc(3, 8); }), Offence::heap, "calloc");
  expect_once(with([] { kept = ::operator new(64, std::align_val_t(64)); }), Offence::heap, "aligned_alloc");
  expect_once(with([] {
                kept = std::malloc(24);
                std::free(kept);
              }),
              Offence::heap, "malloc", 2);
  expect_once(with([] { kept = mju_malloc(64); }), Offence::heap, "aligned_alloc");  // within libmujoco
}

TEST_F(AnyTick, IsFoundToLock) {
  static std::mutex mutex;
  expect_once(with([] { const std::lock_guard lock(mutex); }), Offence::lock, "pthread_mutex_lock");
}

TEST_F(AnyTick, IsFoundToCallTheSystem) {
  const Told told = with([] { (void)::getppid(); });
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
  expect_once(told, Offence::system_call, std::to_string(SYS_getppid));
}

// Memory that it has, and nobody has touched.
TEST_F(AnyTick, IsFoundToFault) {
  static volatile std::byte* fresh = nullptr;
  static constexpr std::size_t kPages = 5, kPage = 4096;
  Case asked{.most = 1000};
  asked.options.watch = [](const trial::Glance& glance) {
    if (glance.tick.index == 1) {
      void* got = ::mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (got == MAP_FAILED) throw Error("no memory");
      (void)::madvise(got, kPages * kPage, MADV_NOHUGEPAGE);
      fresh = static_cast<volatile std::byte*>(got);
    }
    if (glance.tick.index == kWarmUp + 500)
      for (std::size_t i = 0; i < kPages; ++i) fresh[i * kPage] = std::byte{1};
  };
  const Told told = counted_run(asked);
  EXPECT_EQ(told.error, "");
  EXPECT_EQ(told.tally[Offence::minor_fault], std::int64_t{kPages}) << words(told.tally);
  EXPECT_EQ(told.tally.all(), std::int64_t{kPages}) << words(told.tally);
}

// What fails says who did it.
TEST_F(AnyTick, SaysWhoAskedForSomething) {
  static void* volatile kept = nullptr;
  const std::string said = words(with([] { kept = std::realloc(kept, 24); }).tally);
  EXPECT_NE(said.find("1 heap call in 1000 ticks"), std::string::npos) << said;
  EXPECT_NE(said.find("tick 500: heap call realloc"), std::string::npos) << said;
  EXPECT_NE(said.find("tally_test.cpp"), std::string::npos) << said;
}

// Where they are not, ctest lists this test as skipped.
TEST(SystemCalls, AreCountedHere) {
  if (!kCanTally) GTEST_SKIP() << "not under sanitizers";
  const Told told = in_child([](Told& t) {
    (void)filter_system_calls();
    begin_tally();
    t.tally = end_tally();
  });
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
}

}  // namespace
}  // namespace enc::test
