// One thread fills a record and another puts it into the file.
#include "core/record/record.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

namespace enc {
namespace {

TEST(RecordOfTwoThreads, IsWholeAndInOrder) {
  constexpr std::int64_t kTicks = 20'000;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("threads_" + std::to_string(getpid()) + ".encrec")).string();
  {
    RecordWriter record(path, {}, layout_hash(Scene()), 64);  // gone round five times
    std::atomic<bool> over = false;
    std::thread file([&] {
      while (!over) record.drain();
    });
    for (std::int64_t i = 0; i < kTicks && !record.full(); ++i) {
      record.write({i, Time(Duration(i)), Duration(1)}, {}, {}, 0);
      if (i % 100 == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));  // as a loop of 50 kHz does
    }
    over = true;
    file.join();
    record.close();
    EXPECT_EQ(record.error(), "");
  }
  RecordReader reader(path);
  RecordedTick got;
  std::int64_t read = 0;
  for (; reader.next(got); ++read) ASSERT_EQ(got.tick.index, read);
  EXPECT_EQ(read, kTicks);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace enc
