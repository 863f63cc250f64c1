// A record costs a tick of a loop on the wall clock little, and has every tick.
#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/record/record.h"
#include "models/order_statistics.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/temporary_folder.h"
#include "trial/assemble/prepare.h"
#include "trial/time/record_thread.h"

namespace enc::tests {
namespace {

// s of CPU time of this thread, so that other programs do not count.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// A fixed piece of work: a bound on time is a ratio to it, so that a slow machine does not fail the test.
class Yardstick {
 public:
  double seconds() {
    const double begun = thread_seconds();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      sum_ = sum_ * 0.75 + cells_[i];  // each waits for the one before, and for its cell
      cells_[(i * 7) % cells_.size()] = 1.0 / (1.0 + sum_ * sum_);
    }
    seen_ = sum_;  // so that the compiler leaves nothing out
    return thread_seconds() - begun;
  }

 private:
  std::array<double, 512> cells_{};
  double sum_ = 1.0;
  volatile double seen_ = 0.0;
};

// As `encounter run` does it: the loop fills the record, another thread puts it into the file.
TEST(RecordCost, ATickPaysForACopyAlone) {
  constexpr std::int64_t kTicks = 5'000;
  // Yardsticks. Measured: 0.14 on a busy machine; packing within the tick would be 0.33.
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
        // A thread's own time costs a system call, as much as the write. The median passes over
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
}  // namespace enc::tests
