// Calls that a tick must not make, counted over every shipped scene; the counters work; and the cost of a
// record per tick.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/record/record.h"
#include "models/order_statistics.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/mujoco.h"
#include "tests/hygiene/tick_run.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "trial/assemble/assemble.h"
#include "trial/time/real_time.h"

namespace enc::test {
namespace {

using tests::source_dir;

// ---- A whole tick of every shipped scene, as in `run`: the twin and its physics, the core, safety, and the
// measurements of every run. After a tenth of a second a tick uses no heap and takes no lock. It makes no
// system call except to sleep and to read the clock, and all its memory is mapped.

TEST_P(Tick, AsksForNothing) {
  count_scene({.scene = GetParam()},
              [](const ChildTally& told) { EXPECT_EQ(told.tally.all(), 0) << words(told.tally); });
}
INSTANTIATE_TEST_SUITE_P(Shipped, Tick, testing::ValuesIn(scenes(false)),
                         [](const auto& scene) { return scene.param; });

// A clock in wall time sleeps and reads the time.
TEST_F(AnyTick, OnlySleepsAtAPace) {
  Case asked{.scene = "plane", .most = 2000};
  asked.options.pace = 10.0;
  const ChildTally told = without_chance(asked);
  ASSERT_EQ(told.error, "");
  EXPECT_EQ(told.tally.all(), 0) << words(told.tally);
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
}

// The loop writes a record in pieces of 64 KiB, with one call each.
TEST_F(AnyTick, OnlyWritesItsRecord) {
  const TemporaryFolder folder;
  const ChildTally told = without_chance({.scene = "plane", .record = folder.file("a.encrec"), .most = 5000});
  ASSERT_EQ(told.error, "");
  EXPECT_EQ(told.tally[Offence::system_call], told.tally.all()) << words(told.tally);
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
  EXPECT_EQ(told.tally.calls[SYS_write], told.tally.all()) << words(told.tally);
  EXPECT_GT(told.tally.all(), 0);
  EXPECT_LE(static_cast<double>(told.tally.all()), told.extra / 60e3);
}

// ---- The counters work: they find a single call in the last hook of a clean scene's tick, with its caller.

ChildTally with(const std::function<void()>& deed) {
  Case asked{.most = 1000};
  asked.options.watch = [deed](const trial::Glance& glance) {
    if (glance.tick.index == kWarmUp + 500) deed();
  };
  return counted_run(asked);
}
void expect_once(const ChildTally& told, Offence kind, const std::string& name, std::int64_t times = 1) {
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
  const ChildTally told = with([] { (void)::getppid(); });
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
  expect_once(told, Offence::system_call, std::to_string(SYS_getppid));
}

// Allocated memory that was never touched.
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
  const ChildTally told = counted_run(asked);
  EXPECT_EQ(told.error, "");
  EXPECT_EQ(told.tally[Offence::minor_fault], std::int64_t{kPages}) << words(told.tally);
  EXPECT_EQ(told.tally.all(), std::int64_t{kPages}) << words(told.tally);
}

// A failure names the caller.
TEST_F(AnyTick, SaysWhoAskedForSomething) {
  static void* volatile kept = nullptr;
  const std::string said = words(with([] { kept = std::realloc(kept, 24); }).tally);
  EXPECT_NE(said.find("1 heap call in 1000 ticks"), std::string::npos) << said;
  EXPECT_NE(said.find("tick 500: heap call realloc"), std::string::npos) << said;
  EXPECT_NE(said.find("tick_test.cpp"), std::string::npos) << said;
}

// On machines without the filter ctest lists this test as skipped.
TEST(SystemCalls, AreCountedHere) {
  if (!kCanTally) GTEST_SKIP() << "not under sanitizers";
  const ChildTally told = in_child([](ChildTally& t) {
    (void)filter_system_calls();
    begin_tally();
    t.tally = end_tally();
  });
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
}

// ---- A record costs a tick of a loop in wall time little, and contains every tick.

// s of CPU time of this thread: other programs do not count.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// A fixed piece of work. Times are bounded as ratios to it, so that a slow machine does not fail the test.
class Yardstick {
 public:
  double seconds() {
    const double begun = thread_seconds();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      sum_ = sum_ * 0.75 + cells_[i];  // each step waits for the one before, and for its cell
      cells_[(i * 7) % cells_.size()] = 1.0 / (1.0 + sum_ * sum_);
    }
    seen_ = sum_;  // keeps the compiler from removing the work
    return thread_seconds() - begun;
  }

 private:
  std::array<double, 512> cells_{};
  double sum_ = 1.0;
  volatile double seen_ = 0.0;
};

// As in `encounter run`, the loop fills the record and another thread writes it into the file.
TEST(RecordCost, ATickPaysForACopyAlone) {
  constexpr std::int64_t kTicks = 5'000;
  // Ratio to the yardstick. Measured: 0.14 on a busy machine; packing within the tick would be 0.33.
  constexpr double kMost = 0.25;
  const models::Setup setup = models::load(source_dir() + "/models/scenes/tennis_ball.toml", "sim", {});
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "run.encrec").string();
  std::vector<double> write, yard;  // s
  {
    RecordWriter record(path, {{"resolved", models::resolved(setup)}},
                        layout_hash(trial::prepare_setup(setup)), RecordWriter::kManyChunks);
    {
      const trial::RecordThread file(record);
      Yardstick yardstick;
      constexpr std::chrono::milliseconds kPeriod{1};
      auto due = std::chrono::steady_clock::now();
      for (std::int64_t i = 0; i < kTicks; ++i) {
        due += kPeriod;
        std::this_thread::sleep_until(due);
        // Reading a thread's own time costs a system call, as much as the write. The median ignores
        // interruptions.
        const auto begun = std::chrono::steady_clock::now();
        record.write({i, Time(i * Duration(kPeriod)), kPeriod}, {}, {}, static_cast<std::uint64_t>(i));
        write.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
        if (i % 10 == 0) yard.push_back(yardstick.seconds());
      }
    }
    record.close();
    EXPECT_EQ(record.error(), "");
  }
  EXPECT_LE(models::median(write), kMost * models::median(yard));
  RecordProperty("write_p99_us", std::to_string(1e6 * models::percentile(write, 0.99)));
  RecordReader reader(path);
  RecordedTick got;
  std::int64_t read = 0;
  for (; reader.next(got); ++read) ASSERT_EQ(got.tick.index, read);
  EXPECT_EQ(read, kTicks);
}

}  // namespace
}  // namespace enc::test
