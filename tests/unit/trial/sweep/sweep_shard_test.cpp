// The results of a sweep on disk: going on behind torn lines, locks, merging.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "trial/sweep/shard.h"

namespace enc::trial {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const SweepIdentity kIdentity{R"("sweep":"1a","runs":10,"setup":"2b","program":"P","keep":["contacts"])", 10};

std::string line_of(std::int64_t id, int exit = 0, double cpu = 0.5) {
  return R"({"id":)" + std::to_string(id) +
         R"(,"seed":5,"state_hash":"00","figures":{"contacts":1},"exit":)" + std::to_string(exit) +
         R"(,"cpu_s":)" + std::to_string(cpu) + "}";
}

class SweepShards : public ::testing::Test {
 protected:
  [[nodiscard]] std::string folder() const { return folder_.path().string(); }
  [[nodiscard]] std::string part(int index) const {
    return folder_.file("shard-" + std::to_string(index) + ".ndjson.part");
  }
  // Does at most so many of the missing runs of a shard.
  void go_on(ShardNumber number, std::size_t most = 100, Retry retry = Retry::none, int exit = 0) const {
    ShardFile shard(folder(), kIdentity, number, retry);
    for (const std::int64_t run : shard.next(most)) shard.append(line_of(run, exit));
    if (shard.finished() == shard.count()) shard.complete();
  }
  [[nodiscard]] std::string merged() const {
    const MergedLines lines(folder(), kIdentity);
    std::string text;
    for (std::int64_t i = 0; i < lines.size(); ++i) text += std::string(lines.at(i).results) + "}\n";
    return text;
  }
  void append(const std::string& path, const std::string& text) const {
    std::ofstream(path, std::ios::app | std::ios::binary) << text;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SweepShards, ARestartGoesOnBehindATornLine) {
  go_on({0, 3}, 2);
  append(part(0), line_of(6).substr(0, 30));
  ShardFile shard(folder(), kIdentity, {0, 3}, Retry::none);
  EXPECT_EQ(shard.count(), 4);
  EXPECT_EQ(shard.finished(), 2);
  EXPECT_THAT(shard.next(100), ElementsAre(6, 9));
}

TEST_F(SweepShards, AHeaderThatWasCutOffIsWrittenAnew) {
  go_on({0, 3}, 1);
  const std::string text = bytes_of(part(0));
  for (std::size_t length = 0; length <= text.size(); ++length) {
    std::ofstream(part(0), std::ios::binary) << text.substr(0, length);
    ShardFile shard(folder(), kIdentity, {0, 3}, Retry::none);
    EXPECT_EQ(shard.finished(), length == text.size() ? 1 : 0) << length;
  }
}

TEST_F(SweepShards, AMergeIsEqualWhateverTheNumberOfShards) {
  std::string one;
  for (const int count : {1, 2, 7, 13}) {
    for (int i = count - 1; i >= 0; --i) go_on({i, count});
    if (count == 1) one = merged();
    EXPECT_EQ(merged(), one) << count;
    EXPECT_EQ(merged().find("cpu_s"), std::string::npos);
    fs::remove_all(folder());
  }
}

TEST_F(SweepShards, AWholeShardHasNothingLeft) {
  go_on({0, 1});
  EXPECT_TRUE(fs::exists(folder_.file("shard-0.ndjson")));
  ShardFile shard(folder(), kIdentity, {0, 1}, Retry::none);
  EXPECT_EQ(shard.finished(), 10);
  EXPECT_TRUE(shard.next(1).empty());
  EXPECT_FALSE(fs::exists(part(0)));
}

TEST_F(SweepShards, FailedRunsAreDoneAgainOnRequest) {
  go_on({0, 1}, 3, Retry::none, 2);
  go_on({0, 1});
  {
    ShardFile shard(folder(), kIdentity, {0, 1}, Retry::none);
    EXPECT_EQ(shard.failures(), 3);
  }
  ShardFile shard(folder(), kIdentity, {0, 1}, Retry::failures);
  EXPECT_EQ(shard.finished(), 7);
  EXPECT_THAT(shard.next(100), ElementsAre(0, 1, 2));
  EXPECT_FALSE(fs::exists(folder_.file("shard-0.ndjson")));
}

TEST_F(SweepShards, TwoProcessesOfOneNumberAreRefused) {
  const ShardFile first(folder(), kIdentity, {1, 2}, Retry::none);
  EXPECT_THAT(error_of([&] {
                const ShardFile second(folder(), kIdentity, {1, 2}, Retry::none);
              }),
              HasSubstr("another process runs shard 1 of 2"));
  const ShardFile other(folder(), kIdentity, {0, 2}, Retry::none);
  EXPECT_TRUE(shards_in(folder(), kIdentity).front().running);
}

TEST_F(SweepShards, AnotherSweepIsRefused) {
  go_on({0, 2}, 1);
  const auto refused = [&](const char* from, const char* to) {
    const SweepIdentity other{test::replaced(kIdentity.text, from, to), 10};
    return error_of([&] { const ShardFile shard(folder(), other, {1, 2}, Retry::none); });
  };
  EXPECT_THAT(refused("1a", "1b"), HasSubstr("the design was another one"));
  EXPECT_THAT(refused("2b", "2c"), HasSubstr("the scene or its rig was another one"));
  EXPECT_THAT(refused("\"P\"", "\"Q\""), HasSubstr("another Encounter wrote it"));
  EXPECT_THAT(refused("contacts", "ticks"), HasSubstr("keeps other measures"));
  EXPECT_THAT(error_of([&] {
                const ShardFile shard(folder(), kIdentity, {1, 3}, Retry::none);
              }),
              HasSubstr("begun in 2 shards"));
}

TEST_F(SweepShards, AForeignFileAndADamagedLineAreRefused) {
  go_on({0, 1}, 2);
  append(part(0), "{\"id\":nonsense}\n");
  EXPECT_THAT(error_of([&] {
                const ShardFile shard(folder(), kIdentity, {0, 1}, Retry::none);
              }),
              HasSubstr(part(0) + ":4:1: is no line of a run"));
  fs::remove(part(0));
  go_on({0, 1}, 2);
  append(part(0), line_of(0) + "\n");
  EXPECT_THAT(error_of([&] {
                const ShardFile shard(folder(), kIdentity, {0, 1}, Retry::none);
              }),
              HasSubstr("run 0 is there twice"));
  append(folder_.file("notes.txt"), "mine");
  EXPECT_THAT(error_of([&] {
                const ShardFile shard(folder(), kIdentity, {0, 1}, Retry::none);
              }),
              HasSubstr("notes.txt: is no file of a sweep"));
}

// A copy under another number, a number written otherwise, a folder and a pipe.
TEST_F(SweepShards, AFileThatOnlyHasTheNameOfAShardIsRefused) {
  go_on({0, 3});
  const auto refused = [&] {
    return error_of([&] { const ShardFile shard(folder(), kIdentity, {1, 3}, Retry::none); });
  };
  const std::string copy = folder_.file("shard-2.ndjson"), zeros = folder_.file("shard-00.ndjson");
  fs::copy_file(folder_.file("shard-0.ndjson"), copy);
  EXPECT_THAT(refused(), HasSubstr("its name is that of another shard"));
  fs::rename(copy, zeros);
  EXPECT_THAT(refused(), HasSubstr("shard-00.ndjson: is no file of a sweep"));
  fs::remove(zeros);
  fs::create_directory(copy);
  EXPECT_THAT(refused(), HasSubstr("shard-2.ndjson: is no file of a sweep"));
  fs::remove(copy);
  ASSERT_EQ(mkfifo(copy.c_str(), 0600), 0);
  EXPECT_THAT(refused(), HasSubstr("shard-2.ndjson: is no file of a sweep"));
}

TEST_F(SweepShards, AMergeNamesTheShardsThatAreNotWhole) {
  go_on({1, 3});
  go_on({2, 3}, 1);
  EXPECT_THAT(error_of([&] { static_cast<void>(merged()); }),
              HasSubstr("of 3 shards these are not whole: 0, 2"));
}

TEST(SweepLines, ALineIsReadWithoutAParser) {
  const auto line = parse_result(line_of(7, 4, 0.25));
  ASSERT_TRUE(line);
  EXPECT_EQ(line->id, 7);
  EXPECT_EQ(line->exit, 4);
  EXPECT_EQ(line->cpu, 0.25);
  for (const char* bad : {"", "{}", "{\"id\":7}", "{\"id\":x,\"exit\":0,\"cpu_s\":1}",
                          "{\"id\":7,\"exit\":0,\"cpu_s\":1", "{\"id\":7,\"cpu_s\":1,\"exit\":0}"})
    EXPECT_FALSE(parse_result(bad)) << bad;
}

}  // namespace
}  // namespace enc::trial
