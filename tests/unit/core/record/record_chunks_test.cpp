// A record whose chunks another thread puts into the file: the same bytes, and never a gap.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/record.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace enc {
namespace {

using test::bytes_of;
using testing::HasSubstr;

void write_tick(RecordWriter& record, std::int64_t i) {
  record.write({i, Time(Duration(i)), Duration(1)}, {}, {}, static_cast<std::uint64_t>(i));
}

// Another puts it into the file, or nobody does until the end: the bytes are the same.
TEST(RecordChunks, WhoeverDrainsTheBytesAreTheSame) {
  const test::TemporaryFolder folder;
  const std::uint64_t layout = layout_hash(Scene());
  const std::string one = folder.file("one"), many = folder.file("many");
  {
    RecordWriter record(one, {{"seed", "7"}}, layout);
    for (std::int64_t i = 0; i < 600; ++i) write_tick(record, i);
    record.close();
  }
  for (const int every : {1, 150, 1000}) {
    RecordWriter record(many, {{"seed", "7"}}, layout, RecordWriter::kManyChunks);
    for (std::int64_t i = 0; i < 600; ++i) {
      write_tick(record, i);
      if (i % every == every - 1) record.drain();
    }
    record.close();
    EXPECT_EQ(record.error(), "");
    EXPECT_EQ(bytes_of(many), bytes_of(one)) << every;
  }
}

// Nobody drains: it ends when all chunks are whole, says so, and what it took is in the file to the last
// tick.
TEST(RecordChunks, ADiskThatDoesNotKeepUpEndsTheRecordAndLeavesNoGap) {
  const test::TemporaryFolder folder;
  constexpr std::int64_t kChunks = 3;
  RecordWriter record(folder.file("slow"), {}, layout_hash(Scene()), kChunks);
  std::int64_t tick = 0;
  for (; tick < 2000 && !record.full(); ++tick) write_tick(record, tick);
  EXPECT_EQ(tick, record.ticks());
  EXPECT_EQ(tick % kChunks, 0) << "whole chunks";
  EXPECT_GE(tick, 150);
  EXPECT_LT(tick, 2000);
  EXPECT_THAT(record.error(), HasSubstr("the disk has not kept up with the run"));
  write_tick(record, tick);
  EXPECT_EQ(record.ticks(), tick) << "nothing more is taken";
  record.close();
  EXPECT_THROW(RecordReader(folder.file("slow")), Error) << "it is not the whole run";
  RecordReader reader(folder.file("slow"), Partial::yes);
  RecordedTick got;
  std::int64_t read = 0;
  for (; reader.next(got); ++read) ASSERT_EQ(got.tick.index, read);
  EXPECT_EQ(read, tick);
  EXPECT_FALSE(reader.sealed());
}

}  // namespace
}  // namespace enc
